"""The priors of the odometry benchmark: the differences of a seed's robot and sensors from the estimator's parameters.

    wheel radii    left (1 + e), right (1 − e),  e ~ N(0, 0.5 %): their mean, which wheels and IMU do not show, is exact
    wheel base     1 + N(0, 2 %)
    gyro           bias N(0, 0.1 °/s), each axis; scale 1 + U(−0.1 %, 0.1 %), every axis the same
    all else       by the level, data_sheet or field: encoder of 4096 counts, noise, walks and accelerometer bias of a
                   BMI088; field: also what it adds by default (docs/simulation.md)

The radii's and the base's are those of Borenstein & Feng, "Measurement and Correction of Systematic Odometry Errors in
Mobile Robots", IEEE Trans. Robotics and Automation 12(6), 1996, in kind: unequal wheels, an uncertain base.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

RADIUS_DEVIATION = 0.005
BASE_DEVIATION = 0.02
GYRO_BIAS = np.deg2rad(0.1)  # rad/s
GYRO_SCALE = 0.001
STREAM = 1  # index of this random stream; the scenarios use another one


@dataclass(frozen=True)
class Errors:
    """Relative: 0.01 is 1 % more than nominal."""

    left_radius: float
    right_radius: float
    wheel_base: float
    gyro_scale: float

    def plant(self) -> dict[str, Any]:
        """Parameters of `mujoco_plant`."""
        return {
            "left_radius_error": self.left_radius,
            "right_radius_error": self.right_radius,
            "wheel_base_error": self.wheel_base,
            "gyro_scale_error": self.gyro_scale,
            "gyro_bias": float(GYRO_BIAS),
        }


def draw_errors(seed: int) -> Errors:
    """Errors of a seed; they are the same in every scenario, as if one robot drove them all."""
    random = np.random.default_rng([STREAM, seed])
    radius = RADIUS_DEVIATION * random.standard_normal()
    base = BASE_DEVIATION * random.standard_normal()
    return Errors(radius, -radius, base, random.uniform(-GYRO_SCALE, GYRO_SCALE))
