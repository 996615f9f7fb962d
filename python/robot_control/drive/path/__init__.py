"""drive_path.py: drives the robot along a path."""
