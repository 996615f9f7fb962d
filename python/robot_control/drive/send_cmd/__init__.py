"""send_cmd.py: sends a velocity command when the robot is released for it."""
