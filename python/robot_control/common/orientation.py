"""Orientations of messages."""

import math

from geometry_msgs.msg import Quaternion


def yaw_of(q: Quaternion) -> float:
    """rad, of a unit quaternion."""
    yaw: float = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return yaw
