"""A log as the report reads it: columns that may be absent, counters, durations."""

import xml.etree.ElementTree as ET
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from robot_control.data.brakes import GATE_BRAKE
from robot_control.data.loop_timing import while_all_ran
from robot_control.data.run_log import BoolArray, FloatArray, Log, RunLog, joint_names, kind_in
from robot_control.loop.roles import Kind
from robot_control.loop.signal_names import mask_of, number_of

IntArray = NDArray[np.int64]

PERMIT_DRIVE = number_of("PermitAction", "drive")
COMMAND_HELD, CONTROLLER_BRAKE = mask_of("GateReason", "command_held"), mask_of("GateReason", "controller_brake")

MOVING = 0.01
"""m/s and rad/s; slower is standing"""


@dataclass(frozen=True)
class Drive:
    """One run."""

    name: str
    log: Log
    lost: int | None = None
    """Rows that telemetry counted as lost; None if the file does not hold it: every absent cycle then counts as lost.
    """
    kind: Kind = field(default_factory=Kind)
    mass: float = float("nan")
    """kg, by the robot's description"""
    part: str = ""
    """The part that was read of a file that was not completed or holds several runs; empty if all was read."""

    @property
    def time(self) -> FloatArray:
        """s since the begin of the run."""
        return self.log["time"]

    @property
    def period(self) -> float:
        """s of a cycle."""
        steps, cycles = np.diff(self.time), np.diff(self.log["cycle"])
        known = cycles > 0
        return float(np.median(steps[known] / cycles[known])) if known.any() else float("nan")

    @property
    def joints(self) -> list[str]:
        """Names, in the order of the log."""
        return joint_names(self.log)

    def column(self, name: str) -> FloatArray:
        """The values; NaN in every row if the log has no such column."""
        values = self.log.get(name)
        return np.full(self.time.shape, np.nan) if values is None else values

    def has(self, *names: str) -> bool:
        """True if all of these columns have at least one value."""
        return all(name in self.log and not np.all(np.isnan(self.log[name])) for name in names)

    def uses(self, sensor: str) -> bool:
        """True if the estimator judged this sensor in any cycle; that of another robot kind has other sensors."""
        return any(np.nan_to_num(self.column(f"{of}_{sensor}")).any() for of in ("confidence", "nis"))

    def count(self, name: str) -> float:
        """Sum of a counter that restarts at 0 with its node; NaN if it is not in the log."""
        values = self.column(name)
        values = values[~np.isnan(values)]
        if values.size == 0:
            return float("nan")
        steps = np.diff(values)
        return float(values[0] + steps[steps > 0].sum())

    def bits(self, name: str) -> IntArray:
        """A column of bits; 0 where its node published nothing."""
        return np.nan_to_num(self.column(name)).astype(np.int64)

    def driving(self) -> BoolArray:
        """True while the monitor permits to drive, and motion is commanded or measured."""
        permitted: BoolArray = self.column("permit_action") == PERMIT_DRIVE
        return permitted & self._moving("limited_linear", "limited_angular", "estimate_linear", "estimate_angular")

    def _moving(self, *names: str) -> BoolArray:
        return np.asarray(np.any([np.abs(np.nan_to_num(self.column(name))) > MOVING for name in names], axis=0))

    def gate_braked(self) -> BoolArray:
        """True where the gate braked while driving.

        A command k-1 is executed in tick k; the brake that the controller itself commands at standstill does not count.
        """
        driving = self.driving()
        standing = ~self._moving("limited_linear", "limited_angular")
        by_controller = self.bits("gate_reasons") & ~COMMAND_HELD == CONTROLLER_BRAKE
        braked: BoolArray = self.column("gate_verdict") == GATE_BRAKE
        braked &= driving & np.roll(driving, 1) & ~(by_controller & standing)
        return braked


def mass_of(urdf: str) -> float:
    """kg, of all links of a description; NaN if its text names no masses, as one of xacro."""
    try:
        masses = [float(mass.get("value", "")) for mass in ET.fromstring(urdf).iterfind("link/inertial/mass")]
    except (ET.ParseError, ValueError):
        return float("nan")
    return sum(masses) if masses else float("nan")


def drive_of(path: Path, run: RunLog) -> Drive:
    """The drive without its tail, in which the nodes end one after the other."""
    log: Log = run.columns
    if "command_published_ns" in log and "permit_published_ns" in log:
        log = while_all_ran(log)
    name = path.stem if path.stem != "run" else path.resolve().parent.name + "/" + path.name
    mass = mass_of(str(run.header.get("urdf", "")))
    return Drive(name, log, run.lost, kind_in(run.header), mass, "; ".join(run.notes))
