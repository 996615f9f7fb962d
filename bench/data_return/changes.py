"""Files that are swapped, truncated, renamed and rewritten while they are sent: what is deleted, the remote has."""

from __future__ import annotations

import os
import random
import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

from robot_control.data.data_return import parts, plan
from robot_control.data.data_return.parts import MANIFEST, GapError, put_together
from robot_control.data.data_return.queue_file import QueueFile
from robot_control.data.data_return.sender import Sender
from robot_control.data.data_return.settings import Settings

from bench.data_return.virtual_remote import VirtualRemote

PART = 1000
"""bytes, in place of 4 MiB"""
SHORTEST, LONGEST = 2, 5 * PART
"""bytes; the quota is one byte"""
FILES = 5
"""that wait at any time"""
DAY = 2e9
"""s; all files are older"""
RATE = 0.05
"""changes for each call by which one may be noticed"""
LIMIT = 2000
"""passes after the last change, until all files have returned and are deleted"""


class Changes:
    """Logs, a sender beyond its local quota, and a remote in memory. Changes come within the sender's own calls."""

    def __init__(self, folder: Path, seed: int, *, hashes: bool) -> None:
        self._draw = random.Random(seed)
        self._logs, queue = folder / "logs", folder / "queue"
        self._logs.mkdir(parents=True)
        queue.mkdir()
        self._remote = VirtualRemote(hashes=hashes, before=self._maybe)
        settings = Settings(folder=str(self._logs), queue_folder=str(queue), local_quota=1e-9)
        self._sender = Sender(settings, QueueFile(queue), self._remote, lambda _: None)  # type: ignore[arg-type]
        self._left = self._number = 0
        self._busy = False
        self.deleted = 0
        self.wrong: list[str] = []
        """files that were deleted and that the remote lacks"""

    def run(self, count: int) -> int:
        """Makes `count` changes. Returns the number of files that have not returned long after the last one."""
        self._left = count
        now = 0.0
        with self._patched():
            passes = LIMIT
            while passes and (self._left or self._files()):
                while self._left and len(self._files()) < FILES:
                    self._write(self._new_name())
                if self._draw.random() < RATE and self._left:
                    self._lose_on_remote()
                now += 10.0
                self._sender.step(now, DAY, "")
                passes -= not self._left
        return len(self._files())

    @contextmanager
    def _patched(self) -> Iterator[None]:
        def hooked(call: Callable[..., Any]) -> Callable[..., Any]:
            def hook(*given: Any, **named: Any) -> Any:
                self._maybe()
                return call(*given, **named)

            return hook

        with ExitStack() as stack:
            for module in (plan, parts):
                stack.enter_context(patch.object(module, "PART_BYTES", PART))
            for name in ("open", "fstat", "pread"):
                stack.enter_context(patch.object(os, name, hooked(getattr(os, name))))
            stack.enter_context(patch.object(Path, "lstat", hooked(Path.lstat)))
            stack.enter_context(patch.object(parts, "renamed", hooked(parts.renamed)))
            unlink = Path.unlink

            def judged(path: Path, *given: Any, **named: Any) -> None:
                self._judge(path)
                unlink(path, *given, **named)

            stack.enter_context(patch.object(Path, "unlink", judged))
            yield

    def _judge(self, path: Path) -> None:
        if self._busy or self._logs not in path.parents:
            return
        self._busy = True
        if path.stat().st_nlink == 1:
            self.deleted += 1
            self.wrong += [] if path.read_bytes() in self._whole() else [path.name]
        self._busy = False

    def _whole(self) -> Iterator[bytes]:
        """The files that can be put together."""
        content = self._remote.content
        for name in [name for name in content if name.endswith(MANIFEST)]:
            folder, raw = name.removesuffix(MANIFEST), _Bytes()
            try:
                put_together(lambda part, folder=folder: _known(content, folder + part), raw)  # type: ignore[misc,arg-type]
            except GapError:
                continue
            yield raw.content

    def _files(self) -> list[Path]:
        return sorted(path for path in self._logs.iterdir() if not path.name.startswith("."))

    def _new_name(self) -> Path:
        self._number += 1
        return self._logs / f"run.{self._number}.bag"

    def _write(self, path: Path, size: int | None = None) -> None:
        size = self._draw.randint(SHORTEST, LONGEST) if size is None else size
        path.write_bytes(self._draw.randbytes(size))
        os.utime(path, (1e9, 1e9))  # the same for all: time alone proves nothing

    def _maybe(self) -> None:
        """Makes a change in one of some calls."""
        if self._busy or not self._left or self._draw.random() > RATE:
            return
        self._busy = True
        files = [path for path in self._files() if not path.name.startswith("_")]  # a name of the sender's own
        if len(files) > 1:
            self._left -= 1
            self._change(*self._draw.sample(files, 2))
        self._busy = False

    def _change(self, one: Path, other: Path) -> None:
        aside = self._logs / ".swap"
        match self._draw.randrange(6):
            case 0:
                one.rename(aside)
                other.rename(one)
                aside.rename(other)
            case 1:
                os.truncate(one, self._draw.randint(SHORTEST, one.stat().st_size))
                os.utime(one, (1e9, 1e9))
            case 2:
                one.rename(self._new_name())
            case 3:
                shutil.copy2(other, one)
            case 4:
                size = one.stat().st_size
                one.unlink()
                self._write(one, size)
            case _:
                other.replace(one)

    def _lose_on_remote(self) -> None:
        """The remote loses a file between two passes, or the end of one."""
        if self._remote.content:
            name = self._draw.choice(sorted(self._remote.content))
            data = self._remote.content.pop(name)
            if data and self._draw.random() < 0.5:
                self._remote.content[name] = data[:-1]


class _Bytes:
    """Takes what is written."""

    def __init__(self) -> None:
        self.content = b""

    def write(self, data: bytes) -> None:
        self.content += data


def _known(content: dict[str, bytes], name: str) -> bytes:
    try:
        return content[name]
    except KeyError:
        raise FileNotFoundError(name) from None
