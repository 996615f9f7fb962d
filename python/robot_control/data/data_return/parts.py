"""A file as parts and a manifest, and back. `zcat -f` over the parts in order of their names gives the file, too."""

import ctypes
import errno
import gzip
import json
import os
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, BinaryIO

from robot_control.data.data_return.plan import PART_BYTES, Entry, Part, identity
from robot_control.files.kept_file import digest_of

MANIFEST = "manifest.json"
MAX_FILE = 1 << 24
"""bytes of a part, packed and not, and of a manifest; each is in memory while it is verified"""
HELPS = 0.9
"""a part is sent compressed if that makes it, and its first SAMPLE bytes, shorter than this share"""
SAMPLE = 1 << 16
"""bytes: a part that does not compress, as those of most bags, costs a 64th of the time"""
FORMAT = 1
KERNEL = ctypes.CDLL(None, use_errno=True)
HERE, RENAME_NOREPLACE = -100, 1
"""AT_FDCWD of openat(2); of renameat2(2)"""
RANGES = {"size": (0, 2**63 - 1), "mtime_ns": (-(2**65), 2**65), "part_size": (1, MAX_FILE)}
"""of the numbers of a manifest"""


class GapError(ValueError):
    """A file cannot be put together; the message names the gap."""


class ChangedError(RuntimeError):
    """A file is not the one that was to be packed, or no more."""


@contextmanager
def opened(path: Path, key: str) -> Iterator[int]:
    """The descriptor of the file of this key. A block that ends without an exception has read this file alone.

    Raises:
        ChangedError: another file has the name, or it changed within the block.
        OSError: it cannot be read.
    """
    try:
        file = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except FileNotFoundError:
        raise ChangedError("it now has another name") from None
    try:
        before = os.fstat(file)
        if identity(before) != key:
            raise ChangedError("another file now has its name")
        yield file
        after = os.fstat(file)
        if identity(after) != key or (after.st_nlink and after.st_ctime_ns != before.st_ctime_ns):  # or was deleted
            raise ChangedError("it changed while it was read")
    finally:
        os.close(file)


@contextmanager
def set_aside(path: Path) -> Iterator[Path]:
    """The file under a name that nothing else uses, within the block. A file that is still there gets its own again.

    It may be another file than the one that was meant: `opened` refuses it. After a SIGKILL in it see `get_back`.

    Raises:
        ChangedError: no file has the name.
        OSError: it cannot be renamed.
    """
    aside = path.with_name(f"_{path.name}")
    try:
        while not renamed(path, aside):
            aside = aside.with_name(f"_{aside.name}")
    except FileNotFoundError:
        raise ChangedError("it now has another name") from None
    try:
        yield aside
    finally:
        with suppress(OSError):  # it was deleted, or keeps the other name
            renamed(aside, path)


def get_back(path: Path, key: str) -> None:
    """Gives the file of this key its name again if a program that was killed left it set aside."""
    aside = path.with_name(f"_{path.name}")
    with suppress(OSError):
        if identity(aside.lstat()) == key:
            renamed(aside, path)


def renamed(path: Path, new: Path) -> bool:
    """False if the new name exists already. A file system without RENAME_NOREPLACE is asked for that name just before.

    Raises:
        OSError: it cannot be renamed.
    """
    if KERNEL.renameat2(HERE, os.fsencode(path), HERE, os.fsencode(new), RENAME_NOREPLACE) == 0:
        return True
    error = ctypes.get_errno()
    if error == errno.EEXIST or (error == errno.EINVAL and os.path.lexists(new)):
        return False
    if error != errno.EINVAL:
        raise OSError(error, os.strerror(error), str(path))
    path.rename(new)
    return True


