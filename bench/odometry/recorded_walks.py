"""The odometry of robots on legs on recordings of real ones with motion capture, beside the plain estimate.

The recorded contacts are used twice. "asked": the command asked for them, and the feet show them. "sensed": the feet
show them. The estimate is laid on the truth at the first row, where the robot lies. After it nothing is aligned.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bench.legs import quadruped_folder
from bench.odometry.recordings import recordings_folder
from bench.rows import Row, Say, bounded, compared, plain

FloatArray = NDArray[np.float64]
FILE = Path("legs") / "a1_first_24_s.npz"
ROBOT = Path("a1") / "robot.urdf"
STRIDE = 0.5  # s, of the means in the slope of the speed: the markers' place on a body that sways is not known
_ROWS = 49  # columns of what bench_legs_recording writes


@dataclass(frozen=True)
class Judged:
    """Attributes: m, m, m, one, one; see `judge`."""

    rms: float
    plain_rms: float
    height: float
    nees: float
    slope: float


def sensors_of(data: Mapping[str, FloatArray], use: str) -> FloatArray:
    """Rows for bench_legs_recording: feet in contact share the weight."""
    contact = data["contact"].astype(float)
    share = contact / np.maximum(contact.sum(axis=1, keepdims=True), 1)
    schedule = contact * (0.5 if use == "asked" else 0)
    names = ("gyro", "accel", "joint_angle", "joint_rate")
    return np.column_stack([*(data[name] for name in names), share, schedule]).astype(float)


def judge(time: FloatArray, estimate: FloatArray, truth: FloatArray, euler: FloatArray) -> Judged:
    """Judges an estimate, (n, 49) rows of bench_legs_recording, by true positions and roll, pitch, yaw, (n, 3) each.

    `rms` and `plain_rms` are those of the horizontal position, and `height` is the error at the end. `nees` is the mean
    of the pose's, by its dimension. `slope` is that of the horizontal speed over the true one, in means over STRIDE.
    """
    turns = Rotation.from_quat(estimate[:, 3:7]).as_matrix()
    true_turns = Rotation.from_euler("xyz", euler).as_matrix()
    yaw = euler[0, 2] - np.arctan2(turns[0, 1, 0], turns[0, 0, 0])
    cos, sin = np.cos(yaw), np.sin(yaw)
    aligned = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
    laid = [truth[0] + (places - places[0]) @ aligned.T for places in (estimate[:, :3], estimate[:, 46:49])]
    error, plain_error = (places - truth for places in laid)
    small = aligned @ turns @ np.swapaxes(true_turns, 1, 2)
    turned = np.column_stack([small[:, 2, 1] - small[:, 1, 2], small[:, 0, 2] - small[:, 2, 0]]) / 2
    turned = np.column_stack([turned, (small[:, 1, 0] - small[:, 0, 1]) / 2])
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = aligned
    covariance = both @ estimate[:, 10:46].reshape(-1, 6, 6) @ both.T
    off = np.column_stack([error, turned])
    known = np.linalg.eigvalsh(covariance)[:, 0] > 0
    nees = np.einsum("ni,ni->n", off[known], np.linalg.solve(covariance[known], off[known][:, :, None])[:, :, 0]) / 6
    rows = max(1, round(STRIDE / float(np.median(np.diff(time)))))
    speed, true_speed = (places[rows:, :2] - places[:-rows, :2] for places in (laid[0], truth))
    return Judged(
        rms=float(np.sqrt((error[:, :2] ** 2).sum(axis=1).mean())),
        plain_rms=float(np.sqrt((plain_error[:, :2] ** 2).sum(axis=1).mean())),
        height=float(error[-1, 2]),
        nees=float(nees.mean()),
        slope=float((speed * true_speed).sum() / (true_speed**2).sum()),
    )


def bench(say: Say, program: Callable[..., Any], file: Path | None = None) -> tuple[list[str], list[Row]]:
    """Rows of each use of the contacts in a recording like FILE of an A1; or the reason why it is skipped."""
    folder, robots = recordings_folder(), quadruped_folder()
    path = file or (folder / FILE if folder else FILE)
    urdf = robots / ROBOT if robots else ROBOT
    absent = [str(needed) for needed in (path, urdf) if not needed.is_file()]
    if absent:
        return [f"legs: skipped, there is no {' and no '.join(absent)}"], []
    with np.load(path) as archive:
        data = {name: archive[name].astype(float) for name in archive.files}
    time = data["time"]
    period = float(np.median(np.diff(time)))
    truth, angles = (
        np.column_stack([np.interp(time, data["truth_time"], column) for column in columns.T])
        for columns in (data["truth_position"], np.unwrap(data["truth_euler"], axis=0))
    )
    rows: list[Row] = []
    for use in ("asked", "sensed"):
        say(f"{path.stem}, {use}")
        with tempfile.TemporaryDirectory() as folder_name:
            sensors, estimate = Path(folder_name) / "sensors", Path(folder_name) / "estimate"
            sensors_of(data, use).tofile(sensors)
            program("bench_legs_recording", urdf, period, sensors, estimate)
            judged = judge(time, np.fromfile(estimate).reshape(-1, _ROWS), truth, angles)
        rows += _rows(f"{path.stem}, {use}", judged)
    return [], rows


def _rows(name: str, judged: Judged) -> list[Row]:
    return [
        bounded(f"{name}: RMS on the way", judged.rms, "m", 0.08),
        compared(f"{name}: RMS again", judged.rms, "m", 1.1 * judged.plain_rms, "1.1 of the plain estimate"),
        bounded(f"{name}: error of the height", abs(judged.height), "m", 0.03),
        bounded(f"{name}: NEES of the pose", judged.nees, "", 4),
        bounded(f"{name}: inverse of the NEES of the pose", 1 / judged.nees, "", 2),
        plain(f"{name}: slope of the speed", judged.slope, ""),
        bounded(f"{name}: slope of the speed from 1", abs(judged.slope - 1), "", 0.03),
    ]
