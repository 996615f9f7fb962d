"""A recorded run in place of a robot."""
