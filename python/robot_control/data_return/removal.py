"""Deletes a file only if it is the one that is meant, whatever others do with its name meanwhile.

It is held open from before the proof that it may be deleted, so that no other file gets its inode. Then it is given a
name of its own, which nothing else uses. A file that turns out to be another one is put back.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from robot_control.data_return.parts import ChangedError
from robot_control.data_return.plan import identity

SUFFIX = ".data_return"


@contextmanager
def removal(path: Path) -> Iterator[Callable[[], None]]:
    """Gives what deletes the file that now has this name, within the block.

    It raises ChangedError if another file has the name by then, or the file was touched since the block began; that
    file stays. Raises OSError, ChangedError.
    """
    try:
        file = os.open(path, os.O_PATH | os.O_NOFOLLOW)
    except FileNotFoundError:
        raise ChangedError(f"{path.name} has another name by now") from None
    try:
        before = os.fstat(file)
        yield lambda: _remove(path, before)
    finally:
        os.close(file)


def _remove(path: Path, before: os.stat_result) -> None:
    aside = path.with_name(f".{path.name}{SUFFIX}")
    if os.path.lexists(aside):
        put_back(aside)
    try:
        if (now := path.lstat()).st_ctime_ns != before.st_ctime_ns or identity(now) != identity(before):
            raise ChangedError(f"{path.name} is another file by now")
        path.rename(aside)
    except FileNotFoundError:
        raise ChangedError(f"{path.name} has another name by now") from None
    if identity(aside.lstat()) != identity(before):
        put_back(aside)
        raise ChangedError(f"{path.name} is another file by now")
    aside.unlink()


def is_aside(path: Path) -> bool:
    """`remove` was ended before it was done."""
    return path.name.startswith(".") and path.name.endswith(SUFFIX)


def put_back(aside: Path) -> None:
    """Gives a file its name back, with a `_` before it where another one has it by now. Raises OSError."""
    path = aside.with_name(aside.name[1:].removesuffix(SUFFIX))
    while os.path.lexists(path):
        path = path.with_name(f"_{path.name}")
    try:
        os.link(aside, path, follow_symlinks=False)  # replaces nothing, unlike a rename
    except FileExistsError:
        put_back(aside)
    except OSError:  # a folder, or a file system without links
        aside.rename(path)
    else:
        aside.unlink()
