"""why.py: the reason why a robot does not move."""
