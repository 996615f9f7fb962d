"""Judges the rows of `bench_legs`: kinematics and equations of motion of robots on four legs.

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
}
"""largest value of each row, by the part of its name behind the robot's"""


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


def met(rows: list[dict[str, Any]]) -> bool:
    """Whether every row is within its bound."""
    return all(row["value"] <= BOUNDS[row["name"].split(": ", 1)[1]] for row in rows)
