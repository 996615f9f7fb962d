"""The calls of os by which `write_durably` writes, on a disk that loses power: all that it may then hold."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench.data_return.virtual_remote import PowerLoss


@dataclass
class _Content:
    written: bytes = b""
    flushed: bytes | None = None  # None: any part of what was written may be there


class VirtualDisk:
    """One folder. Before call number `lost_at` the power is lost."""

    O_WRONLY, O_CREAT, O_TRUNC, O_RDONLY = os.O_WRONLY, os.O_CREAT, os.O_TRUNC, os.O_RDONLY

    def __init__(self, name: str, content: bytes, lost_at: int) -> None:
        self._files = {name: _Content(content, content)}
        self._names: list[dict[str, _Content]] = [dict(self._files)]
        """the folder, as flushed, and after each change since then"""
        self._open: list[_Content | None] = []
        self._left = lost_at

    def states(self, name: str) -> Iterator[bytes | None]:
        """All contents of a file that the disk may hold after a loss of power now; None: there is no such file."""
        for names in self._names:
            content = names.get(name)
            if content is None:
                yield None
            elif content.flushed is not None:
                yield content.flushed
            else:
                yield from (content.written[:length] for length in range(len(content.written) + 1))

    def open(self, path: Path, flags: int, mode: int = 0) -> int:
        """A file, or with O_RDONLY the folder."""
        del mode
        self._count()
        content = None
        if flags & self.O_CREAT:
            content = self._files[path.name] = _Content()
            self._names.append(dict(self._files))
        self._open.append(content)
        return len(self._open) - 1

    def write(self, descriptor: int, data: Any) -> int:
        """Takes a third of it, as write may."""
        self._count()
        content = self._open[descriptor]
        assert content is not None
        taken = max(1, len(data) // 3)
        content.written += bytes(data[:taken])
        content.flushed = None
        return taken

    def fsync(self, descriptor: int) -> None:
        self._count()
        content = self._open[descriptor]
        if content is None:
            self._names = [dict(self._files)]
        else:
            content.flushed = content.written

    def replace(self, source: Path, target: Path) -> None:
        self._count()
        self._files[target.name] = self._files.pop(source.name)
        self._names.append(dict(self._files))

    def close(self, descriptor: int) -> None:
        del descriptor

    def _count(self) -> None:
        self._left -= 1
        if self._left < 0:
            raise PowerLoss
