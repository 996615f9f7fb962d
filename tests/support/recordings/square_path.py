"""The path of UMBmark's square, as a robot without errors drives it."""

import math

import numpy as np


def square_path(side: float, *, clockwise: bool, per_metre: int = 100) -> np.ndarray:
    """(n, 3): the ideal path, corners turned on the spot, first side along x."""
    sign = -1 if clockwise else 1
    poses = [(0.0, 0.0, 0.0)]
    for leg in range(4):
        heading = sign * leg * math.pi / 2
        x, y, _ = poses[-1]
        parts = np.linspace(0, side, max(2, round(side * per_metre)))[1:]
        poses += [(x + part * math.cos(heading), y + part * math.sin(heading), heading) for part in parts]
        x, y, _ = poses[-1]
        poses += [(x, y, heading + part) for part in np.linspace(0, sign * math.pi / 2, 50)[1:]]
    return np.array(poses)
