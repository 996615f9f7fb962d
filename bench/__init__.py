"""Measurements, campaigns and their judges: scripts/bench and the tests run them, and none is installed."""
