"""A program that another one starts and ends."""

import contextlib
import os
import signal
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any

END_LIMIT = 20.0
"""s for an orderly end after SIGINT; roslaunch itself gives its nodes 15 s."""


class Child:
    """A program of ours in a process group of its own, its output in a file.

    It also gets SIGINT when the thread that started it ends, even by SIGKILL: that thread has to live on.
    """

    def __init__(self, command: Sequence[str], output: Path, environment: Mapping[str, str] | None = None) -> None:
        self.output = output
        self._file: IO[bytes] = output.open("wb")
        # A shell starts its background jobs with SIGINT ignored, and children would inherit that.
        hearing = ("setpriv", "--pdeathsig", "INT", "env", "--default-signal=INT", *command)
        streams: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stdout": self._file, "stderr": subprocess.STDOUT}
        self._process = subprocess.Popen(hearing, **streams, env=environment, start_new_session=True)

    @property
    def running(self) -> bool:
        """True while it has not ended."""
        return self._process.poll() is None

    def end(self, limit: float = END_LIMIT) -> bool:
        """SIGINT; after `limit` seconds SIGTERM, then SIGKILL to its group. True when SIGINT was enough."""
        orderly = True
        if self.running:
            self._process.send_signal(signal.SIGINT)
            orderly = self.wait(limit)
        for harder in (signal.SIGTERM, signal.SIGKILL):
            if self.running:
                os.killpg(self._process.pid, harder)
                self.wait(5.0)
        self._file.close()
        return orderly

    def wait(self, limit: float) -> bool:
        """True if it ended within `limit` s."""
        try:
            self._process.wait(limit)
        except subprocess.TimeoutExpired:
            return False
        return True


@contextlib.contextmanager
def children() -> Iterator[list[Child]]:
    """A list of programs that are ended at the end of the block, the last one first, whatever happens in it."""
    started: list[Child] = []
    try:
        yield started
    finally:
        for child in reversed(started):
            child.end()
