"""Recorded drives of real robots, and a simple odometry of each for comparison.

NumPy archives of public recordings, in the folder that ROBOT_RECORDINGS names; otherwise `shared/recordings` above the
repository is used. They are not part of the project: a test that needs one skips where the folder is absent.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Table = tuple[FloatArray, FloatArray, FloatArray]
Rows = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]

ABSENT = "no folder of recordings: set ROBOT_RECORDINGS, or put it at shared/recordings above the repository"
NAMES = (
    "skid_steer_a",
    "skid_steer_b",
    "skid_steer_c",
    "skid_steer_d",
    "vacuum_a",
    "vacuum_b",
    "vacuum_c",
    "outdoor_skid_steer",
    "outdoor_skid_steer_imu_b",
    "vehicle",
    "vehicle_mirrored_x",
    "husky_ice",
    "husky_snow",
    "husky_asphalt",
    "warthog_grass",
)

_SKID_COUNTS = 360  # of a wheel's turn
_VACUUM_COUNTS = 508.8
_VEHICLE_RADIUS, _VEHICLE_BASE = 0.3, 1.0  # m: any pair gives the speeds and rates back
_CREATE_RADIUS, _CREATE_BASE = 0.033, 0.26  # m, of an iRobot Create; any pair gives the commanded speeds back
_OUTDOOR_END = 121.0  # s; after it its recorder has gaps
_TIME_STEP = 1e-6  # s between two rows at least, because some stamps are equal


@dataclass(frozen=True)
class Recording:
    """One row per stamp; NaN where a sensor has no sample at it.

    Attributes:
        time: (n,) s, strictly increasing, from 0.
        left, right: (n,) rad, mean of the side's wheels.
        gyro, accel: (n, 3) rad/s, m/s², base axes.
        rest: s at the beginning in which the robot stands.
        radius, base: m; the effective wheel base where the recording's description names one.
        counts: of a wheel's turn; None: its encoder is fine.
        track: m, between left and right wheels, where it is not the base: wheels behind each other; None: no such.
        truth: (n, 3) time, x, y of another sensor, or (n, 4) with the yaw; empty where there is none.
    """

    name: str
    time: FloatArray
    left: FloatArray
    right: FloatArray
    gyro: FloatArray
    accel: FloatArray
    rest: float
    radius: float
    base: float
    counts: float | None = None
    track: float | None = None
    truth: FloatArray = field(default_factory=lambda: np.empty((0, 3)))

    def geometry(self) -> dict[str, Any]:
        """Arguments of `Estimator`."""
        given: dict[str, Any] = {"wheel_radius": self.radius, "wheel_base": self.track or self.base}
        if self.track is not None:
            given["params"] = {"robot": {"wheel_base_multiplier": self.base / self.track}}
        if self.counts is not None:
            given["encoder_counts"] = self.counts
        return given

    def samples(self) -> tuple[FloatArray, ...]:
        """Arguments of `Estimator.process`."""
        return self.time, self.left, self.right, self.gyro, self.accel


def recordings_folder() -> Path | None:
    """The folder of recordings; None where there is none."""
    named = os.environ.get("ROBOT_RECORDINGS")
    if named:
        return Path(named)
    beside = (parent / "shared" / "recordings" for parent in Path(__file__).resolve().parents)
    return next((folder for folder in beside if folder.is_dir()), None)


@cache
def recording(name: str) -> Recording:
    """One of `NAMES`.

    Raises:
        FileNotFoundError: no folder, or no such file in it.
    """
    folder = recordings_folder()
    if folder is None:
        raise FileNotFoundError(ABSENT)
    kind = name.rstrip("abcd") if name.startswith(("skid", "vacuum")) else name.split("_", maxsplit=1)[0]
    file = {"outdoor": "outdoor_skid_steer", "vehicle": "vehicle"}.get(kind, name)
    with np.load(folder / f"{file}.npz") as data:
        read = {
            "skid_steer_": _skid_steer,
            "vacuum_": _vacuum,
            "outdoor": _outdoor,
            "vehicle": _vehicle,
            "husky": _husky,
            "warthog": _warthog,
        }[kind]
        drive = read(name, data)
    for array in (drive.time, drive.left, drive.right, drive.gyro, drive.accel, drive.truth):
        array.flags.writeable = False  # all callers share it
    return drive


def without_beginning(drive: Recording, begin: float) -> Recording:
    """The drive from `begin` s on, as if it had been switched on there. It has no truth."""
    rest = drive.time >= begin
    names = ("left", "right", "gyro", "accel")
    columns = {name: getattr(drive, name)[rest] for name in names}
    time = drive.time[rest]
    return replace(drive, time=time - time[0], rest=0.0, truth=np.empty((0, 3)), **columns)


def _strictly_increasing(time: FloatArray) -> FloatArray:
    steps = np.maximum.accumulate(time) + _TIME_STEP * np.arange(len(time))
    return np.asarray(steps)


def merged(wheels: Table, imu: Table) -> Rows:
    """(time, left, right), (time, gyro, accel) → time, left, right, gyro, accel; one row per stamp."""
    both = np.concatenate([wheels[0], imu[0]])
    order = np.argsort(both, kind="stable")
    time = _strictly_increasing(both[order] - both.min())
    position = np.empty_like(order)
    position[order] = np.arange(len(order))
    n = len(wheels[0])
    columns = [np.full(len(both), np.nan), np.full(len(both), np.nan)]
    axes = [np.full((len(both), 3), np.nan), np.full((len(both), 3), np.nan)]
    for column, values in zip(columns, wheels[1:], strict=True):
        column[position[:n]] = values
    for axis, values in zip(axes, imu[1:], strict=True):
        axis[position[n:]] = values
    return time, columns[0], columns[1], axes[0], axes[1]


def _skid_steer(name: str, data: Mapping[str, FloatArray]) -> Recording:
    turn = 2 * np.pi / _SKID_COUNTS
    if "encoder_increments" in data:
        counts = np.cumsum(data["encoder_increments"].astype(float), axis=1)
        time, radius = data["encoder_time"], 0.126
        right, left = (counts[0] + counts[2]) / 2, (counts[1] + counts[3]) / 2
    else:
        time, radius = data["wheel_time"], 0.127
        left = (data["counts_front_left"] + data["counts_rear_left"]) / 2
        right = (data["counts_front_right"] + data["counts_rear_right"]) / 2
    rows = merged((time, left * turn, right * turn), (data["imu_time"], data["gyro"], data["accel"]))
    base = {"c": 0.95, "d": 0.72}.get(name[-1], 0.78)
    return Recording(name, *rows, rest=_rest_of(rows), radius=radius, base=base, counts=_SKID_COUNTS)


def _vacuum(name: str, data: Mapping[str, FloatArray]) -> Recording:
    turn = 2 * np.pi / _VACUUM_COUNTS
    rows = (
        _strictly_increasing(data["wheel_time"] - data["wheel_time"][0]),
        data["left_counts"] * turn,
        data["right_counts"] * turn,
        data["gyro"],
        data["accel"],
    )
    return Recording(name, *rows, rest=_rest_of(rows), radius=0.036, base=0.235, counts=_VACUUM_COUNTS)


def _outdoor(name: str, data: Mapping[str, FloatArray]) -> Recording:
    b = "_b" if name.endswith("imu_b") else ""
    since = np.diff(data["wheel_time"], prepend=data["wheel_time"][0])
    left, right = (np.cumsum(data[f"{side}_speed"] * since) for side in ("left", "right"))
    start = min(data["wheel_time"][0], data[f"imu{b}_time"][0])
    wheels, imu = data["wheel_time"] < _OUTDOOR_END, data[f"imu{b}_time"] < _OUTDOOR_END
    rows = merged(
        (data["wheel_time"][wheels], left[wheels], right[wheels]),
        (data[f"imu{b}_time"][imu], data[f"gyro{b}"][imu], data[f"accel{b}"][imu]),
    )
    seen = data["camera_time"] < _OUTDOOR_END
    camera = data["camera_position"][seen]
    truth = np.column_stack([data["camera_time"][seen] - start, camera[:, 0], -camera[:, 1]])
    return Recording(name, *rows, rest=_rest_of(rows), radius=0.1651, base=0.98, truth=truth)


def _vehicle(name: str, data: Mapping[str, FloatArray]) -> Recording:
    """Its IMU's frame is left-handed; the data do not show which horizontal axis is mirrored."""
    since = np.diff(data["odom_time"], prepend=data["odom_time"][0])
    forward = np.cumsum(data["odom_linear"] * since)
    half_turn = np.cumsum(data["odom_angular"] * since) * _VEHICLE_BASE / 2
    force = np.array([-1.0, 1.0, 1.0] if name.endswith("x") else [1.0, -1.0, 1.0])
    rows = merged(
        (data["odom_time"], (forward - half_turn) / _VEHICLE_RADIUS, (forward + half_turn) / _VEHICLE_RADIUS),
        (data["imu_time"], -force * data["gyro"], force * data["accel"]),
    )
    return Recording(name, *rows, rest=_rest_of(rows), radius=_VEHICLE_RADIUS, base=_VEHICLE_BASE)


