"""Orientations as matrices and as headings."""

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray


def rotation(quaternion: Sequence[float]) -> NDArray[np.float64]:
    """(3, 3), of x, y, z, w."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class _Quaternion(Protocol):
    x: float
    y: float
    z: float
    w: float


def yaw_of(q: _Quaternion) -> float:
    """rad, of a unit quaternion, for instance of geometry_msgs."""
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
