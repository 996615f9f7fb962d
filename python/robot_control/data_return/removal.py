"""Deletes a file only if it is the one that is meant, whatever others do with its name meanwhile.

The file is first given a name of its own, which nothing else uses. A file that turns out to be another one is put back.
"""

from __future__ import annotations

import os
from pathlib import Path

from robot_control.data_return.parts import ChangedError
from robot_control.data_return.plan import identity

SUFFIX = ".data_return"


def remove(path: Path, key: str) -> None:
    """Deletes the file of this key. Raises OSError, and ChangedError: another one or none has its name, and stays."""
    aside = path.with_name(f".{path.name}{SUFFIX}")
    if os.path.lexists(aside):
        put_back(aside)
    try:
        path.rename(aside)
    except FileNotFoundError:
        raise ChangedError(f"{path.name} has another name by now") from None
    if identity(aside.lstat()) != key:
        put_back(aside)
        raise ChangedError(f"{path.name} is another file by now")
    aside.unlink()


def is_aside(path: Path) -> bool:
    """`remove` was ended before it was done."""
    return path.name.startswith(".") and path.name.endswith(SUFFIX)


def put_back(aside: Path) -> None:
    """Gives a file its name back, with more of `_` where another one has it by now. Raises OSError."""
    path = aside.with_name(aside.name[1:].removesuffix(SUFFIX))
    while os.path.lexists(path):
        path = path.with_stem(f"{path.stem}_")
    try:
        os.link(aside, path, follow_symlinks=False)  # replaces nothing, unlike a rename
    except FileExistsError:
        put_back(aside)
    except OSError:  # a folder, or a file system without links
        aside.rename(path)
    else:
        aside.unlink()
