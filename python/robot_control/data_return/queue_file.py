"""The files of the logs and how far each is, kept in a file that outlives a loss of power at any moment."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import re
import stat
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path

from robot_control.common.files import write_durably
from robot_control.data_return.plan import Entry, Part, kind_of

NAME = "queue.json"
SETTLED = 10.0
"""s without a change after which a file without an end of its own counts as finished"""
PUT_ASIDE = re.compile(r".*\.\d+\.bag")
"""a bag that telemetry writes no more: run.7.bag, stop.3.bag"""
HEADER = 4096
"""bytes of a bag that hold its first record"""


class QueueError(ValueError):
    """The queue cannot be used; the message says why."""


class QueueFile:
    """The entries, by key. Once `save` has returned, they are never lost."""

    def __init__(self, folder: Path) -> None:
        """Raises OSError, QueueError."""
        self.folder = folder
        self.path = folder / NAME
        self.entries: dict[str, Entry] = {}
        if self.path.exists():
            try:
                for each in json.loads(self.path.read_text(encoding="utf-8"))["files"]:
                    parts = {int(number): Part(**part) for number, part in each.pop("parts").items()}
                    self.entries[each["key"]] = Entry(**each, parts=parts)
            except (ValueError, KeyError, TypeError, AttributeError) as error:
                raise QueueError(f"{self.path} is no queue of data_return.py ({error}); move it away") from None

    def lock(self) -> None:
        """Holds the folder until the program ends. Raises OSError, QueueError: another one holds it."""
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = os.open(self.folder, os.O_RDONLY)
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise QueueError(f"another data_return.py uses {self.folder}; end it, or set queue_folder") from None

    def save(self) -> None:
        """Raises OSError."""
        write_durably(self.path, json.dumps({"format": 1, "files": [asdict(each) for each in self.entries.values()]}))

    def scan(self, logs: Path, day: float) -> list[Entry]:
        """Takes in what is finished, forgets what is gone. Returns those that are gone and had not returned.

        Raises:
            OSError: the queue cannot be written.
        """
        found = {each.key: each for path in logs.rglob("*") if (each := _finished(path, logs, day))}
        lost = [each for key, each in self.entries.items() if key not in found and not each.returned]
        entries = {key: self.entries.get(key, each) for key, each in found.items()}
        for key, each in entries.items():
            each.path = found[key].path
        changed = entries.keys() != self.entries.keys()
        self.entries = entries
        if changed:
            self.save()
        return lost


def _finished(path: Path, logs: Path, day: float) -> Entry | None:
    """None: it is no file that returns, or not finished."""
    kind = kind_of(path.name)
    with contextlib.suppress(OSError):
        status = path.lstat()
        if kind and stat.S_ISREG(status.st_mode) and abs(day - status.st_mtime) >= SETTLED and _is_ended(path):
            key = f"{status.st_ino}-{status.st_size}-{status.st_mtime_ns}"
            stamp = datetime.fromtimestamp(status.st_mtime, UTC).strftime("%Y%m%dT%H%M%S.%fZ")
            target = f"{kind}/{stamp}-{path.name}"
            return Entry(key, str(path.relative_to(logs)), kind, status.st_size, status.st_mtime_ns, target)
    return None


def _is_ended(path: Path) -> bool:
    """A bag that is being written has no index yet; one that telemetry has put aside stays as it is."""
    if path.suffix != ".bag" or PUT_ASIDE.fullmatch(path.name):
        return True
    with path.open("rb") as file:
        header = file.read(HEADER)
    _, found, index = header.partition(b"index_pos=")
    return bool(found) and any(index[:8])
