"""One step of the return: scan, delete beyond the quota, send some parts or a manifest. Its clock is an argument."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Callable

from robot_control.common.file_errors import in_words
from robot_control.data_return.far_side import FarSide, FarSideError, InterruptedCallError
from robot_control.data_return.parts import MANIFEST, manifest, packed, sha256
from robot_control.data_return.plan import (
    GB,
    Entry,
    Part,
    deletable,
    next_entry,
    next_parts,
    progress,
    wait_after,
)
from robot_control.data_return.queue_file import QueueFile
from robot_control.data_return.settings import Settings

SCAN_PERIOD = 5.0
"""s between two looks into the folder of logs"""


class Sender:
    """Brings the files of the queue to the far side. After a failure it tries again later, and longer and longer."""

    def __init__(self, settings: Settings, queue: QueueFile, far: FarSide, say: Callable[[str], None]) -> None:
        self._settings, self._queue, self._far, self._say = settings, queue, far, say
        self.problem = ""
        self._waits = ""
        self._failures = 0
        self._again = self._scan_at = 0.0
        self._used: int | None = None
        """bytes of this robot on the far side, where a quota counts them"""

    @property
    def progress(self) -> str:
        """One line."""
        return progress(list(self._queue.entries.values()), self.problem or self._waits)

    def step(self, now: float, day: float, waits: str) -> bool:
        """One pass at `now` [s, monotonic] and `day` [s, as of files]; `waits`: why nothing is sent.

        True: the next pass is due at once.
        """
        self._waits = waits
        if now < self._again:
            return False
        try:
            if now >= self._scan_at:
                self._scan_at = now + SCAN_PERIOD
                self._scan(day)
            entry = None if waits else next_entry(self._queue.entries.values())
            if entry is not None:
                self._send(entry)
        except InterruptedCallError:
            return True
        except (FarSideError, OSError) as error:
            self._fail(now, in_words(error))
            return False
        self.problem, self._failures = "", 0
        return entry is not None

    def _fail(self, now: float, why: str) -> None:
        self._failures += 1
        self._used, self._scan_at = None, 0.0
        self._again = now + wait_after(self._failures)
        if why != self.problem:
            self._say(f"{why}; tried again, at the latest every {wait_after(99):.0f} s")
        self.problem = why

    def _scan(self, day: float) -> None:
        logs = self._settings.logs
        for lost in self._queue.scan(logs, day):
            self._say(
                f"{lost.path} was deleted or changed before it was sent; a larger telemetry.quota keeps it longer"
            )
        for each in deletable(list(self._queue.entries.values()), self._settings.local_quota):
            (logs / each.path).unlink(missing_ok=True)
            del self._queue.entries[each.key]

    def _send(self, entry: Entry) -> None:
        numbers = next_parts(entry, self._settings.bandwidth)
        if numbers:
            self._send_parts(entry, numbers)
        else:
            self._finish(entry)

    def _send_parts(self, entry: Entry, numbers: list[int]) -> None:
        path = self._settings.logs / entry.path
        parts = {number: packed(path, number) for number in numbers}
        self._reserve(sum(len(data) for _, data in parts.values()))
        self._put(entry.target, dict(parts.values()))
        good = self._verified(entry.target, dict(parts.values()))
        for number, (name, data) in parts.items():
            if name in good:
                entry.parts[number] = Part(name, len(data), sha256(data))
        self._queue.save()
        if len(good) < len(parts):
            raise FarSideError(f"{entry.target}: {len(parts) - len(good)} parts arrived with another content")

    def _put(self, target: str, files: dict[str, bytes]) -> None:
        stage = self._queue.folder / "parts"
        shutil.rmtree(stage, ignore_errors=True)
        stage.mkdir()
        try:
            for name, data in files.items():
                (stage / name).write_bytes(data)
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(stage)) from error
        self._far.put(stage, target)

    def _verified(self, target: str, files: dict[str, bytes]) -> set[str]:
        """By the hash that the far side computes, else by reading back; what differs is removed there."""
        good = set()
        for name, (kind, digest) in self._far.found(target, list(files)).items():
            data = files[name]
            if kind:
                same = hashlib.new(kind, data, usedforsecurity=False).hexdigest() == digest
            else:
                same = self._far.read(f"{target}/{name}", len(data)) == data
            if same:
                good.add(name)
            else:
                self._far.remove(f"{target}/{name}")
        return good

    def _finish(self, entry: Entry) -> None:
        """The manifest, once all parts are there; the file has returned when it was read back."""
        status = (self._settings.logs / entry.path).stat()
        if (status.st_size, status.st_mtime_ns) != (entry.size, entry.mtime_ns):
            self._scan_at = 0.0  # another file by now
            return
        sizes = self._far.sizes(entry.target)
        missing = [number for number, part in entry.parts.items() if sizes.get(part.name) != part.size]
        if missing:
            for number in missing:
                del entry.parts[number]
            self._queue.save()
            return
        content = manifest(entry)
        self._put(entry.target, {MANIFEST: content})
        name = f"{entry.target}/{MANIFEST}"
        if self._far.read(name, len(content)) != content:
            self._far.remove(name)
            raise FarSideError(f"{name}: arrived with another content")
        entry.returned, entry.parts = True, {}
        self._queue.save()

    def _reserve(self, size: int) -> None:
        quota = self._settings.far_quota * GB
        if not quota:
            return
        if self._used is None:
            self._used = self._far.used()
        if self._used + size > quota:
            self._used = None
            raise FarSideError(
                f"the far side holds far_quota ({self._settings.far_quota:g} GB) of this robot: delete there"
            )
        self._used += size
