"""calibrate.py: wheel radii and wheel base from measured drives."""