def _husky(name: str, data: Mapping[str, FloatArray]) -> Recording:
    """It begins and ends in motion. Its wheels report speeds in steps of 0.079 m/s at 6.5 Hz."""
    since = np.diff(data["wheel_time"], prepend=data["wheel_time"][0])
    left, right = (np.cumsum(data[f"{side}_speed"] * since) for side in ("left", "right"))
    rows = merged((data["wheel_time"], left, right), (data["imu_time"], data["gyro"], data["accel"]))
    return Recording(name, *rows, rest=0.0, radius=float(data["wheel_radius"]), base=float(data["wheel_base"]))


def _warthog(name: str, data: Mapping[str, FloatArray]) -> Recording:
    """The truth is that of a lidar, which is late by 0.3 … 1.5 s: it holds at rest."""
    start = min(data["wheel_time"][0], data["imu_time"][0])
    rows = merged(
        (data["wheel_time"], data["left_angle"], data["right_angle"]), (data["imu_time"], data["gyro"], data["accel"])
    )
    names = ("truth_x", "truth_y", "truth_yaw")
    truth = np.column_stack([data["truth_time"] - start, *(data[which] for which in names)])
    radius, base = (float(data[which]) for which in ("wheel_radius", "wheel_base"))
    return Recording(name, *rows, rest=_rest_of(rows), radius=radius, base=base, truth=truth)


