"""record.py: records the topics of a robot into a bag."""
