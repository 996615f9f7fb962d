"""Runs, incidents and reports leave the robot: cut into parts, verified on the far side, put together there."""
