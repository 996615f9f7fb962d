"""Selects the errors of a drive's sensors: those of the data sheet, of the field, or as recorded on real robots.

`recorded` is the field with vibrations as strong as the strongest of the recordings (`bench.odometry.recordings`). Its
measure is the standard deviation within WINDOW seconds on the axis that shakes most, while the robot moves. Noise of
the density D, up to the bandwidth f of the plant's vibration (sensor_errors.h), has a standard deviation of D·√(π f).
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.odometry.recordings import NAMES, FloatArray, Recording, recording

LEVELS = ("data_sheet", "field", "recorded")
WINDOW = 0.2  # s
BANDWIDTH = 50.0  # Hz, Vibration::kBandwidth
SLOWEST = 0.5  # m/s; slower robots are not scaled up to the speeds of these drives
FIELD = {"accelerometer_vibration": 0.12, "gyro_vibration": 7e-4}  # the plant's defaults


def plant_parameters(level: str) -> dict[str, Any]:
    """Parameters of the block `mujoco_plant`.

    Raises:
        FileNotFoundError: `recorded` without recordings.
    """
    if level != "recorded":
        return {"sensor_errors": level}
    return {"sensor_errors": "field", **recorded_vibration()}


@cache
def recorded_vibration() -> dict[str, float]:
    """The strongest vibration of all recordings, at least that of the field."""
    strongest = dict(FIELD)
    for name in NAMES:
        some = recording(name)
        speed, moving = _motion(some)
        for key, table in (("accelerometer_vibration", some.accel), ("gyro_vibration", some.gyro)):
            deviation = _shaking(some, table, moving)
            density = deviation / math.sqrt(math.pi * BANDWIDTH) / max(speed, SLOWEST)
            strongest[key] = max(strongest[key], density)
    return strongest


def _motion(some: Recording) -> tuple[float, NDArray[np.bool_]]:
    """Mean speed [m/s] in motion, and the samples of the IMU in motion."""
    read = ~np.isnan(some.left)
    time = some.time[read]
    sides = [np.abs(np.gradient(side[read], time)) for side in (some.left, some.right)]
    speed = _smooth((sides[0] + sides[1]) * some.radius / 2, time, 2 * WINDOW)
    at_imu = np.interp(some.time[~np.isnan(some.gyro[:, 2])], time, speed)
    moving: NDArray[np.bool_] = at_imu > 0.3 * np.percentile(at_imu, 90)
    return float(at_imu[moving].mean()), moving


def _shaking(some: Recording, table: FloatArray, moving: NDArray[np.bool_]) -> float:
    present = ~np.isnan(some.gyro[:, 2])
    time = some.time[present]
    fast = [column - _smooth(column, time, WINDOW) for column in table[present].T]
    return max(float(np.std(column[moving])) for column in fast)


def _smooth(values: FloatArray, time: FloatArray, seconds: float) -> FloatArray:
    count = max(1, round(seconds / float(np.median(np.diff(time)))))
    mean: FloatArray = np.convolve(values, np.ones(count) / count, "same")
    return mean
