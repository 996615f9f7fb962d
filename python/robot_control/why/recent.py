"""The newest report of each name, of those that are recent; what a sender can fill is bounded."""

from __future__ import annotations

import threading
import time
from typing import Generic, TypeVar

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from robot_control.common.boundary import subscribe

Value = TypeVar("Value")
MAX_NAMES, MAX_SENDERS = 100, 100
"""names of one sender, senders"""


class Recent(Generic[Value]):
    """A table that bounds itself: an entry that is not renewed expires, and beyond a bound the oldest gives way.

    Each sender has entries of its own, so that one of many names displaces no entry of another one. Usable from every
    thread.
    """

    def __init__(self, life: float) -> None:
        """`life`: s for which an entry counts."""
        self._life, self._lock = life, threading.Lock()
        self._senders: dict[str, dict[str, tuple[float, Value]]] = {}  # sender → name → when, what; the newest last

    def put(self, sender: str, name: str, value: Value, now: float) -> None:
        """Notes that `sender` reports `value` as that of `name`."""
        with self._lock:
            rows = self._senders[sender] = self._senders.pop(sender, {})
            rows.pop(name, None)
            rows[name] = now, value
            while now - next(iter(rows.values()))[0] >= self._life:
                del rows[next(iter(rows))]
            for table, bound in ((rows, MAX_NAMES), (self._senders, MAX_SENDERS)):
                if len(table) > bound:
                    del table[next(iter(table))]

    def items(self, now: float) -> dict[str, tuple[float, Value]]:
        """Name → the newest report of it, and when it came, s."""
        with self._lock:
            rows = [(name, row) for table in self._senders.values() for name, row in table.items()]
        recent = [(name, row) for name, row in rows if now - row[0] < self._life]
        return dict(sorted(recent, key=lambda row: row[1][0]))


class Diagnostics(Recent[DiagnosticStatus]):
    """The reports on /diagnostics, by the absolute names of the nodes."""

    def __init__(self, life: float) -> None:
        super().__init__(life)
        subscribe("/diagnostics", DiagnosticArray, self._receive)

    def _receive(self, message: DiagnosticArray) -> None:
        sender = message._connection_header.get("callerid", "")  # noqa: SLF001 (where rospy keeps it)
        for status in message.status:
            self.put(sender, "/" + status.name.lstrip("/"), status, time.monotonic())


def values_of(status: DiagnosticStatus) -> dict[str, str]:
    """The values of a report, by their names."""
    return {pair.key: pair.value for pair in status.values}
