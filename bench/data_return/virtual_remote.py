"""A remote in memory, without rclone, whose calls can be cut at any moment."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from pathlib import Path

from robot_control.data.data_return.remote import RemoteFile


class PowerLoss(BaseException):
    """The program ends here, and runs nothing more."""


class VirtualRemote:
    """Files by name, with or without hashes. `before` is called before each effect, and may end the call."""

    def __init__(self, *, hashes: bool = True, before: Callable[[], None] = lambda: None) -> None:
        self.content: dict[str, bytes] = {}
        self.hashes = hashes
        self.before = before
        self.received = 0  # bytes

    def put(self, source: Path, target: str) -> None:
        """As rclone: first a truncated file under the final name."""
        for path in sorted(source.iterdir()):
            name, data = f"{target}/{path.name}", path.read_bytes()
            there = self.content.get(name)
            if there is not None and (there == data if self.hashes else len(there) == len(data)):
                continue
            self.before()
            self.content[name] = data[: len(data) // 2]
            self.received += len(data) // 2
            self.before()
            self.content[name] = data
            self.received += len(data) - len(data) // 2

    def files(self, target: str, names: Sequence[str] = (), size: int = 0) -> dict[str, RemoteFile]:
        del size
        self.before()
        begin = f"{target}/"
        there = {name.removeprefix(begin): data for name, data in self.content.items() if name.startswith(begin)}
        return {name: self._file(data) for name, data in there.items() if not names or name in names}

    def _file(self, data: bytes) -> RemoteFile:
        if not self.hashes:
            return RemoteFile(len(data))
        return RemoteFile(len(data), "md5", hashlib.md5(data).hexdigest())  # noqa: S324 (as servers offer it)

    def read(self, name: str, size: int) -> bytes:
        del size
        self.before()
        return self.content[name]

    def remove(self, name: str) -> None:
        self.before()
        del self.content[name]

    def used(self) -> int:
        return sum(map(len, self.content.values()))
