"""Receives safety_status for a program: every message, not the newest alone."""

import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from robot_control.msg import SafetyStatus
from robot_control.robot.boundary import boundary, subscribe
from robot_control.robot.diagnosis.state import SILENCE
from robot_control.robot.interruptions import SURPRISE, Interruptions, Status
from robot_control.robot.process_start import process_began
from robot_control.robot.safety_states import STOPPED

LATE = 0.1
"""s between two looks after which messages may wait that the receiving thread has not taken"""
CATCH_UP = 0.02
"""s that the receiving thread gets then"""


def status_of(message: SafetyStatus) -> Status:
    """The status of a message, with the cause that came first; `withdrawn` on this process's monotonic clock."""
    first = message.causes.index(message.first_cause) if message.first_cause in message.causes else 0
    columns = {"sentence": message.sentences, "detail": message.details, "remedy": message.remedies}
    texts = {name: column[first] if first < len(column) else "" for name, column in columns.items()}
    known: dict[str, Any] = {name: getattr(message, name) for name in ("speed_limit", "withdrawals", "run")} | texts
    known |= {"missing": tuple(message.missing), "awaiting_zero": message.awaiting_zero_request}
    if message.withdrawn:
        known["withdrawn"] = time.monotonic() - (time.time() - message.withdrawn.to_sec())
    return Status(message.state_name, causes=len(message.causes), **known)


class SafetyWatch:
    """Takes each message when it arrives, and evaluates them on request."""

    def __init__(self) -> None:
        self.message: SafetyStatus | None = None  # the newest one
        self.received_at = -math.inf  # s, monotonic
        self._lock = threading.Lock()
        self._looked, self._count = time.monotonic(), 0
        self._interruptions = Interruptions(self._looked, process_began())
        subscribe("safety_status", SafetyStatus, self.receive, tcp_nodelay=True)
        boundary.stops(self._surprise)

    def receive(self, message: SafetyStatus) -> None:
        """One message."""
        with self._lock:
            self.message, self.received_at = message, time.monotonic()
            self._interruptions.receive(status_of(message), self.received_at)

    def interrupted(self) -> str:
        """One pass: why there was an interruption since the last one; empty if there was none."""
        with self._look(waited=False) as interruptions:
            before, self._count = self._count, interruptions.count
            return interruptions.reason if interruptions.count != before else ""

    def revoked(self, requested: float, *, waited: bool) -> str:
        """Why a request of the time `requested` s (monotonic) may not begin or go on; empty if it may.

        `waited`: since the last pass the program did not drive, but waited or planned.
        """
        with self._look(waited=waited) as interruptions:
            return interruptions.revoked(requested)

    def drivable(self) -> bool | None:
        """True if the monitor permits to drive; None if safety_status is silent."""
        with self._lock:
            status = self._interruptions.status
            fresh = time.monotonic() - self.received_at < SILENCE
            return status.drivable if status is not None and fresh else None

    def stopped_since(self, moment: float) -> str:
        """The name of the state if a message that came after `moment`, s (monotonic), says that the robot stops or is
        stopped; else empty.
        """
        with self._lock:
            state = "" if self.message is None or self.received_at <= moment else self.message.state_name
        return state if state in STOPPED else ""

    def _surprise(self) -> None:
        with self._lock:
            self._interruptions.interrupt(time.monotonic(), SURPRISE)

    @contextmanager
    def _look(self, *, waited: bool) -> Iterator[Interruptions]:
        if time.monotonic() - self._looked > LATE:
            time.sleep(CATCH_UP)
        with self._lock:
            self._looked = time.monotonic()
            self._interruptions.step(self._looked, waited=waited)
            yield self._interruptions
