"""scripts/bench realtime: the running loop beside what the machine can do at all."""
