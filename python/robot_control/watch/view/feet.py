"""The feet of the robot that is shown: the force of each one that bears, the way of each one that swings."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_control.watch.scene import Point

METRES_PER_NEWTON = 0.002
"""length of an arrow: the share of a leg of a robot of 13 kg is 6 cm"""
MAX_POINTS = 200
"""of the way of a swing"""

Array = NDArray[np.float64]


def load_arrows(places: Array, bears: Sequence[bool], loads: Sequence[float]) -> list[tuple[Point, Point]]:
    """Begin and end, in base axes, of the force of the ground on each foot that bears. `places`: m, shape (4, 3)."""
    arrows = []
    for (x, y, z), bearing, load in zip(places.tolist(), bears, loads, strict=False):
        if bearing and math.isfinite(load) and load > 0:
            arrows.append(((x, y, z), (x, y, z + METRES_PER_NEWTON * load)))
    return arrows


class Swings:
    """The way of each foot since it was lifted, as the controller wants it, in the frame of odometry."""

    def __init__(self, feet: int = 4) -> None:
        self.ways: list[list[Point]] = [[] for _ in range(feet)]
        self._swings = [False] * feet

    def add(self, places: Array, bears: Sequence[bool]) -> None:
        """Adds the present places of the feet, m in odom; the way of a swing stays until the next one."""
        for foot, (place, bearing) in enumerate(zip(places.tolist(), bears, strict=False)):
            if not bearing:
                way = self.ways[foot] if self._swings[foot] else []
                self.ways[foot] = [*way, (place[0], place[1], place[2])][-MAX_POINTS:]
            self._swings[foot] = not bearing


def in_odom(places: Array, pose: Any) -> Array:  # noqa: ANN401 (geometry_msgs/Pose)
    """Places in base axes → in the frame of the pose."""
    q, at = pose.orientation, pose.position
    w, axis = q.w, np.array([q.x, q.y, q.z])
    turned = places + 2 * np.cross(axis, np.cross(axis, places) + w * places)
    return np.asarray(turned + np.array([at.x, at.y, at.z]))
