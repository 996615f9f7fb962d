"""Errors of files in words for a user."""

from robot_control.common.files import file_error


def in_words(error: Exception) -> str:
    """The message of any exception; of an OSError which file it is and why, without its number."""
    if not isinstance(error, OSError) or error.strerror is None:
        return str(error)
    if error.filename is None:
        return error.strerror
    return file_error(str(error.filename), error.strerror)
