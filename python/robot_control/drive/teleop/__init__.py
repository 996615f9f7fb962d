"""teleop.py: drives the robot with the keyboard of a terminal."""
