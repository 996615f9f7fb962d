"""Drives behind motor drives on a disturbed bus or line, beside the same drives on an undisturbed one.

The request changes every `SEGMENT`, in the middle of which the ripple is measured. The clocks of the drives are always
apart (drivers/drive/can_front.h).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from robot_control.loop.closed_loop import Log

from bench.devices.loss_trial import SERIAL, robot_behind
from bench.faults.sequence_judge import STOPPED_STATES

SEGMENT = 10.0  # s
SETTLED = 4.0  # s of a segment after which speed and turn are steady
RIPPLE_TIME = 0.5  # s over which the speed is averaged
BUSES = ("ok", "lossy", "disturbed")
BOARD_RATE = 250.0  # Hz
SAFETY = {"vesc": {"encoders_lost": {"persistence": 0.02}}}
"""docs/drivers.md sets this of `safety_monitor` where frames are lost."""


@dataclass(frozen=True)
class DisturbedDrive:
    """A drive of `seconds` behind drives of this dialect on a bus or line in this state (ok, lossy, disturbed)."""

    dialect: str
    bus: str
    seconds: float
    seed: int = 1


@dataclass(frozen=True)
class DriveFigures:
    """False stops; RMS of the odometry's error per segment in m; RMS ripple of the turn in rad/s."""

    stops: int
    odometry: float
    ripple: float


def requests(seed: int, count: int) -> list[tuple[float, float]]:
    """Requests of m/s and rad/s."""
    random = np.random.default_rng(seed)
    return [(float(random.uniform(0.2, 0.8)), float(random.uniform(-0.5, 0.5))) for _ in range(count)]


def run_drive(drive: DisturbedDrive) -> DriveFigures:
    """Runs one drive."""
    loop = robot_behind(drive.dialect, drive.seed, BOARD_RATE, SAFETY.get(drive.dialect))
    loop.run(1.0, (0.0, 0.0))
    loop.inject_fault("line" if drive.dialect in SERIAL else "bus", drive.bus)
    stops, odometry, ripple = 0, [], []
    for request in requests(drive.seed, round(drive.seconds / SEGMENT)):
        log = loop.run(SEGMENT, request)
        stops += int(np.isin(log["supervisor_state"], STOPPED_STATES).any())
        odometry.append(float(np.linalg.norm(travel(log, "estimate") - travel(log, "truth"))))
        steady = log["truth_angular"][round(SETTLED / loop.period) :]
        width = round(RIPPLE_TIME / loop.period)
        mean = np.convolve(steady, np.full(width, 1 / width), "valid")
        ripple.append(float(np.std(steady[width // 2 : width // 2 + len(mean)] - mean)))
    return DriveFigures(stops, rms(odometry), rms(ripple))


def together(drives: Sequence[DriveFigures]) -> DriveFigures:
    """The figures of equally long drives as one."""
    odometry, ripple = (rms([getattr(drive, name) for drive in drives]) for name in ("odometry", "ripple"))
    return DriveFigures(sum(drive.stops for drive in drives), odometry, ripple)


def travel(log: Log, source: str) -> NDArray[np.float64]:
    """The way of a segment, m, in the frame of its beginning; shape (2,)."""
    x, y, yaw = (log[f"{source}_{name}"] for name in ("x", "y", "yaw"))
    dx, dy, turn = x[-1] - x[0], y[-1] - y[0], -yaw[0]
    return np.array([np.cos(turn) * dx - np.sin(turn) * dy, np.sin(turn) * dx + np.cos(turn) * dy])


def rms(values: Sequence[float]) -> float:
    """Root of the mean of the squares."""
    return float(np.sqrt(np.mean(np.square(values))))