@cache
def commanded_drives() -> dict[str, Recording]:
    """Robots on two wheels without encoders and without an IMU: their wheels turn as commanded. Name → drive.

    Raises:
        FileNotFoundError: no folder, or no such file in it.
    """
    folder = recordings_folder()
    if folder is None:
        raise FileNotFoundError(ABSENT)
    drives = {}
    with np.load(folder / "mrclam_6.npz") as data:
        for number in range(1, 6):
            odometry, truth = data[f"robot{number}_odometry"], data[f"robot{number}_truth"]
            time = _strictly_increasing(odometry[:, 0] - truth[0, 0])
            since = np.diff(time, append=time[-1])  # a command holds until the next one
            way, turn = (np.concatenate([[0], np.cumsum(odometry[:, i] * since)[:-1]]) for i in (1, 2))
            left, right = way - turn * _CREATE_BASE / 2, way + turn * _CREATE_BASE / 2
            nothing = np.full((time.size, 3), np.nan)
            truth = np.column_stack([truth[:, 0] - truth[0, 0], truth[:, 1:]])
            name = f"create_{number}"
            angles = (left / _CREATE_RADIUS, right / _CREATE_RADIUS)
            drives[name] = Recording(
                name, time, *angles, nothing, nothing, rest=0.0, radius=_CREATE_RADIUS, base=_CREATE_BASE, truth=truth
            )
    return drives


def _rest_of(rows: tuple[FloatArray, ...]) -> float:
    """s until a wheel moves."""
    time, left, right = rows[:3]
    read = ~np.isnan(left)
    moved = (np.abs(left[read] - left[read][0]) > 0.03) | (np.abs(right[read] - right[read][0]) > 0.03)
    return float(time[read][np.argmax(moved)])


def simple_path(drive: Recording) -> FloatArray:
    """(n, 3) x, y, yaw: distance by the wheels, heading by the gyro minus its mean in the first rest."""
    seen = ~np.isnan(drive.gyro[:, 2])
    time, rate = drive.time[seen], drive.gyro[seen, 2]
    # A wheel's first count may come late, so the last tenths of a second before it may not be rest.
    rests = time < drive.rest - min(0.5, drive.rest / 4)
    bias = rate[rests].mean() if rests.any() else 0.0
    turned = np.concatenate([[0], np.cumsum(np.diff(time) * (rate[1:] + rate[:-1]) / 2)])
    yaw = np.interp(drive.time, time, turned - bias * (time - time[0]))
    read = ~np.isnan(drive.left)
    travel = np.interp(drive.time, drive.time[read], drive.radius * (drive.left + drive.right)[read] / 2)
    middle = yaw - np.diff(yaw, prepend=yaw[0]) / 2
    steps = np.diff(travel, prepend=travel[0])
    return np.column_stack([np.cumsum(steps * np.cos(middle)), np.cumsum(steps * np.sin(middle)), yaw])


def aligned_errors(path: FloatArray, reference: FloatArray) -> FloatArray:
    """(n, 2) m, in the axes of the path: path (n, 2) less reference (n, 2) after its best rigid motion of the plane."""
    a, b = path - path.mean(axis=0), reference - reference.mean(axis=0)
    angle = np.arctan2(np.sum(b[:, 0] * a[:, 1] - b[:, 1] * a[:, 0]), np.sum(a * b))
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.asarray(a - b @ turn.T)


def aligned_rms(path: FloatArray, reference: FloatArray) -> float:
    """m: (n, 2) against (n, 2) after the best rigid motion of the plane."""
    return float(np.sqrt(np.mean(np.sum(aligned_errors(path, reference) ** 2, axis=1))))
