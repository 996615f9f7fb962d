"""The outermost call of a program: what a user's shell does to its output is no traceback."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

from robot_control.common.file_errors import in_words
from robot_control.common.files import fit_for_message


def run(main: Callable[[], object]) -> None:
    """Calls `main`.

    Where the reader of the output has left, as after `| head`, the program ends as SIGPIPE ends others: without a word,
    with 141. An output that cannot be written, and any other OSError, is one message and exit code 1.
    """
    try:
        try:
            main()
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
    """What is still in Python's buffer would fail again at the end."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
