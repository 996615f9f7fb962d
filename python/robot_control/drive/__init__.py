"""Programs that drive the robot."""
