"""Errors of files in words for a user."""

from pathlib import Path


def in_words(error: Exception) -> str:
    """The message of any exception; of an OSError which file it is and why, without its number."""
    if not isinstance(error, OSError) or error.strerror is None:
        return str(error)
    if error.filename is None:
        return error.strerror
    name = str(error.filename)
    where = "" if Path(name).is_absolute() else f" (in {Path.cwd()})"
    return f"{name}{where} cannot be opened or written: {error.strerror}"
