"""The words of signals/names.h."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from robot_control._robot_control import signal_names

_ALL: dict[str, list[Any]] = signal_names


@dataclass(frozen=True)
class BitName:
    """One bit of a set."""

    name: str
    sentence: str
    remedy: str = ""
    unit: str = ""
    """of the measurement that goes with it"""


def states(kind: str) -> list[str]:
    """In the order of their numbers."""
    return list(_ALL[kind])


def number_of(kind: str, name: str) -> int:
    """Of a state."""
    return states(kind).index(name)


def mask_of(kind: str, *names: str) -> int:
    """The bits of these names."""
    known = [one.name for one in bits(kind)]
    return sum(1 << known.index(name) for name in names)


def bits(kind: str) -> list[BitName]:
    """Lowest first."""
    return [BitName(*row) for row in _ALL[kind]]


def bit(kind: str, number: int) -> BitName:
    """A log may hold bits of a later version."""
    known = bits(kind)
    return known[number] if number < len(known) else BitName(f"bit {number}", "unknown to this version")


def bits_in(kind: str, value: int) -> list[BitName]:
    """Of all bits that are set."""
    return [bit(kind, number) for number in range(value.bit_length()) if value >> number & 1]
