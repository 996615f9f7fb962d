"""A recording from formulas: a robot on level ground that follows its commands exactly, without any noise."""

import numpy as np

from bench.odometry.errors import Errors
from bench.odometry.recording import TRUTH_EVERY, Recording

PERIOD = 0.001  # s
RADIUS, BASE = 0.1, 0.5  # m
GRAVITY = 9.81


def drive(*legs, errors=Errors(0.0, 0.0, 0.0, 0.0), bias=0.0, scenario="random", marks=None):  # noqa: B008 (frozen)
    """`legs`: (m/s, rad/s, s), one after the other, without ramps; `bias` rad/s of the gyro about z."""
    linear, angular = (np.concatenate([np.full(round(leg[2] / PERIOD), leg[i]) for leg in legs]) for i in (0, 1))
    count = len(linear) + 1
    yaw = np.concatenate([[0.0], np.cumsum(angular) * PERIOD])
    heading = (yaw[1:] + yaw[:-1]) / 2
    x = np.concatenate([[0.0], np.cumsum(linear * np.cos(heading)) * PERIOD])
    y = np.concatenate([[0.0], np.cumsum(linear * np.sin(heading)) * PERIOD])
    linear, angular = (np.concatenate([speed, speed[-1:]]) for speed in (linear, angular))
    half = BASE * (1 + errors.wheel_base) / 2
    rates = [
        (linear + side * half * angular) / (RADIUS * (1 + error))
        for side, error in ((-1, errors.left_radius), (1, errors.right_radius))
    ]
    left, right = (np.concatenate([[0.0], np.cumsum(rate[:-1]) * PERIOD]) for rate in rates)
    gyro, accel = np.zeros((count, 3)), np.zeros((count, 3))
    # The mean of a trapezoid's two samples has to be the rate between them; it is exact except in the cycle of a jump.
    gyro[:, 2] = (1 + errors.gyro_scale) * angular + bias
    accel[:, 2] = GRAVITY
    index = np.arange(0, count, TRUTH_EVERY)
    zero = np.zeros(count)
    return Recording(
        scenario=scenario,
        seed=0,
        time=np.arange(count) * PERIOD,
        left=left + 3.0,  # encoders begin anywhere
        right=right - 2.0,
        gyro=gyro,
        accel=accel,
        index=index,
        position=np.column_stack([x, y, zero])[index],
        orientation=np.column_stack([zero, zero, np.sin(yaw / 2), np.cos(yaw / 2)])[index],
        linear=np.column_stack([linear, zero, zero])[index],
        angular=np.column_stack([zero, zero, angular])[index],
        wheel_speed=np.column_stack(rates)[index],
        slip=np.zeros((len(index), 2)),
        load=np.full((len(index), 2), 45.0),
        up=np.array([0.0, 0.0, 1.0]),
        stopped=False,
        nominal={"wheel_radius": RADIUS, "wheel_base": BASE},
        errors=errors,
        marks=marks or {},
    )
