"""The measurements of a recording in one table: a row per time, NaN if a sample is absent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Robot = Mapping[str, Any]
"""`Estimator.robot`"""

AXES = ("x", "y", "z")
GYRO = tuple(f"gyro_{axis}" for axis in AXES)
ACCEL = tuple(f"accel_{axis}" for axis in AXES)

GAP = 0.5
"""s without any sample from which a gap is reported; a robot at 1 m/s is half a metre on"""
MAX_STEP = 60 * 10**9
"""ns between two rows above which the clock was set, or the recording paused; no law bridges a minute"""


class InputError(ValueError):
    """The recording cannot be read; the message names the error, its place and the remedy."""


@dataclass
class Samples:
    """All samples of a recording, strictly increasing in time."""

    time_ns: IntArray  # (N,)
    left: FloatArray  # (N,) or (N, wheels of the side), rad
    right: FloatArray
    gyro: FloatArray | None  # (N, 3), rad/s, IMU axes
    accel: FloatArray | None  # (N, 3), m/s², IMU axes
    notes: list[str] = field(default_factory=list)  # remarks for the user
    warnings: list[str] = field(default_factory=list)  # reasons to doubt the result
    own_log: bool = False  # recorded by this package's node, whose parameters the estimate then uses

    @property
    def seconds(self) -> FloatArray:
        """s since the first row; a jump of the time counts as a usual step."""
        steps = np.diff(self.time_ns, prepend=self.time_ns[0])
        steps[steps > MAX_STEP] = min(int(np.median(steps)), MAX_STEP)
        return np.asarray(np.cumsum(steps) / 1e9)

    @property
    def duration(self) -> float:
        """s"""
        return float(self.seconds[-1])

    def with_imu_earlier(self, seconds: float) -> Samples:
        """The same samples with IMU stamps earlier by `seconds`; rows outside the wheels' time are left out."""
        tables = [table.reshape(self.time_ns.size, -1) for table in (self.left, self.right)]
        imu = [table for table in (self.gyro, self.accel) if table is not None]
        streams = [Stream(*_of_any(self.time_ns, tables))]
        streams += [Stream(*_of_any(self.time_ns - round(seconds * 1e9), [table])) for table in imu]
        time_ns, values = merged(streams)
        inside = (time_ns >= streams[0].time_ns[0]) & (time_ns <= streams[0].time_ns[-1])
        wheels = np.split(values[0][inside], [tables[0].shape[1]], axis=1)
        left, right = (
            table[:, 0] if own.ndim == 1 else table for table, own in zip(wheels, (self.left, self.right), strict=True)
        )
        moved = iter(values[1:])
        gyro, accel = (None if table is None else next(moved)[inside] for table in (self.gyro, self.accel))
        return Samples(time_ns[inside], left, right, gyro, accel, self.notes, self.warnings, self.own_log)

    def rates(self) -> dict[str, float]:
        """Mean rate [Hz] of each sensor that there is."""
        tables = {"wheels": self.left, "gyro": self.gyro, "accelerometer": self.accel}
        return {name: _rate(self.seconds, table) for name, table in tables.items() if table is not None}

    def jumps(self) -> list[str]:
        """Names jumps of the time, at most three of them."""
        steps = np.diff(self.time_ns)
        return [
            f"the time jumps by {steps[row] / 1e9:.3f} s to {self.time_ns[row + 1] / 1e9:.3f} s in row {row + 2}: the "
            "clock was set, or the recording paused. It counts as one step"
            for row in np.flatnonzero(steps > MAX_STEP)[:3].tolist()
        ]

    def gap_note(self) -> str | None:
        """The longest silence of all sensors, where it is long for this recording."""
        if self.time_ns.size < 3:
            return None
        steps = np.diff(self.seconds)
        longest = int(np.argmax(steps))
        if steps[longest] < max(GAP, 10 * float(np.median(steps))):
            return None
        return f"no sample for {steps[longest]:.3g} s after {self.seconds[longest]:.3f} s; the estimate continues"


@dataclass(frozen=True)
class Stream:
    """Samples of one source: `time_ns` (n,), any order; `values` (n, columns)."""

    time_ns: IntArray
    values: FloatArray

    def ordered(self) -> tuple[Stream, int, int]:
        """The samples by time, without repeated times; how many were out of order, and how many repeated a time."""
        back = int(np.count_nonzero(np.diff(self.time_ns) < 0))
        _, first = np.unique(self.time_ns, return_index=True)
        return Stream(self.time_ns[first], self.values[first]), back, self.time_ns.size - first.size


def merged(streams: Sequence[Stream]) -> tuple[IntArray, list[FloatArray]]:
    """One row per time of any stream, strictly increasing; NaN where a stream has no sample."""
    time_ns = np.unique(np.concatenate([stream.time_ns for stream in streams]))
    tables = []
    for stream in streams:
        table = np.full((time_ns.size, stream.values.shape[1]), np.nan)
        table[np.searchsorted(time_ns, stream.time_ns)] = stream.values
        tables.append(table)
    return time_ns, tables


def _of_any(time_ns: IntArray, tables: Sequence[FloatArray]) -> tuple[IntArray, FloatArray]:
    """Times and rows at which any of the columns has a value."""
    table = np.column_stack(tables)
    present = ~np.all(np.isnan(table), axis=1)
    return time_ns[present], table[present]


def wheel_joints(robot: Robot, side: str) -> list[str]:
    """Joint names of one side's wheels, front to back."""
    return [wheel["joint"] for wheel in robot["wheels"] if wheel["side"] == side]


def _rate(seconds: FloatArray, table: FloatArray) -> float:
    present = seconds[np.any(~np.isnan(table.reshape(seconds.size, -1)), axis=1)]
    return 0.0 if present.size < 2 else (present.size - 1) / float(present[-1] - present[0])
