"""Distances from the true walls of a scene, and a scene of which a part was moved."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from robot_control.installed_files import share_file

from bench.navigation.scene_map import Obstacle

CLEAR = 0.6  # m that a moved shape keeps from the tour
MOVED = 0.8  # m


def _distance(obstacle: Obstacle, points: NDArray[np.float64]) -> NDArray[np.float64]:
    away = np.abs(points - (obstacle.x, obstacle.y))
    if not obstacle.half_y:
        return np.asarray(np.abs(np.hypot(*away.T) - obstacle.half_x))
    beyond = away - (obstacle.half_x, obstacle.half_y)
    outside = np.hypot(*np.maximum(beyond, 0).T)
    return np.where(np.all(beyond < 0, axis=1), -np.max(beyond, axis=1), outside)


def distances(obstacles: Sequence[Obstacle], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the nearest surface of those that stand, m, inside and outside; `points` has the shape (n, 2)."""
    return np.asarray(np.min([_distance(obstacle, points) for obstacle in obstacles if not obstacle.path], axis=0))


def _placed(geom: ET.Element, x: float, y: float) -> Obstacle:
    size = [float(word) for word in str(geom.get("size")).split()]
    return Obstacle(x, y, size[0], size[1] if len(size) == 3 else 0.0)


def partly_moved(scene: str, corners: Sequence[tuple[float, float]], part: float, seed: int, folder: Path) -> Path:
    """A scene in which this part of the furniture, by the seed, stands `MOVED` beside its place and off the tour."""
    tree = ET.parse(share_file(f"urdf/scenes/{scene}.xml"))
    tour = np.concatenate([np.linspace(a, b, math.ceil(math.dist(a, b) / 0.1) + 1) for a, b in pairwise(corners)])
    furniture = [geom for geom in tree.getroot().iter("geom") if geom.get("class") == "furniture"]
    left = round(part * len(furniture))
    for index in np.random.default_rng(seed).permutation(len(furniture)):
        geom = furniture[index]
        x, y, z = (float(word) for word in str(geom.get("pos")).split())
        places = [(x + MOVED * math.cos(angle), y + MOVED * math.sin(angle)) for angle in np.arange(8) * math.pi / 4]
        free = [place for place in places if np.min(_distance(_placed(geom, *place), tour)) > CLEAR]
        if free and left:
            geom.set("pos", f"{free[0][0]:.3f} {free[0][1]:.3f} {z}")
            left -= 1
    path = folder / f"{scene}_moved_{seed}.xml"
    tree.write(path)
    return path
