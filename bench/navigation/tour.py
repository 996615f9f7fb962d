"""Drives along corners in a scene, and what laser and odometry report on the way."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from robot_control import ClosedLoop
from robot_control.installed_files import share_file
from robot_control.robot.pose import turned

SCAN_PERIOD = 0.1  # s
SPEED, TURN = 0.5, 1.0  # m/s, rad/s
LASER = (0.05, 0.0, 0.0)  # m, m, rad: the laser of diffbot in base_link
NEAR, FACING = 0.1, 0.1  # m, rad

Place = tuple[float, float, float]
"""x [m], y [m], yaw [rad]"""
Scan = dict[str, Any]
Corners = tuple[tuple[float, float], ...]
"""m, from the start of the scene"""

TOURS: dict[str, Corners] = {
    # Every room by its doors, and back to the start.
    "room": (
        *((1.0, 0.0), (1.0, 2.0), (-1.2, 2.2), (1.0, 2.4), (1.0, 4.0), (4.2, 4.0), (6.2, 3.9), (8.0, 3.4), (6.8, 2.0)),
        *((6.8, 0.0), (8.4, 0.0), (8.4, -1.8), (7.4, -3.2), (5.7, -3.5), (7.6, -3.0), (8.4, -1.8), (8.4, 0.0)),
        *((2.6, 0.0), (2.6, -1.8), (-1.0, -2.2), (1.4, -3.4), (3.2, -3.4), (3.2, -2.0), (2.6, -1.6), (2.6, 0.0)),
        (0.0, 0.0),
    ),
    "loop": ((9.0, 0.0), (9.0, 12.0), (-9.0, 12.0), (-9.0, 0.0), (3.0, 0.0)),
}


@dataclass
class Sight:
    """A scan with the poses at its time: x [m], y [m], yaw [rad]."""

    time: float
    truth: NDArray[np.float64]
    odometry: NDArray[np.float64]
    covariance: NDArray[np.float64]  # (3, 3), of the odometry
    scan: dict[str, Any]


@dataclass(frozen=True)
class Machine:
    """A robot with a laser."""

    urdf: str
    laser: Place = LASER  # in base_link
    view: dict[str, float] = field(default_factory=dict)  # keys of mujoco_plant.laser
    legs: bool = False


DIFFBOT = Machine(share_file("urdf/diffbot.urdf"))
QUADBOT = Machine(share_file("urdf/quadbot.urdf"), (0.0, 0.0, 0.0), legs=True)


def new_loop(
    scene: str | Path, seed: int, plant: dict[str, Any] | None = None, machine: Machine = DIFFBOT
) -> ClosedLoop:
    """The robot with a laser of 10 Hz at the start of this scene, a shipped one or a file."""
    values = {**(plant or {}), "laser": {"rate": 1 / SCAN_PERIOD, **machine.view}}
    path = share_file(f"urdf/scenes/{scene}.xml") if isinstance(scene, str) else scene
    return ClosedLoop({"mujoco_plant": values}, seed=seed, urdf=machine.urdf, scene=path)


def covariance_of(state: dict[str, float]) -> NDArray[np.float64]:
    """The covariance (3, 3) of the odometry: x, y, yaw."""
    xy, xa, ya = (state[f"estimate_{name}_covariance"] for name in ("xy", "x_yaw", "y_yaw"))
    x, y, a = (state[f"estimate_{name}_variance"] for name in ("x", "y", "yaw"))
    return np.array([[x, xy, xa], [xy, y, ya], [xa, ya, a]])


def look(loop: ClosedLoop, command: tuple[float, float]) -> Sight:
    """Drives with this command until the next scan."""
    log = loop.run(SCAN_PERIOD, command)
    last = {name: float(values[-1]) for name, values in log.items()}
    return Sight(
        last["time"],
        np.array([last["truth_x"], last["truth_y"], last["truth_yaw"]]),
        np.array([last["estimate_x"], last["estimate_y"], last["estimate_yaw"]]),
        covariance_of(last),
        loop.scan(),
    )


def command_to(pose: NDArray[np.float64], corner: tuple[float, float]) -> tuple[float, float] | None:
    """Turns on the spot, then drives; None where the corner is reached."""
    away = math.hypot(corner[0] - pose[0], corner[1] - pose[1])
    if away < NEAR:
        return None
    off = turned(math.atan2(corner[1] - pose[1], corner[0] - pose[0]) - pose[2])
    turn = max(-TURN, min(TURN, 2 * off))
    return (0.0 if abs(off) > 3 * FACING else max(0.1, min(SPEED, away)), turn)


def drive(loop: ClosedLoop, corners: Iterable[tuple[float, float]], limit: float = math.inf) -> Iterator[Sight]:
    """Follows the corners by the true pose, for at most `limit` m."""
    for _ in range(10):
        sight = look(loop, (0.0, 0.0))
        yield sight
    way = 0.0
    for corner in corners:
        while (command := command_to(sight.truth, corner)) is not None and way < limit:
            before, sight = sight, look(loop, command)
            way += float(np.hypot(*(sight.truth - before.truth)[:2]))
            yield sight


def errors(sights: list[Sight], poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Poses (n, 3) less the true ones: m, m, rad within ±π."""
    off = poses - np.array([sight.truth for sight in sights])
    off[:, 2] = (off[:, 2] + math.pi) % (2 * math.pi) - math.pi
    return np.asarray(off)
