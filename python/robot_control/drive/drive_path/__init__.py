"""The program drive_path.py."""
