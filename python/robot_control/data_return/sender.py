"""One step of the return: scan, delete beyond the quota, send some parts or a manifest. Its clock is an argument."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import count

from robot_control.common.file_errors import in_words
from robot_control.common.files import fit_for_message, printable
from robot_control.data_return.parts import (
    MANIFEST,
    MAX_FILE,
    ChangedError,
    GapError,
    manifest,
    opened,
    read_manifest,
    sha256,
)
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
from robot_control.data_return.remote import InterruptedCallError, Remote, RemoteError
from robot_control.data_return.removal import removal
from robot_control.data_return.settings import Settings

SCAN_PERIOD = 5.0
"""s between two scans of the folder of logs"""


@dataclass(frozen=True)
class _Setback:
    """Why a file failed while another one did not, and when it is tried again."""

    why: str = ""
    count: int = 0
    again: float = 0.0


class Sender:
    """Brings the files of the queue to the remote. After a failure it tries again later, and longer and longer.

    What fails is tried after all others. Once one of these succeeds, the failure is that of the file: it waits by itself.
    """

    def __init__(self, settings: Settings, queue: QueueFile, remote: Remote, say: Callable[[str], None]) -> None:
        self._settings, self._queue, self._remote, self._say = settings, queue, remote, say
        self._problem = self._reason_to_wait = ""
        self._failures = 0
        self._again = self._scan_at = 0.0
        self._failed: dict[str, str] = {}
        """reasons by key, since the last success"""
        self._setbacks: dict[str, _Setback] = {}
        self._used: int | None = None
        """bytes of this robot on the remote, where a quota counts them"""

    @property
    def problem(self) -> str:
        """Why nothing is sent, or one file is not; empty: nothing failed."""
        entries = self._queue.entries
        own = (f"{printable(entries[key].path)}: {each.why}" for key, each in self._setbacks.items() if key in entries)
        return self._problem or next(own, "")

    @property
    def progress(self) -> str:
        """One line."""
        return progress(list(self._queue.entries.values()), self._problem or self._reason_to_wait)

    def step(self, now: float, day: float, reason_to_wait: str) -> bool:
        """One pass at `now` [s, monotonic] and `day` [s, as of files]; `reason_to_wait`: why nothing is sent.

        True: the next pass is due at once.
        """
        self._reason_to_wait = reason_to_wait
        if now < self._again:
            return False
        entry = None
        try:
            if now >= self._scan_at:
                self._scan_at = now + SCAN_PERIOD
                self._scan(day)
            entry = None if reason_to_wait else self._next(now)
            if entry is not None:
                (self._delete if entry.returned else self._send)(entry)
        except InterruptedCallError:
            return True
        except ChangedError as error:
            self._scan_at = 0.0
            self._failed |= {entry.key: printable(str(error))} if entry else {}
            return False
        except (RemoteError, OSError) as error:
            self._fail(now, entry, fit_for_message(in_words(error)))
            return False
        except Exception as error:  # all that was not foreseen, by one file or one answer
            self._fail(now, entry, f"{type(error).__name__}: {printable(str(error))}")
            return False
        self._problem, self._failures = "", 0
        if entry is not None:
            self._succeed(now, entry)
        return entry is not None

    def _fail(self, now: float, entry: Entry | None, why: str) -> None:
        self._used, self._scan_at = None, 0.0
        if entry is not None and entry.key in self._setbacks:
            self._set_back(now, entry.key, why)
            return
        self._failures += 1
        self._again = now + wait_after(self._failures)
        if why != self._problem:
            self._say(f"{why}; tried again, at the latest every {wait_after(99):.0f} s")
        self._problem = why
        if entry is not None:
            self._failed[entry.key] = why

    def _set_back(self, now: float, key: str, why: str) -> None:
        known = self._setbacks.get(key, _Setback())
        if why != known.why:
            self._say(f"{printable(self._queue.entries[key].path)} waits, and others go on: {why}")
        self._setbacks[key] = _Setback(why, known.count + 1, now + wait_after(known.count + 1))

    def _succeed(self, now: float, entry: Entry) -> None:
        self._setbacks.pop(entry.key, None)
        for key in self._failed.keys() & self._queue.entries.keys() - {entry.key}:
            self._set_back(now, key, self._failed[key])
        self._failed.clear()

    def _next(self, now: float) -> Entry | None:
        """What is deleted or sent next: of those that do not wait one that has not failed, else any."""
        entries = list(self._queue.entries.values())
        surplus = deletable(entries, self._settings.local_quota)
        ready = [
            each
            for each in [*surplus, *(each for each in entries if not each.returned)]
            if self._setbacks.get(each.key, _Setback()).again <= now
        ]
        if all(each.key in self._failed for each in ready):
            self._failed.clear()
        ready = [each for each in ready if each.key not in self._failed]
        return next((each for each in ready if each.returned), None) or next_entry(ready)

    def _scan(self, day: float) -> None:
        for each in self._queue.scan(self._settings.logs, day):
            self._say(
                f"{printable(each.path)} was deleted or changed before it was sent; a larger telemetry.quota keeps it "
                "longer"
            )
        self._setbacks = {key: each for key, each in self._setbacks.items() if key in self._queue.entries}

    def _delete(self, entry: Entry) -> None:
        """Deletes a file that the remote still has; another one is sent again."""
        with removal(self._settings.logs / entry.path) as remove:
            known = self._manifest(entry.target)
            if known is not None and len(self._proven(entry, known)) == entry.count:
                remove()
                del self._queue.entries[entry.key]
            else:
                entry.returned = False
                self._say(f"{printable(entry.path)} is no more on the far side as it is here; it is sent again")
        self._queue.save()

    def _send(self, entry: Entry) -> None:
        if not entry.parts:
            self._choose_target(entry)
        numbers = next_parts(entry, self._settings.bandwidth)
        if numbers:
            self._send_parts(entry, numbers)
        else:
            self._finish(entry)

    def _choose_target(self, entry: Entry) -> None:
        """A folder that holds no other whole file, of the remote or of the queue; this file may be there already."""
        taken = {each.target for each in self._queue.entries.values() if each is not entry}
        first = entry.target
        for number in count(1):
            entry.target = first if number == 1 else f"{first}-{number}"
            if entry.target in taken:
                continue
            known = self._manifest(entry.target)
            if known is None:
                return
            if len(known) == entry.count and all(part == known[at] for at, part, _ in self._packed(entry)):
                entry.parts = known
                return

    def _manifest(self, target: str) -> dict[int, Part] | None:
        """The parts of the whole file that a folder of the remote holds; None: it holds none."""
        there = self._remote.files(target, [MANIFEST]).get(MANIFEST)
        if there is None or there.size > MAX_FILE:
            return None
        try:
            content = read_manifest(self._remote.read(f"{target}/{MANIFEST}", there.size))
        except GapError:
            return None
        return dict(enumerate(content["parts"]))

    def _packed(self, entry: Entry) -> Iterator[tuple[int, Part, bytes]]:
        """All parts of the local file. Raises OSError, and ChangedError at the end."""
        with opened(self._settings.logs / entry.path, entry.key) as packed:
            for number in range(entry.count):
                self._remote.require_permission()
                name, data = packed(number)
                yield number, Part(name, len(data), sha256(data)), data

    def _proven(self, entry: Entry, known: Mapping[int, Part]) -> set[int]:
        """Numbers of the parts that are as they were sent, here, and on the remote by its hash, else by its size."""
        there = self._remote.files(entry.target, size=entry.size)
        return {
            number
            for number, part, data in self._packed(entry)
            if known.get(number) == part and part.name in there and there[part.name].holds(data)
        }

    def _send_parts(self, entry: Entry, numbers: list[int]) -> None:
        with opened(self._settings.logs / entry.path, entry.key) as packed:
            parts = {number: packed(number) for number in numbers}
        self._reserve(sum(len(data) for _, data in parts.values()))
        self._put(entry.target, dict(parts.values()))
        good = self._verified(entry.target, dict(parts.values()))
        for number, (name, data) in parts.items():
            if name in good:
                entry.parts[number] = Part(name, len(data), sha256(data))
        self._queue.save()
        if len(good) < len(parts):
            raise RemoteError(f"{entry.target}: {len(parts) - len(good)} parts arrived with another content")

    def _put(self, target: str, files: dict[str, bytes]) -> None:
        stage = self._queue.folder / "parts"
        shutil.rmtree(stage, ignore_errors=True)
        stage.mkdir()
        try:
            for name, data in files.items():
                (stage / name).write_bytes(data)
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(stage)) from error
        self._remote.put(stage, target)

    def _verified(self, target: str, files: dict[str, bytes]) -> set[str]:
        """By the hash that the remote computes, else by reading back; what differs is removed there."""
        good = set()
        for name, there in self._remote.files(target, list(files)).items():
            data = files[name]
            if there.holds(data) and (there.kind or self._remote.read(f"{target}/{name}", len(data)) == data):
                good.add(name)
            else:
                self._remote.remove(f"{target}/{name}")
        return good

    def _finish(self, entry: Entry) -> None:
        """The manifest, once the remote has all parts of the file; it has returned when the manifest was read back."""
        proven = self._proven(entry, entry.parts)
        if len(proven) < entry.count:
            entry.parts = {number: entry.parts[number] for number in proven}
            self._queue.save()
            return
        content = manifest(entry)
        self._put(entry.target, {MANIFEST: content})
        name = f"{entry.target}/{MANIFEST}"
        if self._remote.read(name, len(content)) != content:
            self._remote.remove(name)
            raise RemoteError(f"{name}: arrived with another content")
        entry.returned, entry.parts = True, {}
        self._queue.save()

    def _reserve(self, size: int) -> None:
        quota = self._settings.far_quota * GB
        if not quota:
            return
        if self._used is None:
            self._used = self._remote.used()
        if self._used + size > quota:
            self._used = None
            raise RemoteError(
                f"the far side holds far_quota ({self._settings.far_quota:g} GB) of this robot: delete there"
            )
        self._used += size
