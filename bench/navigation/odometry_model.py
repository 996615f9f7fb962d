"""Odometry for logs: made from a reference, with errors by a seed, and the covariance of either."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bench.navigation.trajectories import composed, steps

Array = NDArray[np.float64]

SCALE, DRIFT = 0.01, 0.002  # of the distance; rad/m: constant in a log
NOISE = 0.004  # m per √m, in x and y
TURN_NOISE = 0.01  # rad per √rad and per √m
FIELD = (0.1, 0.2, 0.1, 0.2)
"""Deviations of a raw odometry, the defaults of ROS's gmapping: m per m, m per rad, rad per m, rad per rad."""


def made(reference: Array, seed: int) -> tuple[Array, Array]:
    """Poses (n, 3) of an odometry that begins at zero, and their true covariances (n, 3, 3)."""
    numbers = np.random.default_rng(seed)
    scale, drift = 1 + numbers.normal(0, SCALE), numbers.normal(0, DRIFT)
    poses, covariances = [np.zeros(3)], [np.zeros((3, 3))]
    known = np.diag([0, 0, 0, SCALE**2, DRIFT**2])  # of x, y, yaw, scale, drift
    for step in steps(reference):
        length, turn = np.hypot(step[0], step[1]), abs(step[2])
        spread = np.array([NOISE**2 * length] * 2 + [TURN_NOISE**2 * (turn + length)])
        noise = numbers.normal(0, np.sqrt(spread))
        seen = np.array([scale * step[0], scale * step[1], step[2] + drift * length]) + noise
        known = _grown(known, poses[-1], seen, spread)
        poses.append(composed(poses[-1], seen))
        covariances.append(known[:3, :3].copy())
    return np.array(poses), np.array(covariances)


def _grown(known: Array, pose: Array, seen: Array, spread: Array) -> Array:
    """The covariance of x, y, yaw, scale and drift after this step."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    turned = np.array([[cosine, -sine], [sine, cosine]])
    moved = turned @ seen[:2]
    by_state = np.eye(5)
    by_state[:2, 2] = -moved[1], moved[0]
    by_state[:2, 3] = moved
    by_state[2, 4] = np.hypot(*seen[:2])
    by_noise = np.zeros((5, 3))
    by_noise[:2, :2], by_noise[2, 2] = turned, 1
    result: Array = by_state @ known @ by_state.T + by_noise @ np.diag(spread) @ by_noise.T
    return result


def field_covariances(odometry: Array) -> Array:
    """Covariances (n, 3, 3) of a raw odometry, by `FIELD`."""
    known, covariances = np.zeros((5, 5)), [np.zeros((3, 3))]
    for pose, step in zip(odometry[:-1], steps(odometry), strict=True):
        length, turn = np.hypot(step[0], step[1]), abs(step[2])
        deviation = np.array([FIELD[0] * length + FIELD[1] * turn] * 2 + [FIELD[2] * length + FIELD[3] * turn])
        known = _grown(known, pose, step, deviation**2)
        covariances.append(known[:3, :3].copy())
    return np.array(covariances)
