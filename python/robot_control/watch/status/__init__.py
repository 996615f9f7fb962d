"""robot_status.py: the robot's state for a host, on one topic."""
