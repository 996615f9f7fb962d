"""The poses of a run.csv at the times of its pictures. Pure but for reading the file."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

from robot_control.common.files import MAX_TABLE, check_input
from robot_control.common.run_log import LogError

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
    check_input(path, MAX_TABLE)
    rows: list[dict[str, float]] = []
    run, due = "", -math.inf
    try:
        with path.open(newline="", errors="replace") as file:
            table = csv.DictReader(file)
            names = [name for name in table.fieldnames or [] if _wanted(name)]
            if not {"run", "time"} <= set(table.fieldnames or []):
                raise LogError(f"{path}: no columns `run` and `time`: is it a run.csv?")
            for row in table:
                if row["run"] != run:
                    run, rows, due = row["run"], [], -math.inf
                time = _number(row["time"])
                if time >= due:
                    rows.append({name: _number(row[name]) for name in names})
                    due = (time if due == -math.inf else due) + period
    except csv.Error as error:
        raise LogError(f"{path}: is no CSV: {error}") from None
    pose = next((pose for pose in POSES if any(math.isfinite(row.get(f"{pose}_x", math.nan)) for row in rows)), None)
    if pose is None:
        raise LogError(f"{path}: no pose, neither true nor estimated")
    known = [row for row in rows if math.isfinite(row[f"{pose}_x"])]
    return [_moment(row, known[0], pose, flat=_flat(known)) for row in known]


def _wanted(name: str) -> bool:
    return name == "time" or name.startswith(POSES) or name.endswith("_position")


def _number(text: str | None) -> float:
    try:
        return float(text or "nan")
    except ValueError:
        return math.nan  # of a line that was cut short


def _flat(rows: list[dict[str, float]]) -> bool:
    return not any(row.get("truth_tilt", 0.0) > FLAT for row in rows)


def _moment(row: dict[str, float], first: dict[str, float], pose: str, *, flat: bool) -> Moment:
    def since(name: str) -> float:
        change = row.get(name, math.nan) - first.get(name, math.nan)
        return change if math.isfinite(change) and not flat else 0.0

    joints = {
        name.removesuffix("_position"): value
        for name, value in row.items()
        if name.endswith("_position") and math.isfinite(value)
    }
    return Moment(
        row["time"],
        row[f"{pose}_x"],
        row[f"{pose}_y"],
        since("estimate_z"),
        since("estimate_roll"),
        since("estimate_pitch"),
        row[f"{pose}_yaw"],
        joints,
    )
