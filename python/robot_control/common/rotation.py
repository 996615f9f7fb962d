"""Orientations as matrices."""

from collections.abc import Sequence

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
