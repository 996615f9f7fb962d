"""A terminal that reports every key at once and shows one screen; every end of the program restores it.

The terminal is opened a second time, non-blocking: a stalled link then delays no loop, and the shell's own descriptors
stay as they are. The program's other output goes to a file, and to the terminal at the end.

An ordinary end restores the terminal here. A process in a group of its own (`_guard`) waits for the end of the program
and restores the rest. After SIGKILL or a crash that is everything, and on a stalled terminal the screen.
"""

import os
import select
import shutil
import signal
import sys
import tempfile
import termios
from collections.abc import Sequence
from contextlib import suppress
from types import TracebackType
from typing import Any, Self

from robot_control.drive.keys.keyboard import END_RELEASES, QUERY_RELEASES

REPORTING = b"9;1000;1001;1002;1003;1004;1005;1006;1007;1015;1016"
"""modes in which a terminal reports what is no key: the mouse, its wheel as arrow keys, the focus"""
PASTE = b"2004"
"""a paste is marked as one, so that no letter of it is a key"""
MODES = REPORTING + b";" + PASTE
BEGIN = (
    b"\x1b[?1049h\x1b[?25l\x1b[2J\x1b[?" + MODES + b"s\x1b[?" + REPORTING + b"l\x1b[?" + PASTE + b"h" + QUERY_RELEASES
)
"""alternate screen, no cursor, modes saved and set (xterm's control sequences)"""
END = END_RELEASES + b"\x1b[?" + PASTE + b"l\x1b[?" + MODES + b"r\x1b[?25h\x1b[?1049l"
"""modes as before; off if the terminal saves none"""
MAX_READ = 4096
"""bytes"""
SETTINGS, ALL = b"settings", b"all"
"""parts that the program has restored, as reported to its guard"""


class NoTerminalError(RuntimeError):
    """The standard input is no terminal, or one without control sequences, or it is gone."""


def undelayed(settings: list[Any]) -> list[Any]:
    """Terminal settings (termios.tcgetattr): no echo, no lines, no flow control, no Ctrl-Z; Ctrl-C stays a signal."""
    changed = [*settings[:6], list(settings[6])]
    changed[0] &= ~(termios.IXON | termios.ICRNL)
    changed[3] &= ~(termios.ECHO | termios.ICANON | termios.IEXTEN)
    changed[6][termios.VMIN], changed[6][termios.VTIME] = 1, 0
    for stop in (termios.VSUSP, termios.VQUIT):
        changed[6][stop] = b"\x00"
    return changed


def refuse_without_sequences(name: str) -> None:
    """Raises NoTerminalError for the value of TERM that stands for a terminal without control sequences, or none."""
    if name in {"", "dumb", "unknown"}:
        what = f"{f'TERM={name}' if name else 'TERM is not set'}: the screen needs a terminal with control sequences"
        raise NoTerminalError(f"{what}; start it in one, or, if this terminal has them, with TERM=xterm")


class Terminal:
    """Use as `with Terminal() as terminal`."""

    def __init__(self, descriptor: int = 0) -> None:
        """Raises NoTerminalError."""
        try:
            self._settings = termios.tcgetattr(descriptor)
            refuse_without_sequences(os.environ.get("TERM", ""))
            self._descriptor = os.open(os.ttyname(descriptor), os.O_RDWR | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        except (OSError, termios.error) as error:
            why = "the standard input is not a terminal; start it in one (not in a launch file)"
            raise NoTerminalError(why) from error
        self._unwritten = b""
        self._printed = tempfile.TemporaryFile()  # noqa: SIM115 (as long as this object)
        self._outputs = [os.dup(number) for number in (1, 2)]
        self._guard_pipe = -1
        self._guard_process = 0

    def __enter__(self) -> Self:
        self._start_guard()
        for number in (1, 2):
            os.dup2(self._printed.fileno(), number)
        termios.tcsetattr(self._descriptor, termios.TCSANOW, undelayed(self._settings))
        termios.tcflush(self._descriptor, termios.TCIFLUSH)  # what was typed before was typed for another program
        self.write(BEGIN)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        sys.stdout.flush()
        sys.stderr.flush()
        self._unwritten = b""
        _restore_settings(self._descriptor, self._settings)
        if _restore_screen(self._descriptor):
            os.write(self._guard_pipe, ALL)
            os.waitpid(self._guard_process, 0)
        else:
            os.write(self._guard_pipe, SETTINGS)
        os.close(self._guard_pipe)
        for number, original in zip((1, 2), self._outputs, strict=True):
            os.dup2(original, number)
            os.close(original)
        self._printed.seek(0)
        with suppress(OSError), open(os.dup(1), "wb") as output:  # noqa: PTH123 (a descriptor; it may be gone)
            shutil.copyfileobj(self._printed, output)

    def read(self, timeout: float) -> bytes:
        """Bytes that were typed, without delay; empty after `timeout` s.

        Raises:
            NoTerminalError: the terminal is gone.
        """
        if not select.select([self._descriptor], [], [], timeout)[0]:
            return b""
        try:
            data = os.read(self._descriptor, MAX_READ)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise NoTerminalError("the terminal is gone") from error
        if not data:
            raise NoTerminalError("the terminal is gone")
        return data

    def size(self) -> tuple[int, int]:
        """Columns and lines."""
        try:
            size = os.get_terminal_size(self._descriptor)
        except OSError:
            return 80, 24
        return (size.columns, size.lines) if size.columns and size.lines else (80, 24)

    def draw(self, lines: Sequence[str]) -> None:
        """Draws the screen from its first line on; it is skipped while the one before is still being written."""
        columns, height = self.size()
        if not self._flush():
            return
        shown = [line[:columns].encode(errors="replace") + b"\x1b[K" for line in lines[:height]]
        self.write(b"\x1b[H" + b"\r\n".join(shown) + b"\x1b[J")

    def write(self, data: bytes) -> None:
        """Writes without waiting; the rest is written at the next call."""
        self._unwritten += data
        self._flush()

    def _flush(self) -> bool:
        try:
            while self._unwritten:
                self._unwritten = self._unwritten[os.write(self._descriptor, self._unwritten) :]
        except OSError:
            return False  # it stalls, or is gone: read() says so
        return True

    def _start_guard(self) -> None:
        reading, self._guard_pipe = os.pipe()
        self._guard_process = os.fork()
        if self._guard_process == 0:
            os.close(self._guard_pipe)
            _guard(reading, self._descriptor, self._settings)
        os.setpgid(self._guard_process, 0)  # a signal to the program's process group does not end it
        os.close(reading)


def _restore_settings(descriptor: int, settings: list[Any]) -> None:
    with suppress(termios.error):  # it may be gone
        termios.tcsetattr(descriptor, termios.TCSANOW, settings)


def _restore_screen(descriptor: int) -> bool:
    """False if the terminal takes no bytes now."""
    try:
        return os.write(descriptor, END) == len(END)
    except BlockingIOError:
        return False
    except OSError:
        return True  # it is gone


def _guard(pipe: int, descriptor: int, settings: list[Any]) -> None:
    """Another process, which restores at the end of the program what is not restored yet."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGTTOU, signal.SIGTSTP):
        signal.signal(number, signal.SIG_IGN)
    try:
        done = os.read(pipe, 16)
        if not done:
            _restore_settings(descriptor, settings)
        while done != ALL and not _restore_screen(descriptor):
            select.select([], [descriptor], [])
    finally:
        os._exit(0)
