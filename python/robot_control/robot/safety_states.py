"""SafetyStatus.state_name."""

DRIVABLE = frozenset({"READY", "DRIVE"})
"""The states in which the safety monitor permits to drive."""
STOPPED = frozenset({"STOPPING", "STOPPED", "FAULT"})
"""The states that a reset ends."""
