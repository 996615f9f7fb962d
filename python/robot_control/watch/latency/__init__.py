"""latency.py: how punctual the real-time threads are, live."""
