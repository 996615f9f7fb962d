"""Errors of a trajectory (n, 3) [m, m, rad] of a plane.

The relations are those of R. Kümmerle et al., On measuring the accuracy of SLAM algorithms, Autonomous Robots 27, 2009:
the true pose at a time as seen from that at another time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def wrapped(angle: Array) -> Array:
    """Within ±π."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def composed(outer: Array, inner: Array) -> Array:
    """Poses (…, 3) that are given in `outer`, in its frame."""
    cosine, sine = np.cos(outer[..., 2]), np.sin(outer[..., 2])
    x = outer[..., 0] + cosine * inner[..., 0] - sine * inner[..., 1]
    y = outer[..., 1] + sine * inner[..., 0] + cosine * inner[..., 1]
    return np.stack([x, y, wrapped(outer[..., 2] + inner[..., 2])], axis=-1)


def between(first: Array, second: Array) -> Array:
    """Poses (…, 3) of `second` as seen from `first`."""
    cosine, sine = np.cos(first[..., 2]), np.sin(first[..., 2])
    away = second - first
    x, y = cosine * away[..., 0] + sine * away[..., 1], cosine * away[..., 1] - sine * away[..., 0]
    return np.stack([x, y, wrapped(away[..., 2])], axis=-1)


def steps(poses: Array) -> Array:
    """Each pose but the first one, as seen from that before it."""
    return between(poses[:-1], poses[1:])


def at(time: Array, poses: Array, when: Array) -> Array:
    """The poses at other times, by interpolation."""
    yaw = np.interp(when, time, np.unwrap(poses[:, 2]))
    return np.column_stack([np.interp(when, time, poses[:, 0]), np.interp(when, time, poses[:, 1]), yaw])


def relation_errors(time: Array, poses: Array, relations: Array) -> tuple[float, float]:
    """Means of the error in translation [m] and rotation [degrees] over the relations (m, 8) within the time."""
    within = np.all((relations[:, :2] >= time[0]) & (relations[:, :2] <= time[-1]), axis=1)
    first, second = (at(time, poses, relations[within, column]) for column in (0, 1))
    off = between(relations[within][:, [2, 3, 7]], between(first, second))
    return float(np.mean(np.hypot(off[:, 0], off[:, 1]))), float(np.degrees(np.mean(np.abs(off[:, 2]))))


def absolute_error(poses: Array, reference: Array) -> float:
    """The RMS of the distance [m] after the best alignment of the positions."""
    given, wanted = (points[:, :2] - points[:, :2].mean(axis=0) for points in (poses, reference))
    u, _, v = np.linalg.svd(given.T @ wanted)
    turn = u @ np.diag([1, np.sign(np.linalg.det(u @ v))]) @ v
    return float(np.sqrt(np.mean(np.sum((given @ turn - wanted) ** 2, axis=1))))
