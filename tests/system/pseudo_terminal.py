"""A program in a pseudo-terminal of its own, as a user's shell starts it."""

import contextlib
import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import termios
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

LIMIT = 30.0
"""s"""
SHELL = """
trap : INT HUP
before=$(stty -g); "$@"; code=$?
looks=0
while now=$(stty -g) && [ "$now" != "$before" ] && [ $looks -lt 100 ]; do sleep 0.1; looks=$((looks + 1)); done
exit $code
"""
"""The leader of the session. Its death hangs up the terminal, so it waits until the terminal is restored, as a user's
shell stays. A signal's exit code is 128 + its number. Signals are as in a login shell: tests that run in the background
inherit an ignored SIGINT."""


class PseudoTerminal:
    """`type` writes keys, `written` is all output of the program; `close` hangs up."""

    def __init__(
        self, command: Sequence[str], environment: Mapping[str, str] | None = None, *, reading: bool = True
    ) -> None:
        """Without `reading` nothing takes the program's output, as on a link that stalls."""
        self._master, self._slave = pty.openpty()
        fcntl.ioctl(self._slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
        self.before = termios.tcgetattr(self._slave)
        self._shell = subprocess.Popen(
            ["env", "--default-signal=INT,QUIT", "setsid", "--ctty", "sh", "-c", SHELL, "sh", *command],
            stdin=self._slave,
            stdout=self._slave,
            stderr=self._slave,
            env={**os.environ, "TERM": "xterm", **(environment or {})},
        )
        self._written = b""
        self._closed = threading.Event()
        if reading:
            self.read_on()

    def read_on(self) -> None:
        """Reads the program's output."""
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def written(self) -> bytes:
        return self._written

    @property
    def screen(self) -> str:
        """The newest drawing, as lines."""
        text = self._written.decode(errors="replace").rpartition("\x1b[H")[2]
        return text.replace("\x1b[K", "").replace("\x1b[J", "").replace("\r", "")

    def settings(self) -> list[object]:
        """The terminal's settings now."""
        return termios.tcgetattr(self._slave)

    def type(self, keys: str) -> None:
        os.write(self._master, keys.encode())

    def hold(
        self,
        key: str,
        seconds: float,
        delay: float = 0.3,
        period: float = 0.03,
        until: Callable[[], bool] = lambda: False,
    ) -> None:
        """Types as a keyboard does, for that time, or `until` that holds."""
        end = time.monotonic() + seconds
        self.type(key)
        time.sleep(delay)
        while time.monotonic() < end and not until():
            self.type(key)
            time.sleep(period)

    def close(self) -> None:
        """Hangs up."""
        self._closed.set()
        if hasattr(self, "_reader"):
            self._reader.join()
        os.close(self._slave)
        os.close(self._master)

    def send_signal(self, number: int) -> None:
        """Sends a signal to the program."""
        children = Path(f"/proc/{self._shell.pid}/task/{self._shell.pid}/children")
        for pid in children.read_text().split():
            os.kill(int(pid), number)

    def wait(self) -> int:
        return self._shell.wait(LIMIT)

    def end(self) -> None:
        """Ends the program in whatever state it is."""
        if self._shell.poll() is None:
            self.send_signal(signal.SIGCONT)
            self.send_signal(signal.SIGKILL)
            self._shell.kill()  # it may wait for room on the terminal
            self._shell.wait()
        if not self._closed.is_set():
            self.close()

    def _read(self) -> None:
        while not self._closed.is_set():
            if select.select([self._master], [], [], 0.05)[0]:
                with contextlib.suppress(OSError):
                    self._written += os.read(self._master, 65536)
