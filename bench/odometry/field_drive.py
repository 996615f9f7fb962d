"""Drives of a wheeled robot from a seed, with the sensor errors of real robots.

The drive is kinematic, without physics. It has a path and the travel of the wheels on it with slip. Encoders, gyro and
accelerometer of the given quality report it, each with its own stamps. The defaults follow recordings of real skid
steers.

    /usr/bin/python3 -m bench.odometry.field_drive tests/simulation/estimation/field_drive.npz  # for the tests
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from robot_control.loop.estimator import FLAGS, Estimate

from bench.odometry.recordings import Recording, merged

FloatArray = NDArray[np.float64]

RADIUS, BASE = 0.126, 0.78  # m, wheel and effective wheel base
TRACK = 0.394  # m, between left and right wheels of the robot that slides sideways
_STEP = 1e-3  # s, of the truth
_SPEED = 0.5  # m/s, at which the vibration is given
_SLOW_TIME = 3.0  # s, in which the accelerometer's slow error changes
_GRAVITY = 9.80665
_TAILS = 0.05  # share of the stamps that are three times as late
SEED = 16  # seed of the recording that is stored beside the tests


@dataclass(frozen=True)
class Errors:
    """The errors of the sensors.

    Attributes:
        jitter: s, standard deviation of the wheels' stamps.
        offset: s, by which the wheels' stamps are late.
        accelerometer: m/s²/√Hz at 0.5 m/s, in proportion to the speed; a hundredth of it at rest.
        slow: m/s², of the accelerometer while it drives: suspension, tilt, scale.
        gyro: rad/s/√Hz.
        bias: rad/s, of the gyro.
        slip: m/√m, of either side.
        counts: of a wheel's turn.
        imu_rate, wheel_rate: Hz.
        sideways: m, by which the robot's centre of gravity lies ahead of the wheels' middle: it slides sideways by
            this much per radian of a turn.
        rest: s at the beginning; 0: it begins in motion.
    """

    jitter: float = 0.002
    offset: float = 0.07
    accelerometer: float = 0.065
    slow: float = 0.1
    gyro: float = 4e-4
    bias: tuple[float, float, float] = (0.01, -0.02, 0.004)
    slip: float = 5e-3
    counts: float = 360
    imu_rate: float = 100.0
    wheel_rate: float = 40.0
    sideways: float = 0.0
    rest: float = 5.0


def field_drive(errors: Errors, seed: int, duration: float = 60.0, name: str = "field_drive") -> Recording:
    """A drive of `duration` s along curves and straights, with three stops."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, duration, _STEP)
    speed, rate = _motion(time, errors.rest, random)
    yaw = np.cumsum(rate) * _STEP
    aside = -errors.sideways * rate
    x = np.cumsum(speed * np.cos(yaw) - aside * np.sin(yaw)) * _STEP
    y = np.cumsum(speed * np.sin(yaw) + aside * np.cos(yaw)) * _STEP

    wheel_time = np.arange(0.0, duration - 0.3, 1 / errors.wheel_rate)
    late = errors.jitter * random.normal(size=wheel_time.size)
    late *= np.where(random.random(wheel_time.size) < _TAILS, 3.0, 1.0)
    angles = []
    for side in (-1, 1):
        rolled = (speed + side * BASE / 2 * rate) * _STEP
        slip = errors.slip * np.sqrt(np.abs(rolled)) * random.normal(size=time.size)
        travel = np.interp(wheel_time, time, np.cumsum(rolled + slip))
        turn = 2 * np.pi / errors.counts
        angles.append(np.floor(travel / RADIUS / turn) * turn)
    stamps = np.maximum.accumulate(wheel_time + errors.offset + late)

    imu_time = np.arange(0.0, duration - 0.3, 1 / errors.imu_rate)
    gyro, accel = _inertial(time, imu_time, (speed, rate, aside), errors, random)
    rows = merged((stamps, *angles), (imu_time, gyro, accel))
    truth = np.column_stack([time, x, y])[:: int(0.05 / _STEP)]
    track = TRACK if errors.sideways != 0 else None
    return Recording(
        name, *rows, rest=errors.rest, radius=RADIUS, base=BASE, counts=errors.counts, track=track, truth=truth
    )


