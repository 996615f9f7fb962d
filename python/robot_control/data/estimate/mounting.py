"""Which mounting of the IMU fits a recording: the one in which gravity points up and the horizontal forces are those of
the wheels' motion.

Over blocks of BLOCK seconds the wheels show by how much the robot became faster, Δv, and how much it was pulled aside,
∫ v ω dt. The accelerometer's integrals in the axes of a mounting should be the same, but for a constant. `agreement` is
their correlation; of the four mountings on the axes with gravity upwards the best one fits. A left-handed frame agrees
best with its y axis mirrored.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from robot_control.data.estimate.samples import FloatArray
from robot_control.data.estimate.streams import Streams
from robot_control.robot.pose import rpy

GRAVITY = 9.80665  # m/s²
BLOCK = 0.5  # s
FEWEST = 10  # blocks in motion
OBLIQUE = math.radians(25)
"""angle from an axis; slopes and crooked mountings make less of gravity in a robot that stands"""
AGREES, BETTER = 0.25, 0.25
"""An agreement is significant from AGREES on, and better only if it is larger by BETTER. Right mountings of recordings
of real robots have 0.17 … 0.91, wrong ones up to 0.1."""


@dataclass(frozen=True)
class Mounting:
    """Roll, pitch and yaw [rad] of the IMU in base_link, whether its y axis is mirrored, and its agreement."""

    rpy: tuple[float, float, float]
    mirrored: bool
    agreement: float

    @property
    def option(self) -> str:
        """The value of the option of estimate.py."""
        return "--imu-orientation=" + ",".join(f"{round(angle, 4) + 0.0:.4g}" for angle in self.rpy)


def gravity_of(streams: Streams) -> FloatArray | None:
    """m/s², IMU axes: the mean over the first rest, else over everything; None without an accelerometer."""
    if streams.accel_time.size == 0:
        return None
    for begin, end in streams.rests()[:1]:
        inside = (streams.accel_time >= begin) & (streams.accel_time <= end)
        if inside.sum() >= 5:
            return np.asarray(streams.accel[inside].mean(axis=0))
    return np.asarray(streams.accel.mean(axis=0))


def tilt_of(gravity: FloatArray, base_from_imu: FloatArray) -> float:
    """rad, between the measured vertical and the base's z axis."""
    up = base_from_imu @ gravity / np.linalg.norm(gravity)
    return float(np.arccos(np.clip(up[2], -1, 1)))


def fitting(streams: Streams, gravity: FloatArray) -> list[Mounting]:
    """The four mountings on the axes in which gravity points up, plain and mirrored, the best one first; none where
    gravity lies between the axes.
    """
    motion, found = _motion(streams), list[Mounting]()
    for matrix in np.round(Rotation.create_group("O").as_matrix()):
        if matrix[2] @ gravity >= math.cos(OBLIQUE) * float(np.linalg.norm(gravity)):
            plain, mirrored = _agreements(streams, motion, matrix)
            found += [Mounting(rpy(matrix), False, plain), Mounting(rpy(matrix), True, mirrored)]  # noqa: FBT003
    return sorted(found, key=lambda mounting: -mounting.agreement)


def agreement(streams: Streams) -> float:
    """Agreement of the given mounting; 0 if the drive shows nothing."""
    return _agreements(streams, _motion(streams), streams.base_from_imu)[0]


def _motion(streams: Streams) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Begin and end of blocks [s] (n, 2), Δv and ∫ v ω dt of each (n,) m/s; none where the wheels have no readings."""
    time = streams.wheel_time
    if time.size < FEWEST or streams.accel_time.size < FEWEST:
        return np.empty((0, 2)), np.empty(0), np.empty(0)
    begin, end = max(time[0], streams.accel_time[0]), min(time[-1], streams.accel_time[-1])
    cells = np.unique((time[(time >= begin) & (time < end)] - begin) // BLOCK)
    if cells.size < FEWEST + 2:
        return np.empty((0, 2)), np.empty(0), np.empty(0)
    marks = begin + BLOCK * cells
    travel = np.interp(marks, time, streams.way)
    turn = np.interp(marks, time, streams.right - streams.left) / streams.wheel_base
    speed = np.diff(travel) / BLOCK  # in the middle of each block: Δv is between middles
    rate = np.diff(turn) / BLOCK
    sideways = (speed * rate)[1:] / 2 + (speed * rate)[:-1] / 2
    whole = cells[2:] - cells[:-2] == 2
    ends = np.column_stack([marks[:-2] + marks[1:-1], marks[1:-1] + marks[2:]]) / 2
    return ends[whole], np.diff(speed)[whole], sideways[whole] * BLOCK


def _agreements(
    streams: Streams, motion: tuple[FloatArray, FloatArray, FloatArray], mounting: FloatArray
) -> tuple[float, float]:
    """Agreement of a mounting, plain and with the IMU's y axis mirrored."""
    blocks, faster, aside = motion
    if blocks.size == 0:
        return 0.0, 0.0
    force = streams.accel @ mounting.T
    steps = np.diff(streams.accel_time, prepend=streams.accel_time[0])
    velocity = np.cumsum(force[:, :2] * steps[:, None], axis=0)
    gained = np.column_stack([np.diff(np.interp(blocks, streams.accel_time, axis))[:, 0] for axis in velocity.T])
    gained -= np.median(gained, axis=0)
    ahead, sideways = float(gained[:, 0] @ faster), float(gained[:, 1] @ aside)
    scale = math.sqrt(float((faster @ faster + aside @ aside) * np.sum(gained**2))) or 1.0
    return (ahead + sideways) / scale, (ahead - sideways) / scale
