"""estimate.py: state estimation on recorded data."""
