"""sim.launch as a process, for the system tests."""

import signal
from pathlib import Path

from system.system_support import LIMIT, Process, repository

LAUNCH_LIMIT = 3 * LIMIT
"""s; a launch is a dozen programs, and roslaunch gives each 15 s to end."""


class Launch(Process):
    """sim.launch."""

    def __init__(self, *arguments: str, folder: Path | None = None, without: str = "") -> None:
        """`folder` is that of the caller; `without` names a variable that its environment lacks."""
        command = ["roslaunch", str(repository() / "launch" / "sim.launch"), *arguments]
        if without:
            command = ["env", "-u", without, *command]
        super().__init__("sim-launch", command, {} if folder is None else {"PWD": str(folder)}, folder)

    def wait(self, limit: float = LAUNCH_LIMIT) -> int:
        return super().wait(limit)

    def end(self) -> int:
        """Sends SIGINT; roslaunch ends its nodes in any case."""
        if self.running:
            self.send_signal(signal.SIGINT)
        return self.wait()
