"""calibrate.py: wheel radii and track width from measured drives."""
