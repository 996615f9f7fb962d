"""Samples out of a log of this package's telemetry, run.bag or run.csv, or of ClosedLoop."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from robot_control.common.files import listed
from robot_control.common.run_log import LogError, read_run
from robot_control.estimate.samples import ACCEL, GYRO, FloatArray, InputError, IntArray, Robot, Samples, wheel_joints


@dataclass(frozen=True)
class LogColumns:
    """The columns of a log that hold samples."""

    left: list[str]
    right: list[str]

    @property
    def all(self) -> list[str]:
        """Names of all columns, in the order in which `samples` expects them."""
        return [*self.left, *self.right, *GYRO, *ACCEL]

    def samples(self, time_ns: IntArray, values: FloatArray, notes: list[str]) -> Samples:
        """The samples in `values`, shape (rows, columns), whose columns are those of `all`."""
        wheels = len(self.left) + len(self.right)
        left, right, gyro, accel = np.split(values, [len(self.left), wheels, wheels + len(GYRO)], axis=1)
        return Samples(time_ns, left, right, gyro, accel, notes, own_log=True)


def log_columns(path: Path, names: Collection[str], robot: Robot) -> LogColumns:
    """The columns with samples among `names`, those of the log's columns.

    Raises:
        InputError: it is the log of another robot, or has no IMU.
    """
    columns = LogColumns(*([f"{joint}_position" for joint in wheel_joints(robot, side)] for side in ("left", "right")))
    missing = [name for name in [*columns.left, *columns.right] if name not in names]
    if missing:
        positions = [name for name in names if name.endswith("_position")]
        raise InputError(
            f"{path} is a log of another robot: no column {', '.join(missing)}; it has {listed(positions)}. Give "
            "the --urdf or --params that it was recorded with, or --columns time=time,left=…,right=…"
        )
    absent = [name for name in columns.all if name not in names]
    if absent:
        raise InputError(f"{path}: its header is that of a log, but there is no {', '.join(absent)}")
    return columns


def read_run_bag(path: Path, robot: Robot) -> Samples:
    """The last run in a run.bag.

    Raises:
        InputError: it holds no rows, or those of another robot.
        OSError: it cannot be opened.
    """
    try:
        run = read_run(path)
    except LogError as error:
        raise InputError(str(error)) from None
    columns = log_columns(path, run.columns, robot)
    time_ns = np.rint(run.columns["time"] * 1e9).astype(np.int64)
    return columns.samples(time_ns, np.column_stack([run.columns[name] for name in columns.all]), run.notes)
