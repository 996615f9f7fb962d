"""Samples out of a run.bag of this package's telemetry, or of ClosedLoop."""

from pathlib import Path

import numpy as np

from robot_control.data.estimate.samples import ACCEL, GYRO, InputError, Robot, Samples, wheel_joints
from robot_control.data.run_log import LogError, read_run
from robot_control.files.files import listed


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
    sides = [[f"{joint}_position" for joint in wheel_joints(robot, side)] for side in ("left", "right")]
    missing = [name for side in sides for name in side if name not in run.columns]
    if missing:
        positions = [name for name in run.columns if name.endswith("_position")]
        what = f"{path} is a log of another robot: no column {', '.join(missing)}"
        raise InputError(f"{what}; it has {listed(positions)}. Give the --urdf or --params that it was recorded with")
    time_ns = np.rint(run.columns["time"] * 1e9).astype(np.int64)
    left, right, gyro, accel = (
        np.column_stack([run.columns[name] for name in names]) for names in (*sides, GYRO, ACCEL)
    )
    return Samples(time_ns, left, right, gyro, accel, run.notes, own_log=True)
