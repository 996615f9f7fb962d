"""The files of the logs and how far each is, kept in a file that outlives a loss of power at any moment."""

import contextlib
import fcntl
import os
import re
import stat
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from robot_control.data.data_return.parts import get_back, read_part
from robot_control.data.data_return.plan import KINDS, Entry, identity, kind_of
from robot_control.files.files import printable
from robot_control.files.kept_file import put_aside, read_kept, write_kept

NAME = "queue.json"
SETTLED = 10.0
"""s without a change after which a file without an end of its own counts as finished"""
NUMBERED_BAG = re.compile(r".*\.\d+\.bag")
"""a bag that telemetry writes no more: run.7.bag, stop.3.bag"""
HEADER = 4096
"""bytes of a bag that hold its first record"""
TARGET = re.compile(rf"({'|'.join(KINDS)})/(?!\.)[^/\0]+")
FIRST, LAST = -6e10, 2.5e11
"""s, the times that a date can show: years 68 to 9892"""
LONGEST_NAME = 200
"""bytes of a file's name in the name of its folder on the remote, of 255 with time and number"""


class QueueError(ValueError):
    """The queue cannot be used; the message says why."""


class QueueFile:
    """The entries, by key. Once `save` has returned, they are never lost."""

    def __init__(self, folder: Path) -> None:
        """Raises OSError."""
        self.folder = folder
        self.path = folder / NAME
        self.entries: dict[str, Entry] = {}
        self.damage = ""
        """why the file is no queue; empty: it is one, or there is none"""
        try:
            self.entries = {each.key: each for each in map(_entry, read_kept(self.path) or ())}
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            self.damage = f"{self.path} is not a queue of data_return.py ({printable(str(error))})"

    def lock(self) -> None:
        """Holds the folder until the program ends; a damaged queue is put aside there.

        Raises:
            OSError.
            QueueError: another program holds it.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = os.open(self.folder, os.O_RDONLY)
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise QueueError(f"another data_return.py uses {self.folder}; stop it, or set queue_folder") from None
        if self.damage:
            put_aside(self.path)

    def save(self) -> None:
        """Raises OSError."""
        write_kept(self.path, [asdict(each) for each in self.entries.values()])

    def scan(self, logs: Path, day: float) -> list[Entry]:
        """Takes in what is finished, forgets what is gone. Returns those that are gone and had not returned.

        Raises:
            OSError: the queue cannot be written.
        """
        for queued in self.entries.values():
            get_back(logs / queued.path, queued.key)
        found = {each.key: each for path in logs.rglob("*") if (each := _finished(path, logs, day))}
        missing = [each for key, each in self.entries.items() if key not in found and not each.returned]
        for key, each in found.items():
            if (known := self.entries.get(key)) is not None:
                each.target, each.parts, each.returned = known.target, known.parts, known.returned
        changed = found.keys() != self.entries.keys()
        self.entries = found
        if changed:
            self.save()
        return missing


def _entry(given: dict[str, Any]) -> Entry:
    """Raises ValueError, KeyError, TypeError, AttributeError: it is none."""
    entry = Entry(**{**given, "parts": {}})
    types = [type(each) for each in (entry.key, entry.path, entry.size, entry.mtime_ns, entry.returned)]
    good = types == [str, str, int, int, bool] and entry.kind in KINDS and 0 <= entry.size < 1 << 63
    if not good or not TARGET.fullmatch(entry.target):
        raise ValueError("a file has values that are none of its")
    for number in map(int, given["parts"]):
        if not 0 <= number < entry.count:
            raise ValueError(f"part {number} of {entry.count}")
        entry.parts[number] = read_part(given["parts"][str(number)], number)
    return entry


def _finished(path: Path, logs: Path, day: float) -> Entry | None:
    """None: it is no file that returns, or not finished."""
    kind = kind_of(path.name)
    with contextlib.suppress(OSError):
        status = path.lstat()
        if kind and stat.S_ISREG(status.st_mode) and abs(day - status.st_mtime) >= SETTLED and _is_ended(path):
            time = datetime.fromtimestamp(min(max(status.st_mtime, FIRST), LAST), UTC)
            target = f"{kind}/{time:%Y%m%dT%H%M%S.%fZ}-{_plain(path.name)}"
            name = str(path.relative_to(logs))
            return Entry(identity(status), name, kind, status.st_size, status.st_mtime_ns, target)
    return None


def _plain(name: str) -> str:
    """The name with characters that every remote takes; the manifest has the whole one."""
    plain = "".join(c if c.isalnum() or c in "._- " else "_" for c in name)
    return plain.encode()[-LONGEST_NAME:].decode(errors="ignore")


def _is_ended(path: Path) -> bool:
    """A bag that is being written has no index yet; one that telemetry has numbered stays as it is."""
    if path.suffix != ".bag" or NUMBERED_BAG.fullmatch(path.name):
        return True
    with path.open("rb") as file:
        header = file.read(HEADER)
    _, found, index = header.partition(b"index_pos=")
    return bool(found) and any(index[:8])
