"""Checks the files that a program will write before its work, so that a typing error costs no minutes of driving."""

import os
from collections.abc import Sequence
from pathlib import Path

from robot_control.files.files import file_error


def check_outputs(outputs: Sequence[Path | None], inputs: Sequence[Path | None] = ()) -> None:
    """Checks the outputs; None stands for a file that the user did not name.

    Raises:
        ValueError: one of the outputs cannot be written, is one of the inputs, or is named twice.
    """
    seen: set[str] = set()
    for path in outputs:
        if path is None:
            continue
        _check_place(path)
        for given in inputs:
            if given is not None and path.exists() and given.exists() and path.samefile(given):
                why = f"{path} is an input of this program; set another name for the output"
                raise ValueError(why)
        name = os.path.realpath(path)
        if name in seen and not (path.exists() and not path.is_file()):
            raise ValueError(f"{path} is the name of two outputs; set a name for each")
        seen.add(name)


def _check_place(path: Path) -> None:
    if path.is_dir():
        raise ValueError(file_error(path, "is a folder; give the name of a file"))
    target = Path(os.path.realpath(path))
    if not path.exists() and target.is_symlink():
        raise ValueError(file_error(path, "cannot be written: its symbolic link leads to itself"))
    folder = target.parent if path.is_symlink() else path.parent
    if not folder.is_dir():
        raise ValueError(file_error(path, f"folder {folder} not found; create it first"))
    if path.exists() and not os.access(path, os.W_OK):
        raise ValueError(file_error(path, "no permission to write it"))
    if not path.exists() and not os.access(folder, os.W_OK):
        raise ValueError(file_error(path, f"no permission to write to the folder {folder}"))
