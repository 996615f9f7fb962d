"""Files that a user names, their errors, and text from them in a message: the same rules as src/files/."""

import contextlib
import errno
import os
import re
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Self

MAX_TABLE = 16 << 30
"""bytes of a log, a CSV or a bag"""
MAX_ECHO = 200
"""characters of any one input in a message"""
MAX_MESSAGE = 1500
"""characters of a sentence with several inputs in it"""

CALLER_FOLDER = "ROBOT_CONTROL_CALLER_FOLDER"
"""Environment variable in which a launch file passes the folder of its caller on."""

_given: dict[str, str] = {}
"""The given text of every resolved path that differs from it"""

_KINDS = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket"}
"""of what is not a regular file; anything else is a device"""
_FAILURES = {errno.EISDIR: "is a folder, not a file", errno.ENOSPC: "cannot be written: no space left on the disk"}
"""of a call for a file, in words; that of any other one is the system's"""
_PARTS = re.compile("\"[^\"]*\"|'[^']*'|[^ ]+| ")
"""of a line: quoted ones, words, blanks"""


class InputFileError(ValueError):
    """A path that is no file to read; the message names it."""


def given_path(given: str) -> Path:
    """A path as a user gives it: `~/` is the home, and a relative one counts from the folder that CALLER_FOLDER names,
    else from the current one. Every program resolves a path by it before it opens the file.
    """
    path = Path(given)
    with contextlib.suppress(RuntimeError):  # neither the environment nor the account has a home
        path = path.expanduser()
    path = Path(os.environ.get(CALLER_FOLDER, "")) / path
    _given[str(path.absolute())] = given
    return path


def file_error(path: str | os.PathLike[str], why: str) -> str:
    """A sentence that says what was given, what it became, and why it does not open."""
    became = str(Path(path).absolute())
    given = _given.get(became, os.fspath(path))
    return f"{given}: {why}{'' if given == became else f' ({became})'}"


def in_words(error: Exception) -> str:
    """The message of any exception; of an OSError which file it is and which operation failed, without its number."""
    if not isinstance(error, OSError) or error.strerror is None:
        return str(error)
    if error.filename is None:
        return error.strerror
    return file_error(str(error.filename), _failure(str(error.filename), error))


def _failure(path: str, error: OSError) -> str:
    folder = str(Path(path).absolute().parent)
    if error.errno == errno.ENOENT:
        return "file not found" if Path(folder).is_dir() else f"folder {folder} not found"
    if error.errno == errno.EACCES:
        writes = os.access(path, os.R_OK) or (os.access(folder, os.X_OK) and not os.path.lexists(path))
        return f"no permission to {'write' if writes else 'read'} it"
    return _FAILURES.get(error.errno or 0, str(error.strerror))


@contextlib.contextmanager
def one_message(program: str, *kinds: type[Exception]) -> Iterator[None]:
    """An error of these kinds, or a lack of memory, ends the program with its message and exit code 1."""
    try:
        yield
    except BrokenPipeError:  # the reader of the output has left: ui/program.py
        raise
    except kinds as error:
        sys.exit(f"{program}: {fit_for_message(in_words(error))}")
    except MemoryError:
        sys.exit(f"{program}: the input needs more memory than there is; cut it into pieces")


def problems_of(setting: str, path: Path, *, secret: bool, remedy: str = "") -> Iterator[str]:
    """Why the file that a setting names cannot be used; a secret one must be readable for its owner alone."""
    try:
        path.read_bytes()
        if secret and stat.S_IMODE(path.stat().st_mode) & 0o077:
            yield f"{setting} = {path}: others can read it; chmod 600 {path}"
    except OSError as error:
        yield f"{setting} = {path}: {_failure(str(path), error)}{remedy}"


def check_input(path: Path, max_size: int) -> None:
    """Accepts regular files of at most `max_size` bytes alone: a device has no end, and a FIFO may have no writer.

    Raises:
        InputFileError: it is none.
        OSError: it is not there, or may not be looked at.
    """
    status = path.stat()
    if not stat.S_ISREG(status.st_mode):
        kind = _KINDS.get(stat.S_IFMT(status.st_mode), "a device")
        raise InputFileError(file_error(path, f"is {kind}; only a regular file is read"))
    if status.st_size > max_size:
        raise InputFileError(file_error(path, f"has {status.st_size} bytes; at most {max_size} are read"))


def utf8(text: str | bytes | os.PathLike[str] | os.PathLike[bytes]) -> str:
    """A path or another text for the compiled part, which takes UTF-8 alone.

    Raises:
        InputFileError: it is of other bytes, as a file's name may be.
    """
    name = os.fsdecode(text)
    try:
        name.encode()
    except UnicodeEncodeError:
        raise InputFileError(f"{printable(name)} is not UTF-8, but only such names are supported: rename it") from None
    return name


