"""Drives with a wrong radius and wheels that report speeds in steps, as some motor drives do."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from robot_control import Estimator
from robot_control.loop.estimator import FLAGS

from bench.odometry.field_drive import Errors, field_drive
from bench.odometry.recordings import Recording, merged

JITTER = 0.003  # s, of the stamps
ERRORS = Errors(accelerometer=0.01, slow=0.02, counts=1e6, slip=1e-3)


@dataclass(frozen=True)
class Outcome:
    """Shares of the time: with the truth in the 95 % ellipse of the position, and with reported slip."""

    within: float
    slip: float


def in_steps(drive: Recording, step: float, rate: float, seed: int) -> Recording:
    """The drive with wheel speeds in steps of `step` m/s (0: none) at `rate` Hz, added up over their stamps."""
    random = np.random.default_rng(seed)
    read, seen = ~np.isnan(drive.left), ~np.isnan(drive.gyro[:, 2])
    time = drive.time[read]
    stamps = np.arange(time[0], time[-1], 1 / rate)
    stamps = np.sort(stamps + JITTER * random.normal(size=stamps.size))
    gaps = np.diff(stamps)
    angles = []
    for side in (drive.left, drive.right):
        angle = np.interp(stamps, time, side[read])
        speed = np.diff(angle) / gaps * drive.radius
        reported = np.round(speed / step) * step if step else speed
        angles.append(angle[0] + np.concatenate([[0.0], np.cumsum(reported * gaps)]) / drive.radius)
    rows = merged((stamps, *angles), (drive.time[seen], drive.gyro[seen], drive.accel[seen]))
    time, left, right, gyro, accel = rows
    return replace(drive, counts=None, time=time, left=left, right=right, gyro=gyro, accel=accel)


def outcome(step: float, rate: float, radius: float, seed: int) -> Outcome:
    """`radius`: the given one over the true one."""
    drive = in_steps(field_drive(ERRORS, seed), step, rate, seed)
    drive = replace(drive, radius=radius * drive.radius)
    out = Estimator(**drive.geometry()).process(*drive.samples())
    truth = drive.truth[(drive.truth[:, 0] > drive.rest + 1) & (drive.truth[:, 0] < drive.time[-1])]
    seen = np.column_stack([np.interp(truth[:, 0], drive.time, out[axis]) for axis in ("x", "y")])
    rows = np.searchsorted(drive.time, truth[:, 0]).clip(0, drive.time.size - 1)
    covariance = out["pose_covariance"][rows, :2, :2] + 1e-6 * np.eye(2)
    off = seen - truth[:, 1:]
    nees = np.einsum("ni,nij,nj->n", off, np.linalg.inv(covariance), off)
    slips = out["flags"] & FLAGS["slip"] != 0
    steps = np.diff(drive.time, prepend=0)
    return Outcome(float(np.mean(nees < 5.99)), float(steps[slips].sum() / drive.time[-1]))
