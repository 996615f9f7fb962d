"""One step of the return: scan, delete beyond the quota, send some parts or a manifest. Its clock is an argument."""

import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from robot_control.data.data_return import parts
from robot_control.data.data_return.plan import GB, Entry, Part, deletable, next_entry, next_parts, progress, wait_after
from robot_control.data.data_return.queue_file import QueueFile
from robot_control.data.data_return.remote import InterruptedCallError, Remote, RemoteError, RemoteFile
from robot_control.data.data_return.settings import Settings
from robot_control.files.files import fit_for_message, in_words, printable

SCAN_PERIOD = 5.0
"""s between two scans of the folder of logs"""


class _Setback(NamedTuple):
    """Why a file failed, how often, and when it is tried again."""

    name: str = ""
    why: str = ""
    failures: int = 0
    again: float = 0.0


class Sender:
    """Brings the files of the queue to the remote. A file that fails is tried again later, and later and later.

    Meanwhile the other files go on. A failure without a file is that of the queue.
    """

    def __init__(self, settings: Settings, queue: QueueFile, remote: Remote, say: Callable[[str], None]) -> None:
        self._settings, self._queue, self._remote, self._say = settings, queue, remote, say
        self._reason_to_wait = ""
        self._scan_at = 0.0
        self._setbacks: dict[str, _Setback] = {}
        """by key of the file"""
        self._used: int | None = None
        """bytes of this robot on the remote, where a quota counts them"""

    @property
    def problem(self) -> str:
        """The first file that waits after a failure, and why; empty: none does."""
        return next((each.name + each.why for each in list(self._setbacks.values())), "")

    @property
    def progress(self) -> str:
        """One line."""
        return progress(list(self._queue.entries.values()), self._reason_to_wait)

    def step(self, now: float, day: float, reason_to_wait: str) -> bool:
        """One pass at `now` [s, monotonic] and `day` [s, as of files]; `reason_to_wait`: why nothing is sent.

        True: the next pass is due at once.
        """
        entry = None
        try:
            if now >= self._scan_at:
                self._scan(day)
                self._scan_at = now + SCAN_PERIOD
            entry = None if reason_to_wait else self._next(now)
            if entry is not None:
                (self._delete if entry.returned else self._send)(entry)
        except InterruptedCallError:
            return True
        except Exception as error:  # whatever one file or one answer causes, the others go on
            self._set_back(now, entry, error)
            return False
        self._setbacks.pop("" if entry is None else entry.key, None)
        self._reason_to_wait = reason_to_wait or ("" if entry else self.problem)
        return entry is not None

    def _set_back(self, now: float, entry: Entry | None, error: Exception) -> None:
        key, name = (entry.key, f"{printable(entry.path)}: ") if entry else ("", "")
        why = fit_for_message(in_words(error) if isinstance(error, OSError | RuntimeError) else repr(error))
        if all(why != each.why for each in self._setbacks.values()):
            self._say(f"{name}{why}; tried again, at the latest every {wait_after(99):.0f} s")
        failures = self._setbacks.get(key, _Setback()).failures + 1
        self._setbacks[key] = _Setback(name, why, failures, now + wait_after(failures))
        self._reason_to_wait = name + why
        self._used, self._scan_at = None, 0.0

    def _next(self, now: float) -> Entry | None:
        """The next file to delete, else to send, of those that do not wait after a failure."""
        entries = list(self._queue.entries.values())
        surplus = deletable(entries, self._settings.local_quota)
        due = [each for each in entries if self._setbacks.get(each.key, _Setback()).again <= now]
        return next((each for each in surplus if each in due), None) or next_entry(due)

    def _scan(self, day: float) -> None:
        for each in self._queue.scan(self._settings.logs, day):
            name = printable(each.path)
            self._say(f"{name} was deleted or changed before it was sent; a larger telemetry.quota keeps it longer")
        for key in self._setbacks.keys() - self._queue.entries.keys():
            del self._setbacks[key]

    def _delete(self, entry: Entry) -> None:
        """Deletes a file that the remote still has; another one is sent again."""
        known, there = self._known(entry.target), self._remote.files(entry.target, size=entry.size)
        with parts.set_aside(self._settings.logs / entry.path) as path:  # what is proven is what is deleted
            if len(self._proven(entry, known, there, path)) == entry.count:
                path.unlink()
                del self._queue.entries[entry.key]
            else:
                entry.returned = False
                self._say(f"{printable(entry.path)} differs on the far side; it is sent again")
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
        first, number = entry.target, 1
        while entry.target in taken or not self._may_use(entry):
            number += 1
            entry.target = f"{first}-{number}"

    def _may_use(self, entry: Entry) -> bool:
        """Whether the folder holds this file or none. The parts that it still has are not sent again."""
        known = self._known(entry.target)
        if known and known != {number: part for number, part, _ in self._packed(entry, range(entry.count))}:
            return False
        entry.parts = {number: known[number] for number in self._proven(entry, known)} if known else {}
        return True

    def _known(self, target: str) -> dict[int, Part]:
        """The parts of the whole file that a folder of the remote holds; empty: it holds none."""
        there = self._remote.files(target, [parts.MANIFEST]).get(parts.MANIFEST)
        with suppress(parts.GapError):
            if there is not None and there.size <= parts.MAX_FILE:
                content = parts.read_manifest(self._remote.read(f"{target}/{parts.MANIFEST}", there.size))
                return dict(enumerate(content["parts"]))
        return {}

    def _packed(
        self, entry: Entry, numbers: Iterable[int], path: Path | None = None
    ) -> Iterator[tuple[int, Part, bytes]]:
        """Parts of the local file, at `path` if it has another name now. Raises OSError; ChangedError at the end."""
        with parts.opened(path or self._settings.logs / entry.path, entry.key) as file:
            for number in numbers:
                yield number, *parts.packed(file, number)

    def _proven(
        self,
        entry: Entry,
        known: Mapping[int, Part],
        there: Mapping[str, RemoteFile] | None = None,
        path: Path | None = None,
    ) -> set[int]:
        """Numbers of the parts that are as they were sent, here, and on the remote by its hash, else by its size."""
        there = self._remote.files(entry.target, size=entry.size) if there is None else there
        return {
            number
            for number, part, data in self._packed(entry, range(entry.count), path)
            if known.get(number) == part and part.name in there and there[part.name].holds(data)
        }

    def _send_parts(self, entry: Entry, numbers: list[int]) -> None:
        """A part that arrived otherwise is removed there; the remote's hash shows it, else reading back."""
        sent = list(self._packed(entry, numbers))
        self._reserve(sum(part.size for _, part, _ in sent))
        self._put(entry.target, {part.name: data for _, part, data in sent})
        arrived = self._remote.files(entry.target, [part.name for _, part, _ in sent])
        for number, part, data in sent:
            name, there = f"{entry.target}/{part.name}", arrived.get(part.name)
            if there and there.holds(data) and (there.kind or self._remote.read(name, part.size) == data):
                entry.parts[number] = part
            elif there:
                self._remote.remove(name)
        self._queue.save()
        if bad := set(numbers) - entry.parts.keys():
            raise RemoteError(f"{entry.target}: {len(bad)} parts arrived with different content")

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

    def _finish(self, entry: Entry) -> None:
        """The manifest, once the remote has all parts of the file; it has returned when the manifest was read back."""
        proven = self._proven(entry, entry.parts)
        if len(proven) < entry.count:
            entry.parts = {number: entry.parts[number] for number in proven}
            self._queue.save()
            return
        content = parts.manifest(entry)
        self._put(entry.target, {parts.MANIFEST: content})
        name = f"{entry.target}/{parts.MANIFEST}"
        if self._remote.read(name, len(content)) != content:
            self._remote.remove(name)
            raise RemoteError(f"{name}: arrived with different content")
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
            why = f"the far side holds far_quota ({self._settings.far_quota:g} GB) of this robot: delete there"
            raise RemoteError(why)
        self._used += size
