"""The newest report of each name, of those that are recent; what a sender can fill is bounded."""

from __future__ import annotations

import threading
from typing import Generic, TypeVar

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
            for table, bound in ((rows, MAX_NAMES), (self._senders, MAX_SENDERS)):
                if len(table) > bound:
                    del table[next(iter(table))]

    def items(self, now: float) -> dict[str, tuple[float, Value]]:
        """Name → the newest report of it, and when it came, s."""
        with self._lock:
            rows = [(name, row) for table in self._senders.values() for name, row in table.items()]
        recent = [(name, row) for name, row in rows if now - row[0] < self._life]
        return dict(sorted(recent, key=lambda row: row[1][0]))


def sender_of(message: object) -> str:
    """The node from which a message came."""
    header: dict[str, str] = getattr(message, "_connection_header", None) or {}
    return header.get("callerid", "")
