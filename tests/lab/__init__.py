"""What measures, campaigns and judges: run by scripts/bench and by the tests, installed nowhere."""
