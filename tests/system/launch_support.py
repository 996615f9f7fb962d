"""sim.launch as a process, for the system tests."""

import os
import signal
import subprocess
import tempfile
from pathlib import Path

from system_support import LIMIT, repository

LAUNCH_LIMIT = 3 * LIMIT
"""s; a launch is a dozen programs, and roslaunch gives each 15 s to end."""


class Launch:
    """sim.launch with its output in a file."""

    def __init__(self, *arguments: str, folder: Path | None = None, without: str = "") -> None:
        """`folder` is that of the caller; `without` names a variable that its environment lacks."""
        environment = os.environ | ({} if folder is None else {"PWD": str(folder)})
        environment.pop(without, None)
        self._output = tempfile.NamedTemporaryFile(prefix="sim-launch-", suffix=".log")
        self._process = subprocess.Popen(
            ["roslaunch", str(repository() / "launch" / "sim.launch"), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=self._output,
            stderr=subprocess.STDOUT,
            cwd=folder,
            env=environment,
        )

    @property
    def output(self) -> str:
        return Path(self._output.name).read_text(errors="replace")

    @property
    def running(self) -> bool:
        return self._process.poll() is None

    def wait(self) -> int:
        return self._process.wait(LAUNCH_LIMIT)

    def end(self) -> None:
        """Sends SIGINT; roslaunch ends its nodes in any case."""
        if self.running:
            self._process.send_signal(signal.SIGINT)
        self.wait()
