"""Keeps over a restart: the order with its actions, the position, and the headerId of each topic."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any

from robot_control.common.files import write_durably

BLOCK = 1000
"""headerIds that are reserved with one write: they grow over restarts, and a write per message is saved"""
Content = dict[str, Any]


class MemoryFileError(ValueError):
    """The file holds something else; the message names it."""


class Memory:
    """A file that holds the last state that was saved, whatever ends the program or the machine."""

    def __init__(self, path: Path) -> None:
        """Raises OSError, MemoryFileError."""
        self.path = path
        path.parent.mkdir(parents=True, exist_ok=True)
        self._content: Content = {"headers": {}}
        if path.exists():
            try:
                self._content = json.loads(path.read_text(encoding="utf-8"))
                self._content["headers"] = {str(name): int(at) for name, at in self._content["headers"].items()}
            except (ValueError, KeyError, TypeError, AttributeError) as error:
                raise MemoryFileError(f"{path} is not a file of vda5050.py ({error}); move it away") from None
        self._reserved: dict[str, int] = dict(self._content["headers"])
        self._next = dict(self._reserved)
        self._lock = threading.RLock()  # the link has a thread of its own

    def __getitem__(self, name: str) -> Any:
        """The value that was saved as `name`; None if there is none."""
        return self._content.get(name)

    def save(self, **values: Any) -> None:
        """Raises OSError."""
        with self._lock:
            self._write(values)

    def _write(self, values: Content) -> None:
        self._content |= values
        self._content["headers"] = self._reserved
        write_durably(self.path, json.dumps(self._content))

    def header_id(self, topic: str) -> int:
        """The next one of this topic. Raises OSError."""
        with self._lock:
            number = self._next.get(topic, 0)
            if number >= self._reserved.get(topic, 0):
                self._reserved[topic] = number + BLOCK
                self.save()
            self._next[topic] = number + 1
            return number % 2**32
