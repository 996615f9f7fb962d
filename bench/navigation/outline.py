"""The true outline of a scene at the height of the laser, and scenes of which a part was moved."""

from __future__ import annotations

import math
import random
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from robot_control.installed_files import share_file

LASER_HEIGHT = 0.25  # m, of the laser of diffbot
GLASS = "1"  # its geom group (drivers/mujoco/sensors/laser.h)
CLEAR = 0.6  # m that a moved shape keeps from the tour
MOVED = 0.8  # m


@dataclass
class Shape:
    """A box or a standing cylinder, seen from above."""

    x: float
    y: float
    half_x: float  # m; the radius of a cylinder
    half_y: float
    round: bool

    def distance(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """From its surface, m, inside and outside; `points` has the shape (n, 2)."""
        away = np.abs(points - (self.x, self.y))
        if self.round:
            return np.abs(np.hypot(*away.T) - self.half_x)
        beyond = away - (self.half_x, self.half_y)
        outside = np.hypot(*np.maximum(beyond, 0).T)
        return np.where(np.all(beyond < 0, axis=1), -np.max(beyond, axis=1), outside)


def _numbers(text: str) -> list[float]:
    return [float(word) for word in text.split()]


def _shape(geom: ET.Element) -> Shape | None:
    if geom.get("type") == "plane":
        return None
    x, y, z = _numbers(geom.get("pos", "0 0 0"))
    size = _numbers(geom.get("size", ""))
    if abs(z - LASER_HEIGHT) > size[-1] or geom.get("group") == GLASS:
        return None
    return Shape(x, y, size[0], size[1] if len(size) == 3 else size[0], round=len(size) == 2)


def outline(scene: Path) -> list[Shape]:
    """The shapes of its world that stand still and that a laser can see."""
    world = ET.parse(scene).getroot().find("worldbody")
    assert world is not None
    return [shape for geom in world.findall("geom") if (shape := _shape(geom)) is not None]


def distances(shapes: Sequence[Shape], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the nearest surface, m."""
    return np.min([shape.distance(points) for shape in shapes], axis=0)


def _on_tour(corners: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
    """Points of the tour, 0.1 m apart."""
    pairs = zip(corners, corners[1:], strict=False)
    parts = [np.linspace(a, b, math.ceil(math.dist(a, b) / 0.1) + 1) for a, b in pairs]
    return np.concatenate(parts)


def partly_moved(scene: str, corners: Sequence[tuple[float, float]], part: float, seed: int, folder: Path) -> Path:
    """A scene in which this part of the furniture, chosen by the seed, stands `MOVED` beside its place."""
    tree = ET.parse(share_file(f"urdf/scenes/{scene}.xml"))
    way = _on_tour(((0.0, 0.0), *corners))
    numbers = random.Random(seed)
    furniture = [geom for geom in tree.getroot().iter("geom") if geom.get("class") == "furniture" and _shape(geom)]
    numbers.shuffle(furniture)
    left = round(part * len(furniture))
    for geom in furniture:
        x, y, z = _numbers(geom.get("pos", ""))
        for turn in range(8):
            angle = turn * math.pi / 4
            geom.set("pos", f"{x + MOVED * math.cos(angle):.3f} {y + MOVED * math.sin(angle):.3f} {z}")
            shape = _shape(geom)
            if left and shape is not None and np.min(shape.distance(way)) > CLEAR:
                left -= 1
                break
        else:
            geom.set("pos", f"{x} {y} {z}")
    path = folder / f"{scene}_moved_{seed}.xml"
    tree.write(path)
    return path
