"""Robots to try: the project's own, and descriptions of real ones where a folder of them is there.

A folder per robot with `robot.urdf` and the ROS packages of its meshes, and TRUTH.json, an object by robot. Looked for
in the folder named by ROBOT_CORPUS, else beside the repository in `shared/robots`.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

from robot_control.installed_files import share_file

DIFFBOT = "diffbot"
REFUSED = ("my_bot", "p3dx_amr")  # an empty template; wheels on fixed joints
STOP_DECELERATION = 0.5  # m/s², the parameter's default; on the ice of the scenes robots slide to a stop with 0.77
WEAK_STOP_DECELERATIONS = {"create_2": 0.05}  # its nose slides and its wheels carry little: on ice it spins for seconds
SCENES = ("flat", "slope_5deg", "bumps", "low_friction_patch", "walls")


def corpus_folder() -> Path | None:
    """The folder of real robots; None where there is none."""
    named = os.environ.get("ROBOT_CORPUS")
    if named:
        return Path(named)
    for parent in Path(__file__).resolve().parents:
        if (parent / "shared" / "robots" / "TRUTH.json").is_file():
            return parent / "shared" / "robots"
    return None


def robot_names() -> list[str]:
    """Those that drive: the project's own first, then the real ones by name."""
    folder = corpus_folder()
    if folder is None:
        return [DIFFBOT]
    return [DIFFBOT, *sorted(set(json.loads((folder / "TRUTH.json").read_text())) - set(REFUSED))]


def urdf_of(name: str) -> str:
    """Path of the description.

    Raises:
        FileNotFoundError: no such robot here.
    """
    if name == DIFFBOT:
        return share_file("urdf/diffbot.urdf")
    folder = corpus_folder()
    if folder is None or not (folder / name / "robot.urdf").is_file():
        raise FileNotFoundError(
            f"robot {name}: no robot.urdf in {folder}; ROBOT_CORPUS names the folder of real robots"
        )
    return str(folder / name / "robot.urdf")


def stop_deceleration_of(name: str) -> float:
    """m/s², that its brakes reach in every one of `SCENES`."""
    return WEAK_STOP_DECELERATIONS.get(name, STOP_DECELERATION)


def scene_of(name: str) -> str:
    """Path of one of `SCENES`."""
    return share_file(f"urdf/scenes/{name}.xml")
