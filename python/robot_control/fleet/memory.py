"""Keeps over a restart: the order with its actions, the position, and the headerId of each topic."""

import threading
from pathlib import Path
from typing import Any

from robot_control.files.files import in_words
from robot_control.files.kept_file import DamagedError, put_aside, read_kept, write_kept

BLOCK = 1000
"""headerIds that are reserved with one write: they grow over restarts, and a write per message is saved"""


class Memory:
    """A file that holds the last state that was saved, whatever ends the program or the machine."""

    def __init__(self, path: Path) -> None:
        """A file that is damaged is moved aside. Raises OSError, InputFileError: there cannot be a file."""
        self.path = path
        self.problem = ""
        """why the last content could not be saved, or was moved aside; empty if it is in the file"""
        path.parent.mkdir(parents=True, exist_ok=True)
        self._content: dict[str, Any] = {"headers": {}}
        try:
            self._content = read_kept(path) or self._content
        except DamagedError as error:
            self.move_aside(str(error))
        self._reserved: dict[str, int] = dict(self._content["headers"])
        self._next = dict(self._reserved)
        self._lock = threading.RLock()  # the link has a thread of its own

    def move_aside(self, why: str) -> None:
        """Begins without content; the file keeps its own under another name. Raises OSError."""
        aside = put_aside(self.path)
        self._content = {"headers": self._content["headers"]}
        self.problem = f"{self.path} cannot be used ({why}) and is {aside} now: the previous order is unknown"

    def __getitem__(self, name: str) -> Any:
        """The value that was saved as `name`; None if there is none."""
        return self._content.get(name)

    def save(self, **values: Any) -> str:
        """Why these values are not in the file; empty if they are."""
        with self._lock:
            content = self._content | values | {"headers": self._reserved}
            try:
                write_kept(self.path, content)
                self._content, self.problem = content, ""
            except OSError as error:
                self.problem = in_words(error)
            return self.problem

    def header_id(self, topic: str) -> int:
        """The next one of this topic; where the file cannot be written they begin again after a restart."""
        with self._lock:
            number = self._next.get(topic, 0)
            if number >= self._reserved.get(topic, 0):
                self._reserved[topic] = number + BLOCK
                self.save()
            self._next[topic] = number + 1
            return number % 2**32
