"""Computes how long each step of a cycle took; only runs in wall-clock time have these columns."""

from dataclasses import dataclass

import numpy as np

from robot_control.data.report.drive import Drive
from robot_control.data.run_log import FloatArray


@dataclass(frozen=True)
class Latency:
    """Time from one stamp of a cycle to another; an empty `begin` stands for that of the cycle before."""

    name: str
    meaning: str
    begin: str
    end: str


LATENCIES = (
    Latency("period", "from one wake-up of the driver to the next", "", "driver_woke_ns"),
    Latency("wake_up", "from the driver's deadline to its wake-up", "", ""),
    Latency(
        "sensors_to_state",
        "from the published sensors to the published state",
        "sensors_published_ns",
        "state_published_ns",
    ),
    Latency(
        "state_to_command",
        "from the published state to the published command",
        "state_published_ns",
        "command_published_ns",
    ),
    Latency(
        "sensors_to_permit",
        "from the published sensors to the published permit",
        "sensors_published_ns",
        "permit_published_ns",
    ),
    Latency(
        "sensors_to_command",
        "from the driver's wake-up to the published command",
        "driver_woke_ns",
        "command_published_ns",
    ),
)


def durations_ns(drive: Drive, latency: Latency) -> FloatArray:
    """Durations by row of the log; NaN where a cycle does not hold them."""
    if not np.any(np.nan_to_num(drive.column("command_published_ns"))):  # a loop in one process reads no clock
        return np.full(drive.time.shape, np.nan)
    woke = drive.column("driver_woke_ns")
    slipped = np.diff(drive.column("slipped_ns"), prepend=np.nan)
    if latency.name == "wake_up":
        late: FloatArray = woke + slipped
        return late
    if latency.name == "period":
        # The wake-up is relative to the cycle's own deadline, which moves by the slip of a simulated plant.
        period = np.diff(drive.column("stamp_ns"), prepend=np.nan) + slipped + np.diff(woke, prepend=np.nan)
        return np.where(np.diff(drive.log["cycle"], prepend=np.nan) == 1, period, np.nan)
    duration: FloatArray = drive.column(latency.end) - drive.column(latency.begin)
    return duration