def packed(file: int, number: int) -> tuple[Part, bytes]:
    """A part of an open file, and its content; the same whenever it is packed. Raises OSError."""
    raw = os.pread(file, PART_BYTES, number * PART_BYTES)
    for tried in (raw[:SAMPLE], raw):
        data = gzip.compress(tried, compresslevel=1, mtime=0)
        if len(data) >= HELPS * len(tried):
            return Part(f"{number:05d}", len(raw), digest_of(raw)), raw
    return Part(f"{number:05d}.gz", len(data), digest_of(data)), data


def manifest(entry: Entry) -> bytes:
    """Content of the manifest of a file whose parts are all verified."""
    content = {"format": FORMAT, "name": entry.path, "size": entry.size, "mtime_ns": entry.mtime_ns}
    parts = [asdict(entry.parts[number]) for number in range(entry.count)]
    return json.dumps({**content, "part_size": PART_BYTES, "parts": parts}, indent=1).encode()


def read_manifest(data: bytes) -> Mapping[str, Any]:
    """The content. Raises GapError: it is cut off, of another format, or none of a file."""
    try:
        content = json.loads(data)
        if content["format"] != FORMAT:
            raise GapError(f"{MANIFEST} has another format than {FORMAT}, which is read")
        parts = [read_part(each, number) for number, each in enumerate(content["parts"])]
        numbers = {name: int(content[name]) for name in RANGES}
        for name, (least, most) in RANGES.items():
            if not least <= numbers[name] <= most:
                raise GapError(f"{MANIFEST}: {name} is {numbers[name]}, and must be from {least} to {most}")
        if not parts:
            raise GapError(f"{MANIFEST} lists no part")
        return {"name": str(content["name"]), "parts": parts, **numbers}
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        if isinstance(error, GapError):
            raise
        raise GapError(f"{MANIFEST} is cut off or damaged") from None


def read_part(given: Mapping[str, Any], number: int) -> Part:
    """The part of this number as it stands in a manifest or a queue. Raises GapError, KeyError, TypeError."""
    part = Part(given["name"], given["size"], given["sha256"])
    if not isinstance(part.name, str) or not isinstance(part.sha256, str) or type(part.size) is not int:
        raise TypeError
    if part.name.removesuffix(".gz") != f"{number:05d}":
        raise GapError(f"{MANIFEST} does not list the parts one by one")
    if not 0 <= part.size <= MAX_FILE:
        raise GapError(f"{part.name} has {part.size} bytes, and must have from 0 to {MAX_FILE}")
    return part


def put_together(read: Callable[[str], bytes], out: BinaryIO | None) -> Mapping[str, Any]:
    """Writes the file, or verifies its parts alone. `read` gives a file of the folder on the far side.

    Raises:
        GapError: with every gap.
        OSError: nothing can be written.
    """
    content, gaps, size = read_manifest(_read(read, MANIFEST)), [], 0
    for number, part in enumerate(content["parts"], 1):
        try:
            raw = _unpacked(_read(read, part.name), part, min(content["part_size"], content["size"] - size))
        except GapError as error:
            gaps.append(f"part {number} of {len(content['parts'])}: {error}")
            continue
        size += len(raw)
        if out is not None:
            out.write(raw)
    if not gaps and size != content["size"]:
        gaps.append(f"the parts hold {size} of {content['size']} bytes")
    if gaps:
        raise GapError("; ".join(gaps))
    return content


def _read(read: Callable[[str], bytes], name: str) -> bytes:
    try:
        return read(name)
    except FileNotFoundError:
        raise GapError(f"{name} is missing") from None


def _unpacked(data: bytes, part: Part, longest: int) -> bytes:
    if len(data) != part.size:
        raise GapError(f"{part.name} has {len(data)} of {part.size} bytes")
    if digest_of(data) != part.sha256:
        raise GapError(f"{part.name} has different content than was sent")
    try:
        raw = zlib.decompressobj(wbits=31).decompress(data, longest + 1) if part.name.endswith(".gz") else data
    except zlib.error as error:
        raise GapError(f"{part.name} is not compressed as gzip does: {error}") from None
    if len(raw) > longest:
        raise GapError(f"{part.name} holds more than {longest} bytes")
    return raw
