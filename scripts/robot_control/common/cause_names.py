"""The names of StopCause bits, and of the bits in a column of a log."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_control._robot_control import stop_causes

STOP_CAUSES: tuple[str, ...] = tuple(stop_causes)
"""In the order of the bits of StopCause."""


def causes_in(column: NDArray[np.float64]) -> list[str]:
    """Names of all that ever stood in it, lowest bit first; NaN, where the monitor published nothing, is none."""
    bits = int(np.bitwise_or.reduce(column[~np.isnan(column)].astype(np.int64), initial=0))
    return [name for bit, name in enumerate(_names(bits.bit_length())) if bits >> bit & 1]


def _names(count: int) -> list[str]:
    return [STOP_CAUSES[bit] if bit < len(STOP_CAUSES) else f"cause {bit}" for bit in range(count)]
