"""data_return.py as a process, a cable that can be cut, and a far side that can be killed."""

from __future__ import annotations

import json
import random
import shutil
import subprocess
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

import yaml  # type: ignore[import-untyped]
from robot_control.data.data_return.plan import BATCH, PART_BYTES
from robot_control.data.data_return.remote import Remote
from robot_control.data.data_return.settings import read_settings

from bench.console.process import program
from bench.console.proxy import Proxy
from bench.data_return.server import Server, configuration

LIMIT = 60.0
"""s until an upload runs, or until the program ends"""


class System:
    """All of it, in a folder of its own, until the block ends."""

    def __init__(self, kind: str, environment: dict[str, str], *, prefix: Sequence[str] = (), **values: object) -> None:
        self._temporary = tempfile.TemporaryDirectory(prefix="data-return-bench-")
        folder = Path(self._temporary.name)
        self.logs, self.far, self._queue, self._log = (folder / name for name in ("logs", "far", "queue", "log"))
        self.logs.mkdir()
        self.server = Server(kind, self.far, prefix=prefix)
        self.cable = Proxy()
        self.cable.target = self.server.port
        config = configuration(folder / "rclone.conf", kind, self.cable.port)
        settings = {"far_side": "far:", "robot": "r1", "rclone_config": str(config), "folder": str(self.logs)}
        self._settings = folder / "data_return.yaml"
        self._settings.write_text(yaml.safe_dump({**settings, "queue_folder": str(self._queue), **values}))
        self._values = read_settings(self._settings)
        self._environment = environment
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.end_program()
        self.cable.end()
        self.server.kill()
        self._temporary.cleanup()

    def protocol(self) -> float:
        """Bytes that leave for each byte of a part, without a loss."""
        sent, parts = self.cable.sent, self.logs.parent / "parts"
        parts.mkdir()
        for number in range(BATCH):
            (parts / str(number)).write_bytes(random.Random(number).randbytes(PART_BYTES))
        Remote(self._values).put(parts, "protocol")
        shutil.rmtree(self.far / "r1/protocol")
        return (self.cable.sent - sent) / (BATCH * PART_BYTES)

    def begin(self) -> None:
        """Starts data_return.py."""
        command = [program("data_return.py"), "run", "--config", str(self._settings)]
        with self._log.open("a") as output:
            self._process = subprocess.Popen(command, stdout=output, stderr=output, env=self._environment)

    def end_program(self) -> None:
        """By SIGINT, if it runs."""
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            self._process.wait(LIMIT)

    def await_upload(self) -> None:
        """Until bytes leave."""
        sent, end = self.cable.sent, time.monotonic() + LIMIT
        while self.cable.sent < sent + 1_000_000:
            if time.monotonic() > end:
                raise RuntimeError(f"nothing is sent: {self.last_words()}")
            time.sleep(0.05)

    def lose(self, what: str, stall: float) -> None:
        """A loss, which is repaired at once, or after `stall` seconds."""
        if what == "cut":
            self.cable.cut()
        elif what == "stall":
            self.cable.stalled = True
            threading.Timer(stall, setattr, (self.cable, "stalled", False)).start()
        elif what == "far side killed":
            self.server.kill()
            self.server.start()
        elif self._process is not None:
            self._process.kill()
            self._process.wait()
            self.begin()

    def done(self) -> bool:
        """All files have returned; those beyond the quota are no more in the queue."""
        try:
            files = json.loads((self._queue / "queue.json").read_text())["files"]
        except OSError:
            return False
        there = sum(path.is_file() for path in self.logs.rglob("*"))
        return len(files) == there > 0 and all(each["returned"] for each in files)

    def last_words(self) -> str:
        """The end of the program's output."""
        return self._log.read_text()[-500:] if self._log.exists() else ""
