"""rosbag that inflates no more than a bag can hold: eleven kilobytes of bz2 may hide six gigabytes."""

from __future__ import annotations

import bz2
import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from robot_control.common.files import LARGEST_TABLE, check_input

LARGEST_CHUNK = 256 << 20
"""bytes of one inflated chunk; rosbag record makes them of 768 kB unless --chunksize says otherwise"""
INFLATES_TO = 100
"""times its own size; telemetry in bz2 has 5 to 20"""
INFLATES_ANYHOW = 64 << 20
"""bytes that a small bag may have besides"""


class InflationError(ValueError):
    """A bag that inflates beyond its bounds."""


@contextmanager
def open_bag(path: Path) -> Iterator[Any]:
    """A `rosbag.Bag` for reading.

    Raises:
        InputFileError: no regular file, or too large.
        InflationError: a chunk, or all of them, would become too large, or larger than the chunk itself says.
        rosbag.ROSBagException: of rosbag.
    """
    import rosbag

    check_input(path, LARGEST_TABLE)
    with rosbag.Bag(str(path)) as bag:
        _bound(bag, path)
        yield bag


def _bound(bag: Any, path: Path) -> None:  # noqa: ANN401 (rosbag has no types)
    """Puts a chunk that is inflated within its bounds where rosbag looks for the last one that it inflated itself."""
    headers = getattr(bag, "_chunk_headers", {})
    sizes = [header.uncompressed_size for header in headers.values() if header.compression != "none"]
    most = INFLATES_ANYHOW + INFLATES_TO * path.stat().st_size
    if max(sizes, default=0) > LARGEST_CHUNK or sum(sizes) > most:
        raise InflationError(
            f"{path} inflates to {sum(sizes)} bytes, with a chunk of {max(sizes)}; read are {most} in all, "
            f"{LARGEST_CHUNK} in a chunk. If it is sound: rosbag decompress {path}"
        )
    reader = bag._reader  # noqa: SLF001 (rosbag offers no other place)
    original = reader.seek_and_read_message_data_record

    def bounded(position: Any, *rest: Any) -> Any:  # noqa: ANN401
        header = headers.get(position[0]) if isinstance(position, tuple) else None
        if header is not None and header.compression == "bz2" and reader.decompressed_chunk_pos != position[0]:
            file, encryptor = bag._file, bag._encryptor  # noqa: SLF001
            file.seek(header.data_pos)
            packed = encryptor.decrypt_chunk(file.read(header.compressed_size))
            reader.decompressed_chunk = inflated(packed, header.uncompressed_size)
            reader.decompressed_chunk_io = io.BytesIO(reader.decompressed_chunk)
            reader.decompressed_chunk_pos = position[0]
        return original(position, *rest)

    reader.seek_and_read_message_data_record = bounded


def inflated(packed: bytes, most: int) -> bytes:
    """bz2, one stream, of at most `most` bytes.

    Raises:
        InflationError: there are more.
        OSError, EOFError: it is broken.
    """
    engine = bz2.BZ2Decompressor()
    data = engine.decompress(packed, max_length=most + 1)
    if len(data) > most:
        raise InflationError(f"a chunk of the bag inflates to more than the {most} bytes that it says")
    if not engine.eof:
        raise EOFError("a chunk of the bag ends in the middle")
    return data
