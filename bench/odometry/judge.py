"""Judges one run of the odometry benchmark by method: errors, consistency, detected slip.

position error   |estimated − true position| at the end of the run. In UMBmark each of the ten
                 return errors lies in the frame of its own start. The error is the larger distance from zero of their
                 two centres of gravity, clockwise and counter-clockwise (Borenstein & Feng 1996, section III:
                 E_max,syst). The odometry is reset before each
yaw error        |estimated − true| at the end, within half a turn. UMBmark: the largest of the ten
NEES             of consistency.py, every SAMPLE s, where the robot moves: one at rest errs by micrometres and
                 has no dynamics that a covariance could describe
standstill       from SETTLED s after the robot came to rest: in the first two s of rest the yaw still learns from the
                 gyro's bias (estimator.h, kSettling), which corrects what was driven
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bench.odometry.consistency import Notice, nees, notice, pose_error, twist_error
from bench.odometry.drives import FIRST_STAND
from bench.odometry.methods import METHODS, raw_wheels
from bench.odometry.picture import Picture, picture_of
from bench.odometry.recording import Recording, record
from bench.odometry.scenarios import draw_trial
from bench.odometry.tested_estimator import OURS, estimate, resets_of, true_track
from bench.odometry.truth import Array, Track, Truth, after_resets, moving, truth_of, wrapped

SAMPLE = 10.0  # s, between two samples of the NEES: errors of the pose are correlated over many seconds
SETTLED = 3.0  # s


@dataclass(frozen=True)
class Run:
    """`position` m and `yaw` rad by method. `pose_nees`, `twist_nees` at `times`, NaN at rest. `returns` (10, 2) m by
    method, for UMBmark. `killed`: position error of the second half alone, driven without gyro, by method. `drift`: m
    and rad at rest.
    """

    scenario: str
    seed: int
    stopped: bool
    distance: float
    position: dict[str, float]
    yaw: dict[str, float]
    times: Array
    pose_nees: Array
    twist_nees: Array
    notice: Notice
    pitch: float  # rad, RMS while it drives
    jump: float  # m, largest step of our pose between truth rows beyond the robot's motion: REP 105 wants none
    invalid: float  # share of the run in which our state is not valid
    returns: dict[str, Array] = field(default_factory=dict)
    killed: dict[str, float] = field(default_factory=dict)
    drift: tuple[float, float] | None = None
    picture: Picture | None = None


def run(scenario: str, seed: int, level: str = "data_sheet", *, picture: bool = False) -> Run:
    """Drives, estimates and compares. `level`: one of sensor_errors.LEVELS."""
    return judge(record(draw_trial(scenario, seed, level)), picture=picture)


def judge(recording: Recording, *, picture: bool = False) -> Run:
    """Estimates and compares."""
    truth, ours, resets = truth_of(recording), estimate(recording), resets_of(recording)
    truth = dataclasses.replace(truth, odom=after_resets(truth.odom, resets))
    paths = {name: method(recording) for name, method in METHODS.items()} | {OURS: ours.path}
    ends = {name: _errors(path, true_track(truth, name)) for name, path in paths.items()}
    returns: dict[str, Array] = {}
    if recording.scenario == "umbmark":
        returned = {name: return_errors(recording, path, true_track(truth, name)) for name, path in paths.items()}
        returns = {name: errors[:, :2] for name, errors in returned.items()}
        ends = {name: (largest_mean(errors[:, :2]), np.abs(errors[:, 2]).max()) for name, errors in returned.items()}
    rows = _sampled_rows(recording)
    at_rest = ~moving(truth)[rows]
    return Run(
        scenario=recording.scenario,
        seed=recording.seed,
        stopped=recording.stopped,
        distance=float(truth.distance[-1]),
        position={name: float(end[0]) for name, end in ends.items()},
        yaw={name: float(end[1]) for name, end in ends.items()},
        times=recording.time[recording.index[rows]],
        pose_nees=np.where(at_rest, np.nan, nees(pose_error(ours, truth)[rows], ours.pose_covariance[rows])),
        twist_nees=np.where(at_rest, np.nan, nees(twist_error(ours, truth)[rows], ours.twist_covariance[rows])),
        notice=notice(ours, truth),
        pitch=_pitch(truth),
        jump=_jump(ours.path, truth.odom, resets),
        invalid=float(np.mean(~ours.valid)),
        returns=returns,
        killed=_without_gyro(recording, truth) if recording.scenario == "random" else {},
        drift=_drift(recording, ours.path, truth) if recording.scenario == "standstill" else None,
        picture=picture_of(recording, truth, ours, paths) if picture else None,
    )


def relative(path: Track, begin: int, end: int) -> Array:
    """(x, y, yaw) of row `end` in the frame of row `begin`."""
    dx, dy, yaw = path.x[end] - path.x[begin], path.y[end] - path.y[begin], path.yaw[begin]
    cos, sin = np.cos(yaw), np.sin(yaw)
    return np.array([cos * dx + sin * dy, cos * dy - sin * dx, path.yaw[end] - yaw])


def return_errors(recording: Recording, path: Track, true: Track) -> Array:
    """(10, 3) m, m, rad: return errors of the clockwise squares, then of the others."""
    starts = sorted(recording.marks["cw"]) + sorted(recording.marks["ccw"])
    ends = sorted(recording.marks["end"])
    errors = np.zeros((len(starts), 3))
    for row, cycles in enumerate(zip(starts, ends, strict=True)):
        begin, end = np.searchsorted(recording.index, cycles)
        errors[row] = relative(path, begin, end) - relative(true, begin, end)
    errors[:, 2] = wrapped(errors[:, 2])
    return errors


def largest_mean(returns: Array) -> float:
    """m, of (10, 2); the first half is clockwise."""
    half = len(returns) // 2
    return float(max(np.linalg.norm(returns[:half].mean(axis=0)), np.linalg.norm(returns[half:].mean(axis=0))))


def _errors(path: Track, true: Track) -> tuple[float, float]:
    yaw = wrapped(path.yaw[-1:] - true.yaw[-1:])[0]
    return float(np.hypot(path.x[-1] - true.x[-1], path.y[-1] - true.y[-1])), float(abs(yaw))


def _sampled_rows(recording: Recording) -> NDArray[np.int64]:
    times = np.arange(SAMPLE, recording.time[-1], SAMPLE)
    times = times[times > FIRST_STAND]
    return np.searchsorted(recording.time[recording.index], times)


def _pitch(truth: Truth) -> float:
    moving = np.abs(truth.linear) > 0.05
    return float(np.std(truth.pitch[moving])) if moving.any() else 0.0


def _jump(path: Track, true: Track, resets: Sequence[int]) -> float:
    estimated, really = (np.hypot(np.diff(track.x), np.diff(track.y)) for track in (path, true))
    return float(np.max(np.delete(estimated - really, np.subtract(resets, 1).astype(np.int64))))


def _without_gyro(recording: Recording, truth: Truth) -> dict[str, float]:
    half = len(recording.index) // 2
    killed = estimate(recording, gyro_until=float(recording.time[recording.index[half]]))
    paths = {OURS: (killed.path, truth.odom), "raw wheels": (raw_wheels(recording), truth.ground)}
    return {
        name: float(np.linalg.norm((relative(path, half, -1) - relative(true, half, -1))[:2]))
        for name, (path, true) in paths.items()
    }


def _drift(recording: Recording, path: Track, truth: Truth) -> tuple[float, float]:
    times, true = recording.time[recording.index], truth.odom
    begin = int(np.searchsorted(times, times[np.flatnonzero(moving(truth))[-1]] + SETTLED))
    moved_x, moved_y = path.x - true.x, path.y - true.y
    turned = path.yaw - true.yaw
    drift = np.hypot(moved_x[begin:] - moved_x[begin], moved_y[begin:] - moved_y[begin])
    return float(drift.max()), float(np.abs(turned[begin:] - turned[begin]).max())
