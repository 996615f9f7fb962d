"""Odometry for logs that have none: made from a reference, with errors by a seed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bench.navigation.trajectories import composed, steps

Array = NDArray[np.float64]

SCALE, DRIFT = 0.01, 0.002  # of the distance; rad/m: constant in a log
NOISE = 0.004  # m per √m, in x and y
TURN_NOISE = 0.01  # rad per √rad and per √m
FIELD = 5.0  # times as much: wheels and floors of the field, without a gyroscope


def spread_of(step: Array) -> Array:
    """Variances (3) of a step in its own axes, without those of a whole log."""
    length, turn = np.hypot(step[0], step[1]), abs(step[2])
    return np.array([NOISE**2 * length] * 2 + [TURN_NOISE**2 * (turn + length)])


def covariances(odometry: Array, scale: float = 1.0) -> Array:
    """The covariances (n, 3, 3) that this odometry reports, with `scale` times the deviations of the model."""
    sums = [np.zeros((3, 3))]
    for pose, step in zip(odometry[:-1], steps(odometry), strict=True):
        length, cosine, sine = np.hypot(step[0], step[1]), np.cos(pose[2]), np.sin(pose[2])
        turned = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        moved = turned @ step
        carried = np.array([[1, 0, -moved[1]], [0, 1, moved[0]], [0, 0, 1]])
        spread = spread_of(step) + np.array([SCALE * length, SCALE * length, DRIFT * length]) ** 2
        sums.append(carried @ sums[-1] @ carried.T + scale**2 * turned @ np.diag(spread) @ turned.T)
    return np.array(sums)


def made(reference: Array, seed: int) -> Array:
    """Poses (n, 3) [m, m, rad] of an odometry that begins at zero."""
    numbers = np.random.default_rng(seed)
    scale, drift = 1 + numbers.normal(0, SCALE), numbers.normal(0, DRIFT)
    poses = [np.zeros(3)]
    for step in steps(reference):
        length = np.hypot(step[0], step[1])
        seen = np.array([scale * step[0], scale * step[1], step[2] + drift * length])
        poses.append(composed(poses[-1], seen + numbers.normal(0, np.sqrt(spread_of(step)))))
    return np.array(poses)
