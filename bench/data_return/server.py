"""A far side of rclone's own (SFTP or WebDAV) on the loopback, which can be killed, and a configuration for it."""

from __future__ import annotations

import shutil
import socket
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

from bench.console.process import free_port

KINDS = ("sftp", "webdav")
PASSWORD = "far away"  # noqa: S105 (of a server on the loopback)
LIMIT = 20.0
"""s until it listens"""


def missing() -> str:
    """The remedy, if rclone is not installed; else empty."""
    return "" if shutil.which("rclone") else "needs Debian's rclone: scripts/setup --data-return"


class Server:
    """Serves a folder. `prefix`: words before the command."""

    def __init__(self, kind: str, folder: Path, *options: str, prefix: Sequence[str] = ()) -> None:
        self.kind, self.port = kind, free_port()
        folder.mkdir(exist_ok=True)
        self._command = [*prefix, "rclone", "serve", kind, "--addr", f"127.0.0.1:{self.port}", "--user", "robot"]
        self._command += ["--pass", PASSWORD, *options, str(folder)]
        self._process: subprocess.Popen[bytes] | None = None
        self.start()

    def start(self) -> None:
        """Listens when this returns."""
        quiet = subprocess.DEVNULL
        self._process = subprocess.Popen(self._command, stdin=quiet, stdout=quiet, stderr=quiet)
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            try:
                socket.create_connection(("127.0.0.1", self.port), 1.0).close()
            except OSError:
                time.sleep(0.02)
            else:
                return
        raise RuntimeError(f"rclone serve {self.kind} does not listen")

    def kill(self) -> None:
        """SIGKILL."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()


def configuration(path: Path, kind: str, port: int, *, password: str = PASSWORD, tls: bool = False) -> Path:
    """Writes a configuration of rclone, with the remote `far`."""
    hidden = subprocess.run(["rclone", "obscure", password], capture_output=True, text=True, check=True).stdout
    lines = ["[far]", f"type = {kind}", "user = robot", f"pass = {hidden.strip()}"]
    if kind == "sftp":
        lines += ["host = 127.0.0.1", f"port = {port}"]
    else:
        lines += [f"url = http{'s' if tls else ''}://127.0.0.1:{port}", "vendor = other"]
    path.touch(mode=0o600)
    path.write_text("\n".join([*lines, ""]))
    return path
