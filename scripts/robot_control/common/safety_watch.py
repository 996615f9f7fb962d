"""safety_status as a program hears it: every message, not the newest alone."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import rospy

from robot_control.common.interruptions import Interruptions, Status
from robot_control.msg import SafetyStatus

LOOK = 0.02
"""s between two looks"""
SHORT = 0.1
"""s between two looks after which the thread that receives may be behind"""


def status_of(message: SafetyStatus) -> Status:
    """Of the causes the one that came first."""
    first = message.causes.index(message.first_cause) if message.first_cause in message.causes else 0
    sentence, detail, remedy = (
        texts[first] if first < len(texts) else "" for texts in (message.sentences, message.details, message.remedies)
    )
    return Status(
        state=message.state_name,
        sentence=sentence,
        detail=detail,
        remedy=remedy,
        causes=len(message.causes),
        missing=tuple(message.missing),
        awaiting_zero=message.awaiting_zero_request,
        speed_limit=message.speed_limit,
        resets=message.resets,
        run=message.run,
    )


class SafetyWatch:
    """Looks in a thread of its own, so that a program that plans or waits is not taken for one that was suspended."""

    def __init__(self) -> None:
        self.message: SafetyStatus | None = None  # the newest one
        self.received_at = -math.inf  # s, monotonic
        self._lock = threading.Lock()
        self._received: list[Status] = []
        self._looked = time.monotonic()
        self._interruptions = Interruptions(self._looked)
        rospy.Subscriber("safety_status", SafetyStatus, self.receive, tcp_nodelay=True)
        threading.Thread(target=self._keep_looking, daemon=True).start()

    def receive(self, message: SafetyStatus) -> None:
        """One message."""
        with self._lock:
            self._received.append(status_of(message))
            self.message, self.received_at = message, time.monotonic()

    def interruptions(self) -> tuple[int, str]:
        """How many there were, and why the last one."""
        with self._newest() as interruptions:
            return interruptions.count, interruptions.reason

    def revoked(self, requested: float) -> str:
        """Why what was requested at `requested` s (monotonic) does not begin any more; empty: it may."""
        with self._newest() as interruptions:
            return interruptions.revoked(requested)

    def drivable(self, silence: float) -> bool | None:
        """Does the monitor permit to drive? None: it has said nothing for `silence` s."""
        with self._newest() as interruptions:
            status = interruptions.status
            fresh = time.monotonic() - self.received_at < silence
            return status.drivable if status is not None and fresh else None

    @contextmanager
    def _newest(self) -> Iterator[Interruptions]:
        if time.monotonic() - self._looked > SHORT:
            time.sleep(LOOK)
        with self._lock:
            now = time.monotonic()
            self._interruptions.step(now, self._received)
            self._looked, self._received = now, []
            yield self._interruptions

    def _keep_looking(self) -> None:
        while True:
            time.sleep(LOOK)
            with self._newest():
                pass
