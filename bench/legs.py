"""Judges the rows of `bench_legs`, kinematics and equations of motion of robots on four legs, and of `bench_legs_loop`,
the same robots in the closed loop.

The robots are the project's own quadruped and descriptions of real ones if a folder of them exists. It has a subfolder
per robot with `robot.urdf`, and FACTS.json. ROBOT_QUADRUPEDS names it; otherwise `shared/quadrupeds` above the
repository is used.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from robot_control.installed_files import share_file

BOUNDS = {
    "round trip of reachable feet": 1e-9,  # m
    "reachable feet not reached": 0,
    "allocations": 0,
    "position and Jacobian of a leg": 0.2,  # µs
    "inverse of a leg": 0.4,  # µs
    "mass matrix and bias": 5.0,  # µs
    "effort of the limit": 0.9,
    "height after 2 s": 0.008,  # m
    "tilt after 2 s": 0.03,  # rad
    "creep": 0.001,  # m/min
    "not lying": 0,
    "stops": 0,
    "RMS of the place": 0.005,  # m
    "RMS of the angle": 0.015,  # rad
    "slip of a foot": 0.002,  # m
    "RMS of foot": 0.005,  # m
    "tilt with foot": 0.04,  # rad
    "rest": 1.5,  # s
    "acceleration": 40,  # m/s²
    "tilt": 0.15,  # rad
    "cycles to the brake": 2,  # the stop's own and the next
    "way of a joint in 10 min": 0.01,  # rad
    "way of the body": 0.01,  # m
}
OWN_ROBOT = ("pose", "circle")
"""parts that are promised of the project's own quadruped alone"""
"""largest value of each row, by the beginning of its name behind the robot's"""


def quadruped_folder() -> Path | None:
    """The folder of real quadrupeds; None if there is none."""
    named = os.environ.get("ROBOT_QUADRUPEDS")
    if named:
        return Path(named)
    for parent in Path(__file__).resolve().parents:
        if (parent / "shared" / "quadrupeds" / "FACTS.json").is_file():
            return parent / "shared" / "quadrupeds"
    return None


def urdfs() -> list[str]:
    """Paths of the descriptions: the project's own first."""
    folder = quadruped_folder()
    own = share_file("urdf/quadbot.urdf")
    if folder is None:
        return [own]
    names = sorted(json.loads((folder / "FACTS.json").read_text()))
    return [own, *(str(folder / name / "robot.urdf") for name in names)]


def _bound(name: str) -> float:
    """That of a row, without the robot, the foot or the situation that its name has behind a bound's."""
    quantity = name.split(": ", 1)[1]
    return next(BOUNDS[known] for known in sorted(BOUNDS, key=len, reverse=True) if quantity.startswith(known))


def missed(rows: list[dict[str, Any]]) -> list[str]:
    """The rows beyond their bounds, in words."""
    return [
        f"{row['name']}: {row['value']:.3g} {row['unit']}, at most {_bound(row['name']):g}"
        for row in rows
        if row["value"] > _bound(row["name"])
    ]
