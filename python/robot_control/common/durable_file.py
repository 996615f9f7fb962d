"""A file that holds either its old or its new content, whatever ends the program or the machine meanwhile."""

from __future__ import annotations

import os
from pathlib import Path


def write_durably(path: Path, text: str) -> None:
    """The new content is on the disk when this returns. Raises OSError; the old content then stays.

    A loss of power before the rename leaves the old file, for the new content is flushed first; after it the folder is
    flushed, so that the rename outlives one, too.
    """
    partial = path.with_suffix(".partial")
    descriptor = os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    try:
        left = memoryview(text.encode())
        while left:
            left = left[os.write(descriptor, left) :]
        os.fsync(descriptor)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        os.close(descriptor)
    os.replace(partial, path)  # noqa: PTH105 (beside the other calls of os, which a test replaces together)
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)
