"""Programs that show what the robot does."""
