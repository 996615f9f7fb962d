"""Finds when the gate braked although the robot was to drive; the table and the picture of a run both use it."""

from dataclasses import dataclass

import numpy as np

from robot_control.data.intervals import intervals
from robot_control.data.run_log import Log
from robot_control.loop.signal_names import bits, bits_in, number_of

GATE_BRAKE = number_of("GateVerdict", "brake")


@dataclass(frozen=True)
class Brake:
    """A stretch of consecutive rows."""

    begin: float  # s
    end: float  # s, of its last row
    cycles: int
    reasons: tuple[str, ...]  # reasons of all its cycles

    def describe(self, max_reasons: int = len(bits("GateReason"))) -> str:
        """One line of text with at most `max_reasons` reasons, for instance: 1 cycle, permit_expired."""
        named = ", ".join(self.reasons[:max_reasons]) + (", ..." if len(self.reasons) > max_reasons else "")
        return f"{self.cycles} cycle{'s' if self.cycles != 1 else ''}, {named or 'no reason given'}"


def brakes_in_drive(log: Log) -> tuple[Brake, ...]:
    """Stretches of the gate's brake that begin while a motion is asked for, after the first cycle that was let through.

    A stretch lasts as long as the gate brakes without a break, also beyond the end of the request.
    """
    asked = np.flatnonzero(
        (np.nan_to_num(log["requested_linear"]) != 0) | (np.nan_to_num(log["requested_angular"]) != 0)
    )
    verdict = log["gate_verdict"]
    braked = verdict == GATE_BRAKE
    passed = np.flatnonzero(~braked & ~np.isnan(verdict))
    passed = passed[passed >= asked[0]] if asked.size else asked
    if not passed.size:
        return ()
    found = []
    for begin, end in intervals(braked):
        if passed[0] < begin <= asked[-1]:
            reasons = int(np.bitwise_or.reduce(np.nan_to_num(log["gate_reasons"][begin:end]).astype(np.int64)))
            names = tuple(reason.name for reason in bits_in("GateReason", reasons))
            found.append(Brake(float(log["time"][begin]), float(log["time"][end - 1]), end - begin, names))
    return tuple(found)
