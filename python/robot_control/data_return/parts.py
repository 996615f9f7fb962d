"""A file as parts and a manifest, and back. `zcat -f` over the parts in order of their names gives the file, too."""

from __future__ import annotations

import gzip
import hashlib
import json
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, BinaryIO

from robot_control.data_return.plan import PART_BYTES, Entry, Part

MANIFEST = "manifest.json"
HELPS = 0.9
"""a part is sent compressed if that makes it, and its first SAMPLE bytes, shorter than this share"""
SAMPLE = 1 << 16
"""bytes: a part that does not compress, as those of most bags, costs a 64th of the time"""
FORMAT = 1
RANGES = {"size": (0, 2**63 - 1), "mtime_ns": (0, 2**63 - 1), "part_size": (1, 1 << 30)}
"""of the numbers of a manifest; a part is in memory while it is verified"""


class GapError(ValueError):
    """A file cannot be put together; the message names the gap."""


def packed(path: Path, number: int) -> tuple[str, bytes]:
    """Name and content of a part; the same whenever it is packed. Raises OSError."""
    with path.open("rb") as file:
        file.seek(number * PART_BYTES)
        raw = file.read(PART_BYTES)
    for tried in (raw[:SAMPLE], raw):
        short = gzip.compress(tried, compresslevel=1, mtime=0)
        if len(short) >= HELPS * len(tried):
            return f"{number:05d}", raw
    return f"{number:05d}.gz", short


def sha256(data: bytes) -> str:
    """Its hexadecimal digits."""
    return hashlib.sha256(data).hexdigest()


def manifest(entry: Entry) -> bytes:
    """Content of the manifest of a file whose parts are all verified."""
    parts = [
        {"name": part.name, "size": part.size, "sha256": part.sha256}
        for part in (entry.parts[number] for number in range(entry.count))
    ]
    content = {
        "format": FORMAT,
        "name": entry.path,
        "size": entry.size,
        "mtime_ns": entry.mtime_ns,
        "part_size": PART_BYTES,
        "parts": parts,
    }
    return json.dumps(content, indent=1).encode()


def read_manifest(data: bytes) -> Mapping[str, Any]:
    """The content. Raises GapError: it is cut off, of another format, or none of a file."""
    try:
        content = json.loads(data)
        if content["format"] != FORMAT:
            raise GapError(f"{MANIFEST} has format {content['format']}, and format {FORMAT} is read")
        parts = [Part(str(each["name"]), int(each["size"]), str(each["sha256"])) for each in content["parts"]]
        names = [part.name.removesuffix(".gz") for part in parts]
        if not parts or names != [f"{number:05d}" for number in range(len(parts))]:
            raise GapError(f"{MANIFEST} does not list the parts one by one")
        numbers = {name: int(content[name]) for name in RANGES}
        for name, (least, most) in RANGES.items():
            if not least <= numbers[name] <= most:
                raise GapError(f"{MANIFEST}: {name} is {numbers[name]}, and must be from {least} to {most}")
        return {"name": str(content["name"]), "parts": parts, **numbers}
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        if isinstance(error, GapError):
            raise
        raise GapError(f"{MANIFEST} is cut off or damaged") from None


def put_together(read: Callable[[str], bytes], out: BinaryIO | None) -> Mapping[str, Any]:
    """Writes the file, or verifies its parts alone. `read` gives a file of the folder on the far side.

    Raises:
        GapError: with every gap.
        OSError: nothing can be written.
    """
    content, gaps, size = read_manifest(_read(read, MANIFEST)), [], 0
    for number, part in enumerate(content["parts"], 1):
        try:
            raw = _unpacked(_read(read, part.name), part, content["part_size"])
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
    if sha256(data) != part.sha256:
        raise GapError(f"{part.name} has another content than was sent")
    if not part.name.endswith(".gz"):
        return data
    unpacker = zlib.decompressobj(wbits=31)
    try:
        raw = unpacker.decompress(data, longest)
    except zlib.error as error:
        raise GapError(f"{part.name} is not compressed as gzip does: {error}") from None
    if unpacker.unconsumed_tail:
        raise GapError(f"{part.name} holds more than {longest} bytes")
    return raw
