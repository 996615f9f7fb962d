"""The estimator under judgement: robot_control.Estimator with default parameters, over a recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_control.odometry_recording import TRUTH_EVERY, Recording
from robot_control.odometry_truth import Array, Track, Truth
from robot_control.offline_estimator import FLAGS, Estimator

OURS = "ours"  # its name among the methods
PLANAR = [0, 1, 5]  # x, y, yaw of a pose; of a twist 0 and 5 are forward speed and yaw rate
DRIVEN = [0, 5]


@dataclass(frozen=True)
class Ours:
    """At the M truth rows. `pose_covariance` (M, 3, 3) of x, y, yaw; `twist_covariance` (M, 2, 2) of `linear` m/s and
    `angular` rad/s; `slip`, `valid`: flags.
    """

    path: Track
    pose_covariance: Array
    linear: Array
    angular: Array
    twist_covariance: Array
    slip: NDArray[np.bool_]
    valid: NDArray[np.bool_]
    radius_ratio: Array
    wheel_base_factor: Array


def estimate(recording: Recording, gyro_until: float = np.inf) -> Ours:
    """`gyro_until`: s, from which on the gyro is dead (NaN)."""
    gyro = recording.gyro
    if np.isfinite(gyro_until):
        gyro = np.where(recording.time[:, None] < gyro_until, gyro, np.nan)
    out = Estimator().process(recording.time, recording.left, recording.right, gyro, recording.accel, every=TRUTH_EVERY)
    rows = slice(0, len(recording.index))  # without the last one, which is always there
    return Ours(
        path=Track(out["x"][rows], out["y"][rows], np.unwrap(out["yaw"][rows])),
        pose_covariance=out["pose_covariance"][rows][:, PLANAR][:, :, PLANAR],
        linear=out["linear"][rows, 0],
        angular=out["angular"][rows, 2],
        twist_covariance=out["twist_covariance"][rows][:, DRIVEN][:, :, DRIVEN],
        slip=(out["flags"][rows] & FLAGS["slip"]) != 0,
        valid=out["valid"][rows],
        radius_ratio=out["radius_ratio"][rows],
        wheel_base_factor=out["wheel_base_factor"][rows],
    )


def true_track(truth: Truth, method: str) -> Track:
    """Of the truth that a method is judged in: who does not know which way is up is judged in the ground's."""
    return truth.odom if method == OURS else truth.ground
