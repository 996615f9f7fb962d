"""blackbox.py: the last minute before a crash as run.bag."""
