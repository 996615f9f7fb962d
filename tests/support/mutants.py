"""Damaged copies of a valid input, for the fuzzes of the boundaries of Python programs."""

from __future__ import annotations

import random
import struct
from collections.abc import Iterator

WORDS = (0, 1, 0x7F, 0xFF, 0x7FFFFFFF, 0xFFFFFFFF, 1 << 20)
NUMBERS = (float("nan"), float("inf"), -float("inf"), 1e308, 5e-324, -0.0, 1e155)
TEXTS = (b"\x00", b'"', b'\\"', b"\xff\xfe", b"[" * 40, b"{", b"e308", b"NaN", b"null", "\u2028".encode(), b"../", b"-")


def mutants(valid: bytes, count: int, seed: int) -> Iterator[bytes]:
    """`count` copies, each damaged in one to three places; the same seed gives the same."""
    draw = random.Random(seed)
    for _ in range(count):
        data = bytearray(valid)
        for _ in range(draw.randint(1, 3)):
            _damage(data, draw)
        yield bytes(data)


def _damage(data: bytearray, draw: random.Random) -> None:
    at = draw.randrange(len(data) + 1)
    end = min(len(data), at + draw.randint(1, 64))
    match draw.randrange(8):
        case 0:
            del data[at:]
        case 1:
            del data[at:end]
        case 2:
            data[at:at] = data[at:end] * draw.randint(1, 50)
        case 3:
            data[at : at + 4] = struct.pack("<I", draw.choice(WORDS))
        case 4:
            data[at : at + 8] = struct.pack("<d", draw.choice(NUMBERS))
        case 5:
            data[at:at] = draw.choice(TEXTS) * draw.choice((1, 1, 1, 1000))
        case 6:
            data[at:end] = draw.choice(TEXTS)
        case _:
            if at < len(data):
                data[at] ^= 1 << draw.randrange(8)
