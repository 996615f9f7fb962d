"""Runs the tested estimator, robot_control.Estimator with default parameters, over a recording."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from robot_control.loop.estimator import FLAGS, Estimate, Estimator

from bench.odometry.recording import TRUTH_EVERY, Recording
from bench.odometry.truth import Array, Track, Truth

OURS = "ours"  # its name among the methods
PLANAR = [0, 1, 5]  # x, y, yaw of a pose; of a twist 0 and 5 are forward speed and yaw rate
DRIVEN = [0, 5]


@dataclass(frozen=True)
class Ours:
    """The estimate at the M truth rows. `pose_covariance` (M, 3, 3) is that of x, y, yaw, `twist_covariance` (M, 2, 2)
    that of `linear` m/s and `angular` rad/s; `slip`, `valid` are flags.
    """

    path: Track
    pose_covariance: Array
    linear: Array
    angular: Array
    twist_covariance: Array
    slip: NDArray[np.bool_]
    valid: NDArray[np.bool_]


def estimate(recording: Recording, gyro_until: float = np.inf) -> Ours:
    """Estimates; from `gyro_until` s on the gyro is dead (NaN)."""
    gyro = recording.gyro
    if np.isfinite(gyro_until):
        gyro = np.where(recording.time[:, None] < gyro_until, gyro, np.nan)
    out = _processed([recording.time, recording.left, recording.right, gyro, recording.accel], resets_of(recording))
    return Ours(
        path=Track(out["x"], out["y"], np.unwrap(out["yaw"])),
        pose_covariance=out["pose_covariance"][:, PLANAR][:, :, PLANAR],
        linear=out["linear"][:, 0],
        angular=out["angular"][:, 2],
        twist_covariance=out["twist_covariance"][:, DRIVEN][:, :, DRIVEN],
        slip=(out["flags"] & FLAGS["slip"]) != 0,
        valid=out["valid"],
    )


def resets_of(recording: Recording) -> list[int]:
    """Truth rows at which the odometry is reset: UMBmark's ten starts."""
    if recording.scenario != "umbmark":
        return []
    return [-(-cycle // TRUTH_EVERY) for cycle in sorted(recording.marks["cw"] + recording.marks["ccw"])]


def _processed(samples: list[Array], resets: list[int]) -> Estimate:
    """The rows of truth. The last row of a part is always returned, and dropped if it is not among them."""
    bounds = [0, *(TRUTH_EVERY * row for row in resets), len(samples[0])]
    estimator, parts = Estimator(), []
    for begin, end in pairwise(bounds):
        if begin:
            estimator.reset_odometry()
        out = estimator.process(*(table[begin:end] for table in samples), every=TRUTH_EVERY)
        rows = slice(0, -(-(end - begin) // TRUTH_EVERY))
        parts.append({name: values[rows] for name, values in out.items()})
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def true_track(truth: Truth, method: str) -> Track:
    """The frame in which a method is judged: that of the ground for a method that does not measure the vertical."""
    return truth.odom if method == OURS else truth.ground
