"""Logs of lasers: NumPy archives, and the text of CARMEN. None is shipped.

An archive NAME.npz holds `time` (n) [s] and `ranges` (n, rays) [m] over 180 degrees from the right, the laser at the
base. It holds `raw_odometry`, `reference`, or both: poses (n, 3) [m, m, rad]. It may hold `relations` (m, 8): time 1,
time 2 [s], x, y, z [m], roll, pitch, yaw [rad]. The text NAME.log or NAME.clf has lines FLASER: rays, ranges, the
pose of the laser, that of the odometry, and the time. Its relations are the lines of NAME.relations.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NOTHING = 80.0  # m, from which lasers mean that nothing was seen; others mean it by the largest range of a log
NEAREST = 0.02  # m
ENDINGS = (".npz", ".log", ".clf")


@dataclass
class LaserLog:
    """n scans."""

    name: str
    time: Array  # (n,)
    ranges: list[Array]
    odometry: Array | None  # (n, 3)
    reference: Array | None  # (n, 3), poses corrected by others
    relations: Array  # (m, 8)

    @cached_property
    def range_max(self) -> float:
        """m, from which nothing was seen."""
        return min(NOTHING, max(float(row.max()) for row in self.ranges if len(row)))

    def scan(self, index: int) -> dict[str, Any]:
        """As ClosedLoop.scan gives it."""
        ranges = self.ranges[index]
        steps = len(ranges) if len(ranges) in {180, 360} else len(ranges) - 1
        return {
            "angle_min": -math.pi / 2,
            "angle_increment": math.pi / steps,
            "range_min": NEAREST,
            "range_max": self.range_max,
            "ranges": np.where(ranges >= self.range_max, np.inf, ranges).astype(np.float32),
        }


def read_folder(folder: Path) -> list[LaserLog]:
    """The logs of this folder, by name.

    Raises:
        RuntimeError: there is none, or one of them cannot be read.
    """
    paths = sorted(path for path in folder.glob("*") if path.suffix in ENDINGS)
    if not paths:
        raise RuntimeError(f"{folder} holds no log (*{', *'.join(ENDINGS)})")
    logs = []
    for path in paths:
        try:
            logs.append(_archive(path) if path.suffix == ".npz" else _carmen(path))
        except (KeyError, ValueError, IndexError) as error:
            raise RuntimeError(f"{path} cannot be read as a log of a laser: {error}") from None
    return logs


def _archive(path: Path) -> LaserLog:
    held = np.load(path)
    poses = {key: held[key] if key in held.files else None for key in ("raw_odometry", "reference")}
    if poses["raw_odometry"] is None and poses["reference"] is None:
        raise ValueError("neither raw_odometry nor reference")
    relations = held["relations"] if "relations" in held.files else np.empty((0, 8))
    ranges = [row[np.isfinite(row)] for row in held["ranges"]]
    return LaserLog(path.stem, held["time"], ranges, poses["raw_odometry"], poses["reference"], relations)


def _carmen(path: Path) -> LaserLog:
    lines = [line.split() for line in path.read_text(errors="replace").splitlines() if line.startswith("FLASER ")]
    if not lines:
        raise ValueError("no line FLASER")
    ranges, odometry, times = [], [], []
    for words in lines:
        after = 2 + int(words[1])
        ranges.append(np.array(words[2:after], dtype=float))
        odometry.append([float(word) for word in words[after + 3 : after + 6]])
        times.append(float(words[after + 6]))
    beside = path.with_suffix(".relations")
    relations = np.loadtxt(beside, ndmin=2) if beside.exists() else np.empty((0, 8))
    return LaserLog(path.stem, np.array(times), ranges, np.array(odometry), None, relations)
