"""The poses of a log at the times of its pictures."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from robot_control.data.run_log import Log, LogError, kind_in, read_run

FLAT = 0.01
"""rad; a robot that never tilts more stands on a plane, and its estimated height and tilt are drift"""
POSES = ("truth", "estimate")
"""Begins of the columns of a pose; the first one that is in the log is drawn"""


@dataclass(frozen=True)
class Moment:
    """Relative to where the run began; m and rad."""

    time: float  # s
    x: float
    y: float
    z: float
    roll: float
    pitch: float
    yaw: float
    joints: dict[str, float]  # positions, rad


def read_moments(path: Path, period: float) -> list[Moment]:
    """The moments of the last run in the file, at least `period` s apart.

    Raises:
        LogError: it is no log, or holds no pose.
        OSError: it cannot be read.
    """
    run = read_run(path)
    return moments_of(run.columns, period, legged=kind_in(run.header).legged)


def moments_of(log: Log, period: float, *, legged: bool = False) -> list[Moment]:
    """As `read_moments`, of a log in memory; `legged`: of a robot on legs, whose height changes on a plane, too.

    Raises:
        LogError: it holds no pose.
    """
    pose = next((pose for pose in POSES if np.isfinite(log.get(f"{pose}_x", np.nan)).any()), None)
    if pose is None:
        raise LogError("no pose, neither true nor estimated, is in the log")
    columns = {
        name: log[name] for name in log if name == "time" or name.startswith(POSES) or name.endswith("_position")
    }
    rows: list[dict[str, float]] = []
    due = -math.inf
    for row in np.flatnonzero(np.isfinite(log[f"{pose}_x"])):
        time = float(log["time"][row])
        if time >= due:
            rows.append({name: float(values[row]) for name, values in columns.items()})
            due = (time if due == -math.inf else due) + period
    flat = not legged and not any(row.get("truth_tilt", 0.0) > FLAT for row in rows)
    height = f"{pose}_z" if legged else "estimate_z"
    return [_moment(row, rows[0], pose, height, flat=flat) for row in rows]


def _moment(row: dict[str, float], first: dict[str, float], pose: str, height: str, *, flat: bool) -> Moment:
    def since(name: str) -> float:
        change = row.get(name, math.nan) - first.get(name, math.nan)
        return change if math.isfinite(change) and not flat else 0.0

    joints = {
        name.removesuffix("_position"): value
        for name, value in row.items()
        if name.endswith("_position") and math.isfinite(value)
    }
    roll = since("estimate_roll")
    pitch = since("estimate_pitch")
    yaw = row[f"{pose}_yaw"]
    return Moment(row["time"], row[f"{pose}_x"], row[f"{pose}_y"], since(height), roll, pitch, yaw, joints)
