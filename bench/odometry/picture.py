"""The data of one run for a plot, at 20 Hz."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench.odometry.recording import Recording
from bench.odometry.tested_estimator import Ours, true_track
from bench.odometry.truth import Array, Track, Truth

EVERY = 5  # truth rows


@dataclass(frozen=True)
class Picture:
    """`deviation` m: standard deviation of the position along its worst direction."""

    time: Array
    distance: Array
    truth: Track
    paths: dict[str, Track]
    error: dict[str, Array]
    deviation: Array
    slip: Array
    flagged: Array


def picture_of(recording: Recording, truth: Truth, ours: Ours, paths: dict[str, Track]) -> Picture:
    """Reduces the judged data; `paths` by method, ours among them."""

    def thin(path: Track) -> Track:
        return Track(path.x[::EVERY], path.y[::EVERY], path.yaw[::EVERY])

    def error(path: Track, true: Track) -> Array:
        distance: Array = np.hypot(path.x - true.x, path.y - true.y)[::EVERY]
        return distance

    worst = np.linalg.eigvalsh(ours.pose_covariance[::EVERY, :2, :2])[:, 1]
    return Picture(
        time=recording.time[recording.index][::EVERY],
        distance=truth.distance[::EVERY],
        truth=thin(truth.odom),
        paths={name: thin(path) for name, path in paths.items()},
        error={name: error(path, true_track(truth, name)) for name, path in paths.items()},
        deviation=np.sqrt(np.maximum(worst, 0)),
        slip=truth.slip.max(axis=1)[::EVERY],
        flagged=ours.slip[::EVERY].astype(float),
    )
