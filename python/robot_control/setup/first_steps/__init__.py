"""first_steps.py: the first contact with a real robot on legs."""
