"""The program follow_path.py."""