def _motion(time: FloatArray, rest: float, random: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """m/s, rad/s: targets that change every two seconds, with bounded accelerations."""
    legs = int(time[-1] / 2) + 1
    speeds = random.uniform(0.3, 0.9, legs)
    rates = random.uniform(-1, 1, legs) * (random.random(legs) < 0.6)
    for stop in (legs // 2, legs - 2, legs - 1):
        speeds[stop] = rates[stop] = 0
    leg = np.minimum((time / 2).astype(int), legs - 1)
    moves = time >= rest
    begin = (0.0, 0.0) if rest > 0 else (speeds[0], rates[0])
    targets = (np.where(moves, speeds[leg], 0.0), np.where(moves, rates[leg], 0.0))
    limits = (0.7 * _STEP, 2.0 * _STEP)
    profiles = []
    for value, target, limit in zip(begin, targets, limits, strict=True):
        profile = np.empty_like(time)
        now = float(value)
        for i, wanted in enumerate(target):
            now += min(max(wanted - now, -limit), limit)
            profile[i] = now
        profiles.append(profile)
    return profiles[0], profiles[1]


def _inertial(
    time: FloatArray,
    stamps: FloatArray,
    motion: tuple[FloatArray, FloatArray, FloatArray],
    errors: Errors,
    random: np.random.Generator,
) -> tuple[FloatArray, FloatArray]:
    """`motion`: forward m/s, turning rad/s, sideways m/s → rad/s, m/s²: (n, 3), base axes, means over the period."""
    speed, rate, aside = motion
    period = 1 / errors.imu_rate

    def mean(values: FloatArray) -> FloatArray:
        area = np.concatenate([[0.0], np.cumsum(values) * _STEP])
        edges = np.append(time, time[-1] + _STEP)
        whole = np.interp(stamps, edges, area) - np.interp(stamps - period, edges, area)
        return np.asarray(whole / period)

    n = stamps.size
    gyro = errors.gyro / np.sqrt(period) * random.normal(size=(n, 3)) + np.asarray(errors.bias)
    gyro[:, 2] += mean(rate)
    along = np.gradient(speed, _STEP) - rate * aside
    across = np.gradient(aside, _STEP) + rate * speed
    share = np.maximum(0.01, mean(np.hypot(speed, BASE / 2 * rate)) / _SPEED)
    accel = errors.accelerometer / np.sqrt(period) * share[:, None] * random.normal(size=(n, 3))
    decay = np.exp(-period / _SLOW_TIME)
    slow = np.zeros((n, 2))
    for i in range(1, n):
        slow[i] = decay * slow[i - 1] + errors.slow * np.sqrt(1 - decay**2) * random.normal(size=2)
    accel[:, :2] += slow * np.minimum(1.0, share)[:, None]
    accel += np.column_stack([mean(along), mean(across), np.full(n, _GRAVITY)])
    return gyro, accel


def honesty(drive: Recording, out: Estimate) -> tuple[float, float]:
    """Shares of the time: with the truth in the 95 % ellipse of the position, and with reported slip."""
    truth = drive.truth[(drive.truth[:, 0] > drive.rest + 1) & (drive.truth[:, 0] < drive.time[-1])]
    seen = np.column_stack([np.interp(truth[:, 0], drive.time, out[axis]) for axis in ("x", "y")])
    rows = np.searchsorted(drive.time, truth[:, 0]).clip(0, drive.time.size - 1)
    covariance = out["pose_covariance"][rows, :2, :2] + 1e-6 * np.eye(2)
    off = seen - truth[:, 1:]
    nees = np.einsum("ni,nij,nj->n", off, np.linalg.inv(covariance), off)
    slips = out["flags"] & FLAGS["slip"] != 0
    steps = np.diff(drive.time, prepend=0)
    return float(np.mean(nees < 5.99)), float(steps[slips].sum() / drive.time[-1])


def save(drive: Recording, path: Path) -> None:
    """Writes small numbers: half a millidegree per second and 0.1 mm/s² are less than any sensor's noise."""
    turn = 2 * np.pi / (drive.counts or 360)
    read, seen = ~np.isnan(drive.left), ~np.isnan(drive.gyro[:, 2])
    np.savez_compressed(
        path,
        wheel_time=drive.time[read],
        left_counts=np.rint(drive.left[read] / turn).astype(np.int32),
        right_counts=np.rint(drive.right[read] / turn).astype(np.int32),
        imu_time=drive.time[seen],
        gyro=np.rint(drive.gyro[seen] / 1e-5).astype(np.int32),
        accel=np.rint(drive.accel[seen] / 1e-3).astype(np.int32),
        truth=drive.truth.astype(np.float32),
    )


def load(path: Path) -> Recording:
    """Reads what `save` wrote, with the default errors."""
    errors = Errors()
    turn = 2 * np.pi / errors.counts
    with np.load(path) as data:
        rows = merged(
            (data["wheel_time"], data["left_counts"] * turn, data["right_counts"] * turn),
            (data["imu_time"], data["gyro"] * 1e-5, data["accel"] * 1e-3),
        )
        truth = data["truth"].astype(float)
    return Recording(
        "field_drive", *rows, rest=errors.rest, radius=RADIUS, base=BASE, counts=errors.counts, truth=truth
    )


if __name__ == "__main__":
    save(field_drive(Errors(), SEED), Path(sys.argv[1]))
