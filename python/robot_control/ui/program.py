"""The outermost call of a program writes each line at once, and reports an output that fails without a traceback."""

import contextlib
import io
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

from robot_control.files.files import fit_for_message, in_words


def run(main: Callable[[], int | None]) -> None:
    """Calls `main`; its result is the exit code, as that of `sys.exit`.

    A line that is printed reaches a file or a pipe at once, not when Python's buffer is full.

    If the reader of the output has left, as after `| head`, the program ends silently with 141, as SIGPIPE ends others.
    An output that cannot be written, and any other OSError, is one message and exit code 1.
    """
    if isinstance(sys.stdout, io.TextIOWrapper):  # it is None after `>&-`
        sys.stdout.reconfigure(line_buffering=True)
    try:
        try:
            sys.exit(main())
        finally:
            if sys.stdout is not None:
                sys.stdout.flush()
    except BrokenPipeError:
        _discard_output()
        sys.exit(128 + signal.SIGPIPE)
    except OSError as error:
        _discard_output()
        sys.exit(f"{Path(sys.argv[0]).name}: {fit_for_message(in_words(error))}")


def _discard_output() -> None:
    """Python would try to write the rest of its buffer again at the end, and fail again."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
