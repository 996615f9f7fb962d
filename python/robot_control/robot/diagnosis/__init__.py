"""Why the robot does not move: facts, and what follows from them."""
