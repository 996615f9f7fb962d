"""The rows of a log that a replay shows, read by a process of its own, because a page may not wait for them."""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from robot_control._robot_control import read_run_header
from robot_control.data.intervals import intervals
from robot_control.data.run_log import kind_in, odom_frame, read_run
from robot_control.files.files import utf8
from robot_control.loop import signal_names as names
from robot_control.watch.console.replay.maps import maps_beside

RATE = 50.0
"""Hz of the rows that are kept"""
SPEEDS = ("linear", "angular", "lateral")
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
STATE = ("supervisor_state", "permit_causes", "permit_active", "evidence_cause", "evidence_value", "evidence_limit")
COVARIANCE = ("estimate_x_variance", "estimate_xy_covariance", "estimate_y_variance")
TRUTH = ("truth_x", "truth_y", "truth_yaw")
CONTACT = ("estimate_contact_probability", "estimate_contact_load")
SLOPE, FEET_BITS = ("slope_ahead", "slope_left"), ("legged_risers", "legged_reaches")
SHOWN = 0.2
"""s for which an event of a foot is shown, as in LegState"""
STOPPED = ("STOPPING", "STOPPED", "FAULT")
MARK_TIMES, MARK_CAUSES = "mark_times", "mark_causes"
"""s of each stop from the begin of the log, and the bits of its causes"""


def rows_of(path: Path) -> dict[str, np.ndarray[Any, Any]]:
    """Maps, and columns at RATE, `time` from the begin of the log. Raises LogError, OSError."""
    header = read_run_header(utf8(path))
    joints: Sequence[str] = header["joints"]
    columns = [
        *STATE,
        *COVARIANCE,
        *TRUTH,
        *SLOPE,
        *FEET_BITS,
        "battery_voltage",
        "time",
        "legged_phase",
        *(f"estimate_{axis}" for axis in POSE),
    ]
    columns += [f"{of}_{axis}" for of in ("estimate", "requested", "limited", "truth") for axis in SPEEDS]
    columns += [f"{joint}_{what}" for joint in joints for what in ("position", "effort")]
    columns += [f"{joint}_velocity_{what}" for joint in joints for what in ("command", "measured")]
    columns += [f"{contact}_{what}" for contact in contacts_of(header) for what in CONTACT]
    run = read_run(path, columns)
    seconds = run.columns["time"] - run.columns["time"][0]
    state, causes = run.columns["supervisor_state"], np.nan_to_num(run.columns["permit_causes"]).astype(np.int64)
    stopped = np.isin(state, [names.number_of("SupervisorState", name) for name in STOPPED]) & (causes != 0)
    begins = [begin for begin, _ in intervals(stopped, state)]
    for name in set(FEET_BITS) & set(run.columns):
        run.columns[name] = held(run.columns[name], round(SHOWN / float(run.header["period"])))
    every = max(1, round(1 / (RATE * float(run.header["period"]))))
    rows = {name: values[::every].copy() for name, values in (run.columns | {"time": seconds}).items()}
    begin, end = (float(run.ros_time[row]) for row in (0, -1))
    maps = maps_beside(path, begin, end, odom_frame(header["parameters"]))
    return rows | maps | {MARK_TIMES: seconds[begins], MARK_CAUSES: causes[begins].astype(float)}


def held(bits: np.ndarray[Any, Any], rows: int) -> np.ndarray[Any, Any]:
    """The bits of each row, of four feet, with those of so many rows before it."""
    number, found = np.arange(len(bits)), np.zeros(len(bits))
    for leg in range(4):
        at = np.maximum.accumulate(np.where(np.nan_to_num(bits).astype(int) >> leg & 1, number, -rows - 1))
        found += (number - at <= rows) * 2.0**leg
    return found


def contacts_of(header: Mapping[str, Any]) -> Sequence[str]:
    """The links of the feet, in the order of FEET; none of a robot on wheels."""
    return list(header["contacts"]) if kind_in(header).legged else []


def main() -> None:
    """Writes the rows of the log that the first argument names into the file that the second one names."""
    np.savez(sys.argv[2], **rows_of(Path(sys.argv[1])))
