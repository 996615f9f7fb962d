"""pad.py: drives the robot with a game pad."""
