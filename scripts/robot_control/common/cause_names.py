"""The names of StopCause bits, and of the bits in a column of a log."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

STOP_CAUSES = (
    "e_stop_topic",
    "e_stop_service",
    "e_stop_input",
    "driver_lost",
    "driver_fault",
    "controller_lost",
    "estimator_lost",
    "heartbeat_lost",
    "monitor_restarted",
    "corrupt_frame",
    "not_finite",
    "monitor_late",
    "encoders_lost",
    "imu_lost",
    "imu_stuck",
    "command_stale",
    "wheel_speed",
    "wheel_acceleration",
    "wheel_effort",
    "power",
    "stall",
    "runaway",
    "wrong_direction",
    "not_stopping",
    "yaw_rate",
    "tilt",
    "tip_over",
    "free_fall",
    "lift",
    "impact",
    "gate_refuses",
    "gate_disobeys",
    "overruns",
    "battery_low",
    "battery_empty",
    "latch_unreadable",
    "torque_oscillation",
)
"""In the order of the bits of StopCause."""


def causes_in(column: NDArray[np.float64]) -> list[str]:
    """Names of all that ever stood in it, lowest bit first; NaN, where the monitor published nothing, is none."""
    bits = int(np.bitwise_or.reduce(column[~np.isnan(column)].astype(np.int64), initial=0))
    return [name for bit, name in enumerate(_names(bits.bit_length())) if bits >> bit & 1]


def _names(count: int) -> list[str]:
    return [STOP_CAUSES[bit] if bit < len(STOP_CAUSES) else f"cause {bit}" for bit in range(count)]
