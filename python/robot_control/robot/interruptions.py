"""Decides by safety_status which requests still count. It reads no clock: time is an argument.

A request, a plan, a hold or a wait belongs to the time in which it began. An interruption ends that time:

    stop     the state was READY or DRIVE, and is not any more
    reset    `withdrawals` or `run` differ between two messages that permit to drive: a stop lies between them
    gap      this program did not look for longer than GAP, and neither waited nor planned: it was suspended, and what
             it knows is old
    surprise an input that this program did not foresee may have left it half way through a motion (boundary.py)
    unseen   the monitor says that a permission ended after this program began, or since its last message

A request that was made during a stop counts as older than its reset. A request that arrives as a message began when it
was sent (`requested_at`), because a queue holds it while the program stands still. The purpose for which a program is
started was requested when the program began, not at its first pass. Times are s of any one clock that never turns back.
The clock has to run on while a program is suspended.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from robot_control.robot.safety_states import DRIVABLE, STOPPED

GAP = 1.0
"""s; programs look every 0.02 s, and a loaded machine delays one by half a second now and then. The loop refuses a
request from before a stop, however short the gap of the program."""
RESTARTED = "INIT: a node or the simulation was restarted; earlier commands stay refused"
SURPRISE = "invalid input, see the log of this program"
UNSEEN = "the robot was stopped and released, or restarted"


def requested_at(arrived: float, sent: float | None) -> float:
    """The begin of a request that came as a message: GAP before its arrival if the time of sending is not known.

    A time of sending after the arrival belongs to another clock and does not count.
    """
    return arrived - GAP if sent is None or sent > arrived else sent


@dataclass(frozen=True)
class Status:
    """One message of safety_status."""

    state: str  # INIT, READY, DRIVE, STOPPING, STOPPED, FAULT
    sentence: str = ""  # of the first cause
    detail: str = ""  # its value and limit
    remedy: str = ""
    causes: int = 0
    missing: tuple[str, ...] = ()
    awaiting_zero: bool = False
    speed_limit: float = math.inf  # m/s
    withdrawals: int = 0  # number of starts and latched causes so far
    run: int = 0
    withdrawn: float = -math.inf  # s: until then, what was requested is void

    @property
    def drivable(self) -> bool:
        """True if the robot is permitted to drive."""
        return self.state in DRIVABLE

    @property
    def stopped(self) -> bool:
        """True if only a reset ends the stop."""
        return self.state in STOPPED

    def why(self) -> str:
        """State and cause, for instance: STOPPED: the robot hit something (51 m/s^2, limit 30 m/s^2)."""
        if self.state == "INIT":
            return RESTARTED
        if not self.sentence:
            return self.state
        measured = f" ({self.detail})" if self.detail else ""
        others = f", and {self.causes - 1} more: see why.py" if self.causes > 1 else ""
        return f"{self.state}: {self.sentence}{measured}{others}"


class Interruptions:
    """Interruptions of one program: it calls `step` in every pass, with all messages since the last one."""

    def __init__(self, now: float, began: float | None = None) -> None:
        """`began`: s when the program did, where that is not `now`."""
        self._stepped_at = now
        self._received_at = now if began is None else began  # of the last message
        self._interrupted = self._stopped = (-math.inf, "")  # when last, why
        self.status: Status | None = None  # the newest message
        self.count = 0

    def step(self, now: float, statuses: Iterable[Status] = (), *, waited: bool = False) -> None:
        """One pass: notes how long there was none, unless the program `waited` or planned, and takes the messages."""
        gap, self._stepped_at = now - self._stepped_at, now
        if gap > GAP and not waited:
            self.interrupt(now, f"this program did not run for {gap:.1f} s")
        for status in statuses:
            self.receive(status, now)

    def receive(self, status: Status, now: float) -> None:
        """One message."""
        why = self._change(status)
        if why:
            self.interrupt(now, why)
        elif self._awaits_permit and not status.stopped and status.withdrawn >= self._received_at:
            self.interrupt(min(now, status.withdrawn), UNSEEN)
        self._received_at = now
        if status.stopped:
            self._stopped = now, status.why()
        elif self.status is not None and self.status.stopped:
            self._stopped = now, "e_stop_reset was called"
        self.status = status

    def interrupt(self, at: float, why: str) -> None:
        """Ends the time before `at`, s."""
        self._interrupted = max(self._interrupted, (at, why))
        self.count += 1

    @property
    def _awaits_permit(self) -> bool:
        """Until now for a first permission, as far as this program knows."""
        return self.status is None or self.status.state == "INIT"

    @property
    def reason(self) -> str:
        """Reason of the last interruption; empty if there was none."""
        return self._interrupted[1]

    def revoked(self, requested: float) -> str:
        """Why a request of the time `requested` s may not begin any more; empty if it may."""
        at, why = max(self._stopped, self._interrupted)
        return why if at >= requested else ""

    def _change(self, status: Status) -> str:
        before = self.status
        if before is None or not before.drivable:
            return ""
        if not status.drivable:
            return status.why()
        if (status.withdrawals, status.run) != (before.withdrawals, before.run):
            return UNSEEN
        return ""
