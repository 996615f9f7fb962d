"""The newest report of each node on /diagnostics, of those that are recent; what a sender can fill is bounded."""

import threading
import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from robot_control.robot.boundary import subscribe
from robot_control.robot.diagnosis.state import SILENCE

MAX_NAMES, MAX_SIZE, MAX_SENDERS = 100, 1 << 16, 100
"""names of one sender, bytes of its reports, senders; a node of this robot reports 4 kB under one name"""
OVERHEAD = 100
"""bytes of an entry beside its texts"""


class Diagnostics:
    """The reports on /diagnostics, by the absolute names of the nodes. Usable from every thread.

    A report that is not renewed expires, and beyond a bound the oldest gives way. Each sender has reports of its own:
    one of many names displaces no report of another one.
    """

    def __init__(self, life: float = SILENCE) -> None:
        """`life`: s for which a report counts."""
        self._life, self._lock = life, threading.Lock()
        self._senders: dict[str, dict[str, tuple[float, DiagnosticStatus, int]]] = {}
        """sender → name → when, what, bytes; the newest last"""
        subscribe("/diagnostics", DiagnosticArray, self._receive)

    def items(self, now: float) -> dict[str, tuple[float, DiagnosticStatus]]:
        """Name → the newest report of it, and when it came, s."""
        with self._lock:
            rows = [(name, at, status) for rows in self._senders.values() for name, (at, status, _) in rows.items()]
        recent = sorted((row for row in rows if now - row[1] < self._life), key=lambda row: row[1])
        return {name: (at, status) for name, at, status in recent}

    def _receive(self, message: DiagnosticArray) -> None:
        sender, now = message._connection_header.get("callerid", ""), time.monotonic()  # noqa: SLF001 (rospy's place)
        with self._lock:
            rows = self._senders[sender] = self._senders.pop(sender, {})
            for status in message.status[-MAX_NAMES:]:
                name = "/" + status.name.lstrip("/")
                rows.pop(name, None)
                rows[name] = now, status, _size(status)
            size = sum(row[2] for row in rows.values())
            for name, (at, _, own) in list(rows.items()):
                if now - at < self._life and len(rows) <= MAX_NAMES and size <= MAX_SIZE:
                    break
                del rows[name]
                size -= own
            if len(self._senders) > MAX_SENDERS:
                del self._senders[next(iter(self._senders))]


def _size(status: DiagnosticStatus) -> int:
    texts = len(status.name) + len(status.message) + len(status.hardware_id)
    return OVERHEAD + texts + sum(OVERHEAD + len(pair.key) + len(pair.value) for pair in status.values)


def values_of(status: DiagnosticStatus) -> dict[str, str]:
    """The values of a report, by their names."""
    return {pair.key: pair.value for pair in status.values}
