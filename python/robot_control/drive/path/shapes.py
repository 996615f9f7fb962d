"""Paths that begin at the origin along x and end at their begin."""

import math
from collections.abc import Callable

from robot_control.drive.path.waypoints import Waypoint

STEP = math.radians(2.0)
"""rad between two points of an arc"""


def square(size: float) -> list[Waypoint]:
    """Sides of `size` m, to the left."""
    corners = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)]
    return [*(Waypoint(x, y) for x, y in corners), Waypoint(0.0, 0.0, yaw=0.0)]


def circle(size: float) -> list[Waypoint]:
    """A circle of `size` m across, to the left."""
    return [*_arc(size / 2, 1.0)[:-1], Waypoint(0.0, 0.0, yaw=0.0)]


def eight(size: float) -> list[Waypoint]:
    """Two circles, together `size` m wide: one to the left, then one to the right."""
    return [*_arc(size / 4, 1.0)[:-1], *_arc(size / 4, -1.0)[:-1], Waypoint(0.0, 0.0, yaw=0.0)]


def _arc(radius: float, side: float) -> list[Waypoint]:
    """A full circle that touches the x axis in the origin; `side` 1: to the left."""
    steps = round(2 * math.pi / STEP)
    angles = (2 * math.pi * step / steps for step in range(steps + 1))
    return [Waypoint(radius * math.sin(angle), side * radius * (1 - math.cos(angle))) for angle in angles]


SHAPES: dict[str, Callable[[float], list[Waypoint]]] = {"square": square, "circle": circle, "eight": eight}