def printable(text: str, max_length: int = MAX_ECHO) -> str:
    """Text from outside for a message: at most `max_length` characters of it, those that do not print as escapes."""
    return escaped(text[:max_length]) + ("…" if len(text) > max_length else "")


def escaped(line: str) -> str:
    """A line in which text from outside stands, for a terminal: characters that do not print, as escapes."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in line)


def escaped_lines(lines: Iterable[str]) -> str:
    """`escaped` lines, one below the other: a name that holds the end of a line begins none."""
    return "\n".join(map(escaped, lines))


def listed(names: Iterable[str]) -> str:
    """Names from outside, with commas, as `printable`."""
    return printable(", ".join(names))


def fit_for_message(sentence: str) -> str:
    """Sentences in which inputs stand already, a line each: words and quoted parts as by `printable`."""
    return "\n".join(_fit_line(line) for line in sentence.split("\n"))


def _fit_line(line: str) -> str:
    result = ""
    for part in _PARTS.finditer(line):
        if len(result) > MAX_MESSAGE:
            return result + " …"
        result += printable(part[0])
    return result


class NewFiles:
    """New files receive their content only if the block ends without an exception; otherwise all stay as they were.

    Nothing and regular files are replaced by a temporary file beside them, which has the old one's mode and owner. A
    symbolic link is followed to its file. A device, a FIFO or a socket is written to, never replaced; so is a file
    whose owner cannot be kept.
    """

    def __init__(self) -> None:
        self._names: list[tuple[Path, Path]] = []

    def name(self, final: Path) -> Path:
        """The path to write instead of `final` until the block ends.

        Raises:
            OSError: nothing can be written there.
        """
        # The resolved name of a pipe, as /dev/stdout may be, opens nothing.
        target = final if final.exists() and not final.is_file() else Path(os.path.realpath(final))
        if target.exists() and not target.is_file():
            descriptor, name = tempfile.mkstemp(prefix=f".{final.stem}.", suffix=final.suffix)
            os.close(descriptor)
            partial = Path(name)
        else:
            partial = target.with_name(f".{target.stem}.{os.getpid()}.partial{target.suffix}")
        self._names.append((partial, target))
        return partial

    def __enter__(self) -> Self:
        return self

    def __exit__(self, _kind: object, error: BaseException | None, _trace: object) -> None:
        try:
            if error is None:
                for partial, target in self._names:
                    _put(partial, target)
        except OSError as failure:
            if (named := self._named(failure)) is not failure:
                raise named from failure
            raise
        finally:
            for partial, _ in self._names:
                with contextlib.suppress(OSError):
                    partial.unlink()
        if isinstance(error, OSError) and (named := self._named(error)) is not error:
            raise named from error

    def _named(self, error: OSError) -> OSError:
        """The same error with the names that the user gave. A temporary file's name means nothing to a user, and the
        error of a full disk has none.
        """
        given = {str(partial): str(target) for partial, target in self._names}
        if error.errno is None or (error.filename is not None and error.filename not in given):
            return error
        name = ", ".join(given.values()) if error.filename is None else given[error.filename]
        return OSError(error.errno, error.strerror, name)


def write_text(path: Path, text: str) -> None:
    """`NewFiles` for one text.

    Raises:
        OSError: it cannot be written; what was there before stays.
    """
    with NewFiles() as files:
        partial = files.name(path)
        with partial.open("w", encoding="utf-8") as file:
            file.write(text)


def write_durably(path: Path, text: str) -> None:
    """The new content is on the disk when this returns. Raises OSError; the old content then stays.

    The content is flushed before the rename, so that a loss of power never leaves a part of it under this name. The
    folder is flushed after it, so that the rename outlives one, too.
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


def _put(partial: Path, target: Path) -> None:
    if target.exists() and not (target.is_file() and _takes_after(partial, target)):
        with partial.open("rb") as source, target.open("wb") as sink:
            shutil.copyfileobj(source, sink)
    else:
        partial.replace(target)


def _takes_after(partial: Path, old: Path) -> bool:
    """Gives the new file mode and owner of the old one; False: this user may not give it away."""
    was, now = old.stat(), partial.stat()
    if (was.st_uid, was.st_gid) != (now.st_uid, now.st_gid):
        try:
            os.chown(partial, was.st_uid, was.st_gid)
        except PermissionError:
            return False
    partial.chmod(stat.S_IMODE(was.st_mode))
    return True
