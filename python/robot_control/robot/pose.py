"""Orientations as matrices and as headings, and poses in the plane."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from nav_msgs.msg import Odometry

FloatArray = NDArray[np.float64]
FARTHEST = 1e6
"""m, m/s, rad; a larger number in a path or in odometry is none: its square may overflow"""


def rotation(quaternion: Sequence[float]) -> FloatArray:
    """(3, 3), of x, y, z, w."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def rpy(matrix: FloatArray) -> tuple[float, float, float]:
    """Roll, pitch and yaw in rad, turned about the fixed axes x, y, z in this order; (3, 3)."""
    pitch = math.asin(max(-1.0, min(1.0, -float(matrix[2, 0]))))
    if abs(matrix[2, 0]) > 1 - 1e-9:
        return 0.0, pitch, math.atan2(-float(matrix[0, 1]), float(matrix[1, 1]))
    return math.atan2(matrix[2, 1], matrix[2, 2]), pitch, math.atan2(matrix[1, 0], matrix[0, 0])


def yaw_of(q: Any) -> float:  # noqa: ANN401 (geometry_msgs/Quaternion, or its like)
    """rad, of a unit quaternion, for instance of geometry_msgs."""
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


def turned(angle: float) -> float:
    """The same angle in (−π, π]."""
    rest = math.remainder(angle, math.tau)
    return math.pi if rest <= -math.pi else rest


def arcs_between(x: FloatArray, y: FloatArray, yaw: FloatArray) -> tuple[FloatArray, FloatArray]:
    """m and rad of the arc from each pose to the next one: a chord c that turns by φ is c·(φ/2)/sin(φ/2) long."""
    turn = np.remainder(np.diff(yaw) + np.pi, 2 * np.pi) - np.pi
    middle = yaw[:-1] + turn / 2
    chord = np.diff(x) * np.cos(middle) + np.diff(y) * np.sin(middle)
    return chord / np.sinc(turn / (2 * np.pi)), turn  # numpy's sinc(u) is sin(πu)/(πu)


def along_arcs(lengths: FloatArray, turns: FloatArray) -> FloatArray:
    """(n + 1, 3) x, y [m] and yaw [rad], not wrapped, from the origin over n arcs of these m and rad."""
    yaw = np.concatenate([[0.0], np.cumsum(turns)])
    chord, middle = lengths * np.sinc(turns / (2 * np.pi)), yaw[:-1] + turns / 2
    steps = np.cumsum([chord * np.cos(middle), chord * np.sin(middle)], axis=1)
    return np.column_stack([np.pad(steps, ((0, 0), (1, 0))).T, yaw])


@dataclass(frozen=True)
class Pose:
    """Pose of the robot in one frame, for instance odom."""

    x: float  # m
    y: float  # m
    yaw: float  # rad

    def holding(self, x: float, y: float) -> tuple[float, float]:
        """m, in the frame of this pose: the point that lies x ahead of and y to the left of it."""
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        return self.x + cosine * x - sine * y, self.y + sine * x + cosine * y

    def seen_from(self, start: Pose) -> tuple[float, float]:
        """m ahead of and to the left of `start`."""
        dx, dy = self.x - start.x, self.y - start.y
        cosine, sine = math.cos(start.yaw), math.sin(start.yaw)
        return cosine * dx + sine * dy, cosine * dy - sine * dx


def pose_of(odometry: Odometry) -> Pose:
    """The pose of a message."""
    pose = odometry.pose.pose
    return Pose(pose.position.x, pose.position.y, yaw_of(pose.orientation))
