"""The true map of a scene, from its MJCF file: boxes and cylinders that stand on the floor or move on paths."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

HEIGHT = 0.35
"""m: what begins higher is passed below; a table's plate is"""
RESOLUTION = 0.05
"""m"""
MARGIN = 0.5
"""m of unknown around"""

Map = tuple[float, float, float, NDArray[np.int8]]
"""origin x, origin y, resolution [m], cells of shape (rows, columns): 0 free, 100 occupied, -1 unknown"""


@dataclass(frozen=True)
class Obstacle:
    """A box or a cylinder, seen from above; a cylinder has half_y = 0."""

    x: float  # m
    y: float
    half_x: float  # m; radius of a cylinder
    half_y: float
    path: tuple[float, ...] = ()  # m/s, then corners x, y [m]; empty: it stands

    def outline(self, time: float, spacing: float = 0.02) -> NDArray[np.float64]:
        """Points (n, 2) on its border at this time."""
        x, y = self.at(time)
        if not self.half_y:
            angles = np.arange(0, 2 * math.pi, spacing / self.half_x)
            return np.column_stack([x + self.half_x * np.cos(angles), y + self.half_x * np.sin(angles)])
        xs = np.linspace(-self.half_x, self.half_x, max(2, int(2 * self.half_x / spacing)))
        ys = np.linspace(-self.half_y, self.half_y, max(2, int(2 * self.half_y / spacing)))
        sides = [np.column_stack([xs, np.full_like(xs, side)]) for side in (-self.half_y, self.half_y)]
        sides += [np.column_stack([np.full_like(ys, side), ys]) for side in (-self.half_x, self.half_x)]
        points: NDArray[np.float64] = np.concatenate(sides) + np.array([x, y])
        return points

    def at(self, time: float) -> tuple[float, float]:
        """Its middle at this time, by the law of drivers/mujoco/model/mocap_paths.h."""
        if not self.path:
            return self.x, self.y
        speed, corners = self.path[0], list(zip(self.path[1::2], self.path[2::2], strict=True))
        sides = list(pairwise([*corners, corners[0]]))
        left = (speed * time) % sum(math.dist(a, b) for a, b in sides)
        for a, b in sides:
            length = math.dist(a, b)
            if left <= length:
                return a[0] + (b[0] - a[0]) * left / length, a[1] + (b[1] - a[1]) * left / length
            left -= length
        return corners[0]


def read_scene(path: Path) -> list[Obstacle]:
    """All obstacles that the robot may touch."""
    root = ET.parse(path).getroot()
    paths = {
        str(item.get("name")).removeprefix("path/"): tuple(map(float, str(item.get("data")).split()))
        for item in root.iter("numeric")
    }
    world = root.find("worldbody")
    if world is None:
        return []
    found = [_obstacle(geom, geom) for geom in world.findall("geom")]
    for body in world.findall("body"):
        moves = paths.get(str(body.get("name")), ())
        found += [_obstacle(geom, body, moves) for geom in body.findall("geom")]
    return [obstacle for obstacle in found if obstacle is not None]


def _obstacle(geom: ET.Element, placed: ET.Element, path: tuple[float, ...] = ()) -> Obstacle | None:
    kind = geom.get("type", "box")
    if kind not in {"box", "cylinder"}:
        return None
    x, y, z = map(float, str(placed.get("pos")).split())
    size = list(map(float, str(geom.get("size")).split()))
    if z - size[-1] > HEIGHT:
        return None
    return Obstacle(x, y, size[0], size[1] if kind == "box" else 0.0, path)


def true_map(obstacles: list[Obstacle]) -> Map:
    """The cells that standing obstacles touch are occupied, the others free."""
    standing = [obstacle for obstacle in obstacles if not obstacle.path]
    points = np.concatenate([obstacle.outline(0) for obstacle in standing])
    low, high = points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN
    columns, rows = (math.ceil(size / RESOLUTION) for size in high - low)
    x = low[0] + (np.arange(columns) + 0.5) * RESOLUTION
    y = low[1] + (np.arange(rows) + 0.5) * RESOLUTION
    cells = np.zeros((rows, columns), dtype=np.int8)
    half = RESOLUTION / 2
    for item in standing:
        if item.half_y:
            cells[np.ix_(abs(y - item.y) < item.half_y + half, abs(x - item.x) < item.half_x + half)] = 100
        else:
            cells[np.hypot(x[None, :] - item.x, y[:, None] - item.y) < item.half_x + half] = 100
    return float(low[0]), float(low[1]), RESOLUTION, cells
