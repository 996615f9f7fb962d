"""A robot that rolls exactly with its wheels, and the measurements of exact sensors."""

from dataclasses import dataclass

import numpy as np

RADIUS, WHEEL_BASE = 0.1, 0.5  # m
IMU = np.array([0.05, 0.02, 0.06])  # m, in base_link
GRAVITY = 9.81  # m/s²
STEP = 1e-4  # s; the trapezoids below err by less than 1e-6 m


@dataclass
class Drive:
    """At `time` (N,) s: pose, wheel angles [rad], gyro (N, 3) rad/s and accel (N, 3) m/s² in IMU = base axes."""

    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    yaw: np.ndarray
    linear: np.ndarray
    angular: np.ndarray
    left: np.ndarray
    right: np.ndarray
    gyro: np.ndarray
    accel: np.ndarray

    def at(self, time):
        """The same drive at other times within this one's."""
        names = [name for name in self.__dataclass_fields__ if name != "time"]
        values = {name: getattr(self, name) for name in names}
        taken = {
            name: np.column_stack([np.interp(time, self.time, column) for column in np.atleast_2d(value.T)])
            for name, value in values.items()
        }
        return Drive(np.asarray(time), **{n: v if v.shape[1] > 1 else v[:, 0] for n, v in taken.items()})


def _integral(rate):
    return np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2 * STEP)])


def drive(seconds=12.0, rest=2.0):
    """Rests, then drives smooth curves either way at up to 0.5 m/s and 0.5 rad/s."""
    t = np.arange(round(seconds / STEP) + 1) * STEP
    ramp = np.clip((t - rest) / 1.0, 0, 1)
    ramp = ramp * ramp * (3 - 2 * ramp)
    linear, angular = 0.5 * ramp, 0.5 * ramp * np.sin(0.9 * (t - rest))
    yaw = _integral(angular)
    x, y = _integral(linear * np.cos(yaw)), _integral(linear * np.sin(yaw))
    travel = _integral(linear)
    side = yaw * WHEEL_BASE / 2
    turning = np.gradient(angular, STEP)
    accel = np.column_stack([np.gradient(linear, STEP), linear * angular, np.full_like(t, GRAVITY)])
    accel[:, 0] += -turning * IMU[1] - angular**2 * IMU[0]
    accel[:, 1] += turning * IMU[0] - angular**2 * IMU[1]
    gyro = np.column_stack([np.zeros_like(t), np.zeros_like(t), angular])
    return Drive(t, x, y, yaw, linear, angular, (travel - side) / RADIUS, (travel + side) / RADIUS, gyro, accel)
