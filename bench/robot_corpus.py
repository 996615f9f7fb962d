"""Robots for trials: the project's own, and descriptions of real ones if a folder of them exists.

The folder has a subfolder per robot with `robot.urdf` and the ROS packages of its meshes, and TRUTH.json, an object by
robot. It is named by ROBOT_CORPUS; otherwise `shared/robots` beside the repository is used.
"""

from __future__ import annotations

import json
import math
import os
from functools import cache
from pathlib import Path

from robot_control.installed_files import share_file
from robot_control.setup.description import describe, stand

DIFFBOT, QUADBOT = OWN = ("diffbot", "quadbot")
REFUSED = ("my_bot", "p3dx_amr")  # an empty template; wheels on fixed joints
STOP_DECELERATION = 0.5  # m/s², the parameter's default
SCENES = ("flat", "slope_5deg", "bumps", "low_friction_patch", "walls")
ICE = 0.1  # friction of the patch
FOLDED = 1.0  # m/s², of a robot on legs that folds them
BRAKED_SLOPE = math.sin(math.radians(5))
GRAVITY = 9.81  # m/s²


def corpus_folder() -> Path | None:
    """The folder of real robots; None if there is none."""
    named = os.environ.get("ROBOT_CORPUS")
    if named:
        return Path(named)
    for parent in Path(__file__).resolve().parents:
        if (parent / "shared" / "robots" / "TRUTH.json").is_file():
            return parent / "shared" / "robots"
    return None


def robot_names() -> list[str]:
    """The robots that drive: the project's own first, then the real ones by name."""
    folder = corpus_folder()
    if folder is None:
        return [DIFFBOT]
    return [DIFFBOT, *sorted(set(json.loads((folder / "TRUTH.json").read_text())) - set(REFUSED))]


def urdf_of(name: str) -> str:
    """Path of the description.

    Raises:
        FileNotFoundError: no such robot here.
    """
    if name in OWN:
        return share_file(f"urdf/{name}.urdf")
    folder = corpus_folder()
    if folder is None or not (folder / name / "robot.urdf").is_file():
        raise FileNotFoundError(
            f"robot {name}: no robot.urdf in {folder}; ROBOT_CORPUS names the folder of real robots"
        )
    return str(folder / name / "robot.urdf")


@cache
def stop_deceleration_of(name: str, friction: float = ICE) -> float:
    """Lower bound of the deceleration of a braking robot's faster side, m/s²; at most the parameter's default.

    Wheels on half the base b from the middle carry the part c of the mass m, which has the yaw inertia I. Brakes hold a
    robot on a slope of 5°, and may do no more (wheel_stop.h). Sliding straight slows down with a = g·min(μ·c, sin5°),
    a spin with a·m·(b/2)²/I; on ice a long robot on a short base takes seconds. The result is a fifth less, because
    casters take weight off the wheels while the robot slows down.
    """
    if name == QUADBOT:
        return FOLDED
    robot = describe(urdf_of(name))
    lever = float(robot["mass"] * (robot["wheel_base"] / 2) ** 2 / robot["yaw_inertia"])
    grip = GRAVITY * min(friction * float(stand(urdf_of(name))["carried"]), BRAKED_SLOPE)
    return min(STOP_DECELERATION, 0.8 * grip, 0.8 * grip * lever)


def scene_of(name: str) -> str:
    """Path of one of `SCENES`."""
    return share_file(f"urdf/scenes/{name}.xml")
