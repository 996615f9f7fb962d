"""With a wrong radius or coarse wheel speeds the ellipse holds the truth, and no slip is reported."""

from dataclasses import replace

import numpy as np
import pytest
from robot_control import Estimator

from bench.odometry.field_drive import Errors, field_drive, honesty
from bench.odometry.recordings import Recording, merged

JITTER = 0.003  # s, of the stamps
ERRORS = Errors(accelerometer=0.01, slow=0.02, counts=1e6, slip=1e-3)


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


def outcome(step: float, rate: float, radius: float, seed: int) -> tuple[float, float]:
    """`radius`: the given one over the true one; the shares of `honesty`."""
    drive = in_steps(field_drive(ERRORS, seed), step, rate, seed)
    drive = replace(drive, radius=radius * drive.radius)
    return honesty(drive, Estimator(**drive.geometry()).process(*drive.samples()))


SEEDS = range(3)


@pytest.mark.parametrize("radius", [0.97, 1.01, 1.02])
@pytest.mark.parametrize(("step", "rate"), [(0.08, 6.5), (0.08, 20.0), (0.05, 50.0)])
def test_coarse_speeds_are_no_slip_and_a_wrong_radius_is_within_the_ellipse(step, rate, radius):
    within, slip = np.mean([outcome(step, rate, radius, seed) for seed in SEEDS], axis=0)
    assert slip <= 0.005
    assert within >= 0.8
