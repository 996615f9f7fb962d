"""A far side in memory, without rclone, whose calls can be cut at any moment."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from pathlib import Path


class PowerLoss(BaseException):
    """The program ends here, and runs nothing more."""


class VirtualFarSide:
    """Files by name, with or without hashes. `before` is called before each effect, and may end the call."""

    def __init__(self, *, hashes: bool = True, before: Callable[[], None] = lambda: None) -> None:
        self.files: dict[str, bytes] = {}
        self.hashes = hashes
        self.before = before
        self.received = 0  # bytes

    def put(self, source: Path, target: str) -> None:
        """As rclone: first a truncated file under the final name."""
        for path in sorted(source.iterdir()):
            name, data = f"{target}/{path.name}", path.read_bytes()
            there = self.files.get(name)
            if there is not None and (there == data if self.hashes else len(there) == len(data)):
                continue
            self.before()
            self.files[name] = data[: len(data) // 2]
            self.received += len(data) // 2
            self.before()
            self.files[name] = data
            self.received += len(data) - len(data) // 2

    def found(self, target: str, names: Sequence[str]) -> dict[str, tuple[str, str]]:
        self.before()
        there = {name: self.files[f"{target}/{name}"] for name in names if f"{target}/{name}" in self.files}
        kind = "md5" if self.hashes else ""
        return {
            name: (kind, hashlib.md5(data).hexdigest() if kind else "")  # noqa: S324 (as servers offer it)
            for name, data in there.items()
        }

    def sizes(self, target: str) -> dict[str, int]:
        self.before()
        begin = f"{target}/"
        return {name.removeprefix(begin): len(data) for name, data in self.files.items() if name.startswith(begin)}

    def read(self, name: str, size: int) -> bytes:
        del size
        self.before()
        return self.files[name]

    def remove(self, name: str) -> None:
        self.before()
        del self.files[name]

    def used(self) -> int:
        return sum(map(len, self.files.values()))
