"""A value of JSON in a file, which a program keeps over its end, or over a loss of power at any moment.

The first line is the digest of the second one, so that nothing is taken from a file that was damaged or is another.
"""

import errno
import hashlib
import json
import os
from pathlib import Path
from typing import Any

from robot_control.files.files import check_input, write_durably

MAX_KEPT = 1 << 26
"""bytes; a state of the fleet client has 400,000 with an order of 500 nodes, a queue of data return 300 of each file"""


class DamagedError(ValueError):
    """A file does not hold what was written; the message names it."""


def digest_of(payload: bytes) -> str:
    """SHA-256 as hexadecimal digits: says whether a payload is another one."""
    return hashlib.sha256(payload).hexdigest()


def read_kept(path: Path) -> Any:  # noqa: ANN401 (JSON)
    """The value; None if there is no such file. Raises DamagedError, InputFileError, OSError."""
    if not path.exists():
        return None
    check_input(path, MAX_KEPT)
    digest, _, text = path.read_bytes().partition(b"\n")
    if digest != digest_of(text).encode():
        raise DamagedError(f"{path}: its digest is wrong")
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise DamagedError(f"{path}: {error}") from None


def write_kept(path: Path, value: object) -> None:
    """Raises OSError: it cannot be written, or is too long; the old value then stays."""
    text = json.dumps(value)
    if len(text) > MAX_KEPT // 2:
        raise OSError(errno.EFBIG, os.strerror(errno.EFBIG), str(path))
    write_durably(path, f"{digest_of(text.encode())}\n{text}")


def put_aside(path: Path) -> Path:
    """The new name of a file that cannot be used. Raises OSError."""
    return path.replace(path.with_name(f"{path.name}.damaged"))
