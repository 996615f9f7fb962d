"""A stop because the loop was late, while all of its processes run: the machine was busy, and nothing is broken."""

import os
from collections.abc import Collection

BY_LATENESS = frozenset(
    {"driver_lost", "controller_lost", "estimator_lost", "monitor_late", "command_stale", "gate_refuses"}
)
"""causes of a stop that a loop without its processor time has; a process that died has them, too"""
SENTENCE = "the loop was late, because other programs used the CPU"
REMEDY = (
    "stop other programs, or set real-time privileges (scripts/privileges install); in simulation use clock:=lockstep"
)
ACTOR = "integrator"


def load_in_words() -> str:
    """Programs of this machine that want to run, mean of the last minute, and its cores."""
    return f"load {os.getloadavg()[0]:.0f} on {os.cpu_count()} cores"


def busy() -> bool:
    """True if more programs of this machine want to run than it has cores."""
    return os.getloadavg()[0] > (os.cpu_count() or 1)


def late(first_cause: str, missing: Collection[str], *, delayed: bool) -> bool:
    """True if a stop with this first cause is one of lateness: `missing` nodes of the loop, `delayed`: the
    simulated time slipped, or more programs want to run than there are cores.
    """
    return first_cause in BY_LATENESS and not missing and delayed
