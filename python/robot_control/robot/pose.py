"""Orientations as matrices and as headings, and poses in the plane."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from nav_msgs.msg import Odometry

FARTHEST = 1e6
"""m, m/s, rad; a larger number in a path or in odometry is none: its square may overflow"""


def rotation(quaternion: Sequence[float]) -> NDArray[np.float64]:
    """(3, 3), of x, y, z, w."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class _Quaternion(Protocol):
    x: float
    y: float
    z: float
    w: float


def yaw_of(q: _Quaternion) -> float:
    """rad, of a unit quaternion, for instance of geometry_msgs."""
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


def turned(angle: float) -> float:
    """The same angle in (−π, π]."""
    rest = math.remainder(angle, math.tau)
    return math.pi if rest <= -math.pi else rest


@dataclass(frozen=True)
class Pose:
    """Pose of the robot in one frame, for instance odom."""

    x: float  # m
    y: float  # m
    yaw: float  # rad

    def seen_from(self, start: Pose) -> tuple[float, float]:
        """m ahead of and to the left of `start`."""
        dx, dy = self.x - start.x, self.y - start.y
        cosine, sine = math.cos(start.yaw), math.sin(start.yaw)
        return cosine * dx + sine * dy, cosine * dy - sine * dx


def pose_of(odometry: Odometry) -> Pose:
    """The pose of a message."""
    pose = odometry.pose.pose
    return Pose(pose.position.x, pose.position.y, yaw_of(pose.orientation))
