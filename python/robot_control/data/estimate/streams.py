"""Splits a recording by sensor, for the checks of an input."""

from dataclasses import dataclass

import numpy as np

from robot_control.data.estimate.samples import FloatArray, Robot, Samples
from robot_control.robot.pose import rotation

REST = 0.5
"""s without motion that count as rest"""
STILL = 0.002
"""m of a side's travel that count as rest: one count of a coarse encoder"""


@dataclass(frozen=True)
class Streams:
    """Each sensor at its own times [s], from the first row of the recording on."""

    wheel_time: FloatArray  # (n,)
    left: FloatArray  # (n,) m, travel of the side, forwards positive
    right: FloatArray
    gyro_time: FloatArray  # (m,)
    gyro: FloatArray  # (m, 3) rad/s, IMU axes
    accel_time: FloatArray  # (k,)
    accel: FloatArray  # (k, 3) m/s², IMU axes
    base_from_imu: FloatArray  # (3, 3), as the mounting says
    wheel_base: float  # m, effective

    @property
    def way(self) -> FloatArray:
        """(n,) m, travel of the middle of the wheels."""
        return (self.left + self.right) / 2

    def rests(self) -> list[tuple[float, float]]:
        """Begin and end [s] of every rest of the wheels of at least `REST`."""
        found = []
        first = 0
        for row in range(1, self.wheel_time.size + 1):
            still = row < self.wheel_time.size and all(
                abs(side[row] - side[first]) <= STILL for side in (self.left, self.right)
            )
            if not still:
                begin, end = float(self.wheel_time[first]), float(self.wheel_time[row - 1])
                if end - begin >= REST:
                    found.append((begin, end))
                first = row
        return found


def streams_of(samples: Samples, robot: Robot) -> Streams:
    """The streams of all measurements."""
    seconds = samples.seconds
    left, right = (_travel(table, robot, side) for table, side in ((samples.left, "left"), (samples.right, "right")))
    read = ~(np.isnan(left) | np.isnan(right))
    imu = (*_axes(seconds, samples.gyro), *_axes(seconds, samples.accel), rotation(robot["imu"]["orientation"]))
    return Streams(seconds[read], left[read], right[read], *imu, float(robot["effective_wheel_base"]))


def _travel(table: FloatArray, robot: Robot, side: str) -> FloatArray:
    """(N,) m: mean travel of the side's wheels; a single column has the sign of the side's first wheel."""
    wheels = [wheel for wheel in robot["wheels"] if wheel["side"] == side]
    columns = table.reshape(table.shape[0], -1)
    scales = [wheel["sign"] * wheel["radius"] for wheel in wheels[: columns.shape[1]]]
    return np.asarray((columns * scales).mean(axis=1))


def _axes(seconds: FloatArray, table: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    if table is None:
        return np.empty(0), np.empty((0, 3))
    present = ~np.any(np.isnan(table), axis=1)
    return seconds[present], table[present]
