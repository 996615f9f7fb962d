"""Odometry for logs that have none: made from a reference, with errors by a seed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bench.navigation.trajectories import composed, steps

Array = NDArray[np.float64]

SCALE, DRIFT = 0.01, 0.002  # of the distance; rad/m: constant in a log
NOISE = 0.004  # m per √m, in x and y
TURN_NOISE = 0.01  # rad per √rad and per √m


def made(reference: Array, seed: int) -> Array:
    """Poses (n, 3) [m, m, rad] of an odometry that begins at zero."""
    numbers = np.random.default_rng(seed)
    scale, drift = 1 + numbers.normal(0, SCALE), numbers.normal(0, DRIFT)
    poses = [np.zeros(3)]
    for step in steps(reference):
        length, turn = np.hypot(step[0], step[1]), abs(step[2])
        spread = np.array([NOISE**2 * length] * 2 + [TURN_NOISE**2 * (turn + length)])
        seen = np.array([scale * step[0], scale * step[1], step[2] + drift * length])
        poses.append(composed(poses[-1], seen + numbers.normal(0, np.sqrt(spread))))
    return np.array(poses)
