"""The true motion in a recording, in the terms by which odometry is judged.

The truth is given in the frame G of the ground: origin and heading of the start, z the ground's normal. An estimate is
given in odom, which has the same origin and z against gravity, u in G. The rows of the rotation from G to odom are

    x = (e − (e·u) u)/|…|,  e = (1, 0, 0)        y = z × x        z = u

so that both headings are zero at the start. On the level both frames are the same. A method that integrates distance
and turns in the plane of the ground, as wheels alone do, is judged in G. A method that measures the vertical is judged
in odom: a slope of angle a shortens the way there by cos a.

The slip of a wheel follows from its true radius r and its speed q̇ relative to the body. The body turns by ω, and the
wheel's centre moves by v, both in base axes:

    rim = r (q̇ + ω_y)      ground = ±√(v_x² + v_z²), sign of v_x
    slip = |rim − ground| / max(|rim|, |ground|, 0.1 m/s)

The ground speed is that along the wheel's plane, upwards too: a wheel that rolls over a kerb does not slip. Sideways
sliding does not count. Below 0.1 m/s a difference of 2 cm/s is 20 %, so that a wheel at rest does not slip by a count.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bench.odometry.recording import Recording

Array = NDArray[np.float64]
SLOWEST = 0.1  # m/s, in the slip's denominator
MOVING = 0.01  # m/s, rad/s


@dataclass(frozen=True)
class Track:
    """M poses in a plane: m, m, rad."""

    x: Array
    y: Array
    yaw: Array


@dataclass(frozen=True)
class Truth:
    """The truth at the M truth rows of a recording. `linear` m/s along base x, `angular` rad/s about base z; `distance`
    m so far; `slip` (M, 2), left and right.
    """

    ground: Track
    odom: Track
    linear: Array
    angular: Array
    distance: Array
    slip: Array
    pitch: Array


def rotation(quaternion: Array) -> Array:
    """(M, 3, 3) from (M, 4), x y z w."""
    x, y, z, w = quaternion.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def levelling(up: Array) -> Array:
    """(3, 3): rotation from the ground's axes to odom."""
    ahead = np.array([1.0, 0.0, 0.0]) - up[0] * up
    ahead /= np.linalg.norm(ahead)
    return np.array([ahead, np.cross(up, ahead), up])


def slip_ratio(recording: Recording) -> Array:
    """(M, 2), as defined above."""
    errors, nominal = recording.errors, recording.nominal
    radius = nominal["wheel_radius"] * (1 + np.array([errors.left_radius, errors.right_radius]))
    beside = nominal["wheel_base"] * (1 + errors.wheel_base) / 2 * np.array([1.0, -1.0])  # m, y of the wheel
    rim = radius * (recording.wheel_speed + recording.angular[:, 1:2])
    ahead = recording.linear[:, 0:1] - recording.angular[:, 2:3] * beside
    upwards = recording.linear[:, 2:3] + recording.angular[:, 0:1] * beside
    ground = np.copysign(np.hypot(ahead, upwards), ahead)
    fastest = np.maximum(np.abs(rim), np.abs(ground))
    ratio: Array = np.abs(rim - ground) / np.maximum(fastest, SLOWEST)
    return ratio


def truth_of(recording: Recording) -> Truth:
    """The truth of a recording."""
    turned = rotation(recording.orientation)
    steps = np.linalg.norm(np.diff(recording.position, axis=0), axis=1)
    return Truth(
        ground=_path(recording.position, turned),
        odom=_path(recording.position @ levelling(recording.up).T, levelling(recording.up) @ turned),
        linear=recording.linear[:, 0],
        angular=recording.angular[:, 2],
        distance=np.concatenate([[0.0], np.cumsum(steps)]),
        slip=slip_ratio(recording),
        pitch=-np.arcsin(np.clip(turned[:, 2, 0], -1, 1)),
    )


def moving(truth: Truth) -> NDArray[np.bool_]:
    """(M,): true if the body moves by more than a robot that rocks to rest."""
    result: NDArray[np.bool_] = (np.abs(truth.linear) > MOVING) | (np.abs(truth.angular) > MOVING)
    return result


def after_resets(track: Track, rows: Sequence[int]) -> Track:
    """The same with its pose set to zero in these rows."""
    x, y, yaw = track.x.copy(), track.y.copy(), track.yaw.copy()
    for begin, end in pairwise([*rows, len(x)]):
        dx, dy = track.x[begin:end] - track.x[begin], track.y[begin:end] - track.y[begin]
        cos, sin = np.cos(track.yaw[begin]), np.sin(track.yaw[begin])
        x[begin:end], y[begin:end] = cos * dx + sin * dy, cos * dy - sin * dx
        yaw[begin:end] = track.yaw[begin:end] - track.yaw[begin]
    return Track(x, y, yaw)


def wrapped(angle: Array) -> Array:
    """rad, into [−π, π)."""
    return np.remainder(angle + np.pi, 2 * np.pi) - np.pi


def _path(position: Array, turned: Array) -> Track:
    return Track(position[:, 0], position[:, 1], np.unwrap(np.arctan2(turned[:, 1, 0], turned[:, 0, 0])))
