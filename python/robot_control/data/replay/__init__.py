"""replay.py: the laws of a log, run again."""
