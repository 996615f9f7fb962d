"""When the feet of a robot on legs were commanded stance, and when they bore, from a log."""

from dataclasses import dataclass

import numpy as np

from robot_control.data.run_log import BoolArray, Log

FEET = ("front_left", "front_right", "rear_left", "rear_right")
"""In the order of the log's contacts"""
BEARS = 0.5
"""probability above which a foot bears"""


@dataclass(frozen=True)
class Footfalls:
    """One foot, a value per row."""

    foot: str
    asked: BoolArray
    bears: BoolArray


def footfalls_of(log: Log) -> list[Footfalls]:
    """All feet; empty if the log is none of a robot on legs."""
    bearing = [values for name, values in log.items() if name.endswith("_estimate_contact_probability")]
    if len(bearing) != len(FEET):
        return []
    return [
        Footfalls(foot, np.nan_to_num(log[f"{foot}_stance"]) > 0, np.nan_to_num(values) > BEARS)
        for foot, values in zip(FEET, bearing, strict=True)
    ]
