"""The places of a robot's black boxes, and those that telemetry has saved."""

import os
import re
from pathlib import Path

RING = "ring"
BEFORE = "ring.before"
LOGS = Path(os.environ.get("ROS_HOME") or "~/.ros", "robot_control")
"""The folder into which sim.launch and robot.launch let telemetry write."""
BAG_OF_RING = re.compile(r"\d+\.bag")
INCIDENT = re.compile(r"(stop|crash)\.\d+\.bag")


def ring_of(path: Path) -> Path:
    """The newest black box of a folder of logs, or `path` itself where it is one, or no folder.

    Raises:
        FileNotFoundError: there is none.
    """
    if not path.is_dir() or _is_ring(path):
        return path
    for name in (RING, BEFORE):
        if (_box_of(path) / name).is_dir():
            return _box_of(path) / name
    raise FileNotFoundError(f"there is no black box in {path}: no black_box/{RING}")


def incidents_of(path: Path) -> list[Path]:
    """The black boxes that telemetry has saved in a folder, the newest last; none if the folder cannot be read."""
    try:
        box = _box_of(path) if path.is_dir() and not _is_ring(path) else path.parent
        found = [each for each in box.iterdir() if INCIDENT.fullmatch(each.name)] if box.is_dir() else []
        return sorted(found, key=lambda each: (each.stat().st_mtime, each.name))
    except OSError:
        return []


def _box_of(folder: Path) -> Path:
    return folder / "black_box" if (folder / "black_box").is_dir() else folder


def _is_ring(folder: Path) -> bool:
    return any(BAG_OF_RING.fullmatch(each.name) for each in folder.iterdir())
