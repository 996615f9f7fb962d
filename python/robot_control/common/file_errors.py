"""Errors of files in words for a user."""

import stat
from collections.abc import Iterator
from pathlib import Path

from robot_control.common.files import file_error


def in_words(error: Exception) -> str:
    """The message of any exception; of an OSError which file it is and why, without its number."""
    if not isinstance(error, OSError) or error.strerror is None:
        return str(error)
    if error.filename is None:
        return error.strerror
    return file_error(str(error.filename), error.strerror)


def problems_of(setting: str, path: Path, *, secret: bool, remedy: str = "") -> Iterator[str]:
    """Why the file that a setting names cannot be used; a secret one must be readable for its owner alone."""
    try:
        path.read_bytes()
        if secret and stat.S_IMODE(path.stat().st_mode) & 0o077:
            yield f"{setting} = {path}: others can read it; chmod 600 {path}"
    except OSError as error:
        yield f"{setting} = {path}: cannot be read: {error.strerror}{remedy}"
