"""The shapes of a robot as triangles, and the floor it stands on."""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROUND = 72  # corners of a circle
RINGS = 24  # of a sphere, pole to pole


def ground_height(robot: dict[str, Any]) -> float:
    """z of the floor that the drive wheels touch, or on which a robot with legs lies or stands, m."""
    if "floor" in robot:
        return float(robot["floor"])
    if robot["kind"] == "legs":
        return float(robot["belly"])
    return min(float(wheel["centre"][2]) - float(wheel["radius"]) for wheel in robot["wheels"])


def poses(robot: dict[str, Any]) -> list[dict[str, Any]]:
    """The robot in each `pose`: as it is; of one on legs, "lying" and "standing"."""
    if robot["kind"] != "legs":
        return [robot | {"pose": ""}]
    lying = robot | {"pose": "lying"}
    if "upright" not in robot:
        return [lying]
    upright = robot["upright"]
    shapes = [shape | {"in_base": place} for shape, place in zip(robot["shapes"], upright["in_base"], strict=True)]
    return [lying, robot | upright | {"pose": "standing", "shapes": shapes}]


def triangles_in_base(shape: dict[str, Any]) -> Array:
    """Array of shape (n, 3, 3): n triangles of three corners, m, base axes; none for a flat mesh."""
    local: Array = {"sphere": _sphere, "cylinder": _cylinder, "box": _box, "mesh": _mesh}[shape["type"]](shape)
    pose = np.asarray(shape["in_base"], dtype=float)
    return np.asarray(local @ pose[:3, :3].T + pose[:3, 3])


def _mesh(shape: dict[str, Any]) -> Array:
    if not shape["triangles"]:
        return np.empty((0, 3, 3))
    return np.asarray(np.asarray(shape["points"], dtype=float)[np.asarray(shape["triangles"], dtype=int)])


def _box(shape: dict[str, Any]) -> Array:
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * shape["size"]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    return np.asarray(corners[np.array(faces)])


def _cylinder(shape: dict[str, Any]) -> Array:
    angle = np.linspace(0, 2 * np.pi, ROUND, endpoint=False)
    rim = np.column_stack((np.cos(angle), np.sin(angle))) * shape["radius"]
    bottom = np.column_stack((rim, np.full(ROUND, -shape["length"] / 2)))
    top = np.column_stack((rim, np.full(ROUND, shape["length"] / 2)))
    return np.concatenate((_band(bottom, top), _fan(top), _fan(bottom)))


def _sphere(shape: dict[str, Any]) -> Array:
    angle = np.linspace(0, 2 * np.pi, ROUND, endpoint=False)
    rings = [
        shape["radius"]
        * np.column_stack((np.cos(angle) * np.sin(polar), np.sin(angle) * np.sin(polar), np.full(ROUND, np.cos(polar))))
        for polar in np.linspace(0, np.pi, RINGS)
    ]
    return np.concatenate([_band(upper, lower) for upper, lower in pairwise(rings)])


def _band(one: Array, other: Array) -> Array:
    one_next, other_next = np.roll(one, -1, axis=0), np.roll(other, -1, axis=0)
    return np.concatenate((np.stack((one, one_next, other), axis=1), np.stack((one_next, other_next, other), axis=1)))


def _fan(ring: Array) -> Array:
    centre = np.broadcast_to(ring.mean(axis=0), ring.shape)
    return np.stack((centre, ring, np.roll(ring, -1, axis=0)), axis=1)
