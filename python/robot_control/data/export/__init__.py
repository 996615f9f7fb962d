"""export.py: run.bag as CSV, MCAP, or standard topics."""
