"""Programs that record what the robot did, and read it."""
