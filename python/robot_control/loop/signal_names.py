"""The words of signals/names.h."""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_control._robot_control import signal_names

_ALL: dict[str, list[Any]] = signal_names
_REQUEST = {"request": "cmd_vel", "request_timeout": "cmd_vel_timeout"}
"""topic and parameter of requests of a robot on wheels (signals/robot_kinds.h); Kind.worded names those of legs"""


@dataclass(frozen=True)
class BitName:
    """One bit of a set."""

    name: str
    sentence: str
    remedy: str = ""
    unit: str = ""
    """unit of the measurement that belongs to the bit"""


def states(kind: str) -> list[str]:
    """Names of the states in the order of their numbers."""
    return list(_ALL[kind])


def number_of(kind: str, name: str) -> int:
    """Number of a state."""
    return states(kind).index(name)


def mask_of(kind: str, *names: str) -> int:
    """The bits of these names."""
    known = [one.name for one in bits(kind)]
    return sum(1 << known.index(name) for name in names)


def bits(kind: str) -> list[BitName]:
    """All bits, the lowest first."""
    return [
        BitName(row.name, _of_any_robot(row.sentence), _of_any_robot(row.remedy), row.unit) for row in templates(kind)
    ]


def templates(kind: str) -> list[BitName]:
    """All bits, the lowest first, with {driver}, {request} and the like in place of names of a robot."""
    return [BitName(*row) for row in _ALL[kind]]


def _of_any_robot(text: str) -> str:
    """Roles stand for the programs that play them."""
    return re.sub(r"\{(\w+)\}", lambda hole: _REQUEST.get(hole[1], f"the {hole[1]}"), text)


def bit(kind: str, number: int) -> BitName:
    """The bit of this number, which may be that of a later version of the log."""
    known = bits(kind)
    return known[number] if number < len(known) else BitName(f"bit {number}", "unknown to this version")


def bits_in(kind: str, value: int) -> list[BitName]:
    """All bits that are set in `value`."""
    return [bit(kind, number) for number in range(value.bit_length()) if value >> number & 1]


def causes_in(column: NDArray[np.float64]) -> list[str]:
    """Names of all bits of StopCause that were ever set in a column, lowest first. A NaN stands for no message."""
    found = int(np.bitwise_or.reduce(column[~np.isnan(column)].astype(np.int64), initial=0))
    return [cause.name for cause in bits_in("StopCause", found)]
