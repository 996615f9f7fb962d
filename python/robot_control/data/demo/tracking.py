"""Judges whether the robot followed its command, by the truth, never by the robot's own estimate.

The command is a constant twist (v, ω), sent from rest. With the log's rows k of one run:

    asked    rows whose requested twist is (v, ω); first … last of them, gaps included
    reached  the first asked row whose limited twist is (v, ω), too
    steady   from SETTLE after `reached` to the last asked row
    excused  a brake of the gate for want of a command or of a live permit, and EXCUSED_CYCLES after it

    |mean(truth) − command| ≤ mean · |command|    over the steady rows, excused ones included
    |truth_k − command| ≤ cycle · |command|       in every steady row that is not excused, on wheels
    |estimate − truth|₂ ≤ pose · distance         of the last steady row; distance: length of the true path

for the linear and the angular component each; mean, cycle and pose are the tolerances of the kind of robot. A body on
legs sways within each step. A stop by the safety monitor excuses nothing.
"""

import math
from dataclasses import dataclass

import numpy as np

from robot_control.data.brakes import GATE_BRAKE
from robot_control.data.run_log import BoolArray, FloatArray, Log
from robot_control.loop.signal_names import mask_of
from robot_control.robot.pose import Pose, along_arcs, turned

EXCUSED_CYCLES = 50
SETTLE = 0.5
"""s; 5 time constants kp/ki = 0.1 s of the wheel loop, whose feed-forward leaves little to settle."""
ROWS_NEEDED = 0.99
"""Share of the steady cycles whose truth must be in the log: a cycle without truth cannot be judged."""

GATE_LATE = mask_of("GateReason", "no_permit", "permit_expired", "no_command")


class NotSteadyError(ValueError):
    """There is no steady part to judge; the message names the reason."""


@dataclass(frozen=True)
class Tolerances:
    """The differences that a run may have, relative to command or distance."""

    mean: float = 0.01
    cycle: float | None = 0.05
    """None: not judged"""
    pose: float = 0.01
    rise: float = 2.0
    """s from first asked to reached; the article's command needs 0.5 s at 1 m/s², the default acceleration limit."""


ON_WHEELS = Tolerances()
ON_LEGS = Tolerances(mean=0.03, cycle=None, rise=5.0)
"""It stands up within 2 s before it walks."""


@dataclass(frozen=True)
class Check:
    """One demand and the value that the run reached; both relative."""

    name: str
    value: float
    tolerance: float

    @property
    def passed(self) -> bool:
        """True if the demand is met; a NaN never meets it."""
        return abs(self.value) <= self.tolerance


@dataclass(frozen=True)
class Axis:
    """One component of the twist over the steady part, m/s or rad/s."""

    commanded: float
    truth: float
    estimate: float
    rms_error: float


@dataclass(frozen=True)
class Tracking:
    """The command, the true motion and the estimated one."""

    begin: float
    """s, time of the first steady row."""
    end: float
    """s, time of the last one."""
    excused_cycles: int
    linear: Axis
    angular: Axis
    commanded_pose: Pose
    true_pose: Pose
    estimated_pose: Pose
    distance: float
    """m, length of the true path up to `end`."""
    position_error: float
    """m, of the estimate at `end`."""
    yaw_error: float
    """rad, of the estimate at `end`."""
    checks: tuple[Check, ...]

    @property
    def passed(self) -> bool:
        """All checks."""
        return all(check.passed for check in self.checks)


def steady_rows(log: Log, linear: float, angular: float, rise: float = ON_WHEELS.rise) -> slice:
    """Rows of the steady part of a log, for the command `linear` [m/s], `angular` [rad/s], reached within `rise` s.

    Raises:
        NotSteadyError: the command never arrived, was never let through, or ended too soon.
    """
    time = log["time"]
    asked = np.flatnonzero(_is_twist(log, "requested", linear, angular))
    if asked.size == 0:
        raise NotSteadyError(f"the controller never received {linear:g} m/s, {angular:g} rad/s")
    first, final = asked[0], asked[-1]
    limited = _is_twist(log, "limited", linear, angular)[first : final + 1]
    if not limited.any():
        raise NotSteadyError("the limited command never reached the requested one")
    reached = first + int(np.argmax(limited))
    if time[reached] - time[first] > rise:
        what = f"the limited command reached the requested one after {time[reached] - time[first]:.1f} s"
        raise NotSteadyError(f"{what}, not within {rise:g} s")
    begin = int(np.searchsorted(time, time[reached] + SETTLE))
    if begin >= final:
        raise NotSteadyError(f"the command ended within {SETTLE:g} s after it was reached")
    return slice(begin, int(final) + 1)


def excused_rows(log: Log) -> BoolArray:
    """Rows (rows,) that a counted brake of the gate excuses: its own cycle and EXCUSED_CYCLES after it."""
    reasons = np.nan_to_num(log["gate_reasons"]).astype(np.int64)
    late = (log["gate_verdict"] == GATE_BRAKE) & ((reasons & GATE_LATE) != 0)
    braked = log["cycle"][late]
    if braked.size == 0:
        return np.zeros(late.shape, dtype=bool)
    previous = np.searchsorted(braked, log["cycle"], side="right") - 1
    since = log["cycle"] - braked[np.maximum(previous, 0)]
    return np.asarray((previous >= 0) & (since <= EXCUSED_CYCLES))


def judge(log: Log, linear: float, angular: float, tolerances: Tolerances = ON_WHEELS) -> Tracking:
    """Judges a run on the command `linear` [m/s], `angular` [rad/s]; neither may be zero.

    Raises:
        NotSteadyError: there is nothing to judge.
    """
    if linear == 0 or angular == 0:
        raise ValueError("the tolerances are relative to the command: neither component may be zero")
    rows = steady_rows(log, linear, angular, tolerances.rise)
    excused = excused_rows(log)[rows]
    cycle = log["cycle"][rows]
    known = ~np.isnan(log["truth_x"][rows])
    if known.sum() < ROWS_NEEDED * (cycle[-1] - cycle[0] + 1):
        raise NotSteadyError(f"only {known.sum():.0f} of {cycle[-1] - cycle[0] + 1:.0f} steady cycles are in the log")

    checks: list[Check] = []
    axes: list[Axis] = []
    for name, commanded in (("linear", linear), ("angular", angular)):
        truth = log[f"truth_{name}"][rows][known]
        error = (truth - commanded) / commanded
        judged = error[~excused[known]]
        worst = judged[np.argmax(np.abs(judged))] if judged.size else np.nan
        checks.append(Check(f"mean true {name} speed", float(error.mean()), tolerances.mean))
        if tolerances.cycle is not None:
            checks.append(Check(f"worst steady cycle, {name}", float(worst), tolerances.cycle))
        estimate, rms = np.nanmean(log[f"estimate_{name}"][rows]), np.sqrt(np.mean(error**2)) * abs(commanded)
        axes.append(Axis(commanded, float(truth.mean()), float(estimate), float(rms)))

    end = rows.start + int(np.flatnonzero(known & ~np.isnan(log["estimate_x"][rows]))[-1])
    true_pose, estimated_pose = _pose(log, "truth", end), _pose(log, "estimate", end)
    distance = _path_length(log["truth_x"][: end + 1], log["truth_y"][: end + 1])
    position_error = math.hypot(estimated_pose.x - true_pose.x, estimated_pose.y - true_pose.y)
    relative = position_error / distance if distance > 0 else math.nan
    checks.append(Check("estimated pose, of the distance", relative, tolerances.pose))
    return Tracking(
        begin=float(log["time"][rows.start]),
        end=float(log["time"][end]),
        excused_cycles=int(excused.sum()),
        linear=axes[0],
        angular=axes[1],
        commanded_pose=_integrate(log, end),
        true_pose=true_pose,
        estimated_pose=estimated_pose,
        distance=distance,
        position_error=position_error,
        yaw_error=turned(estimated_pose.yaw - true_pose.yaw),
        checks=tuple(checks),
    )


def commanded_path(log: Log) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x, y [m] and yaw [rad], shape (rows,) each: where the limited command leads without any error.

    Exact arcs, ẋ = v cos θ, ẏ = v sin θ, θ̇ = ω, the command of row k over [t_k, t_k+1).
    """
    v, w = np.nan_to_num(log["limited_linear"][:-1]), np.nan_to_num(log["limited_angular"][:-1])
    dt = np.diff(log["time"])
    x, y, yaw = along_arcs(v * dt, w * dt).T
    return x, y, yaw


def _is_twist(log: Log, prefix: str, linear: float, angular: float) -> BoolArray:
    # A log rounds to float32; what differs by more is another command.
    off = np.abs([log[f"{prefix}_linear"] / linear - 1, log[f"{prefix}_angular"] / angular - 1])
    return np.asarray((off < np.finfo(np.float32).eps).all(axis=0))


def _integrate(log: Log, row: int) -> Pose:
    x, y, yaw = commanded_path(log)
    return Pose(float(x[row]), float(y[row]), turned(float(yaw[row])))


def _pose(log: Log, prefix: str, row: int) -> Pose:
    return Pose(*(float(log[f"{prefix}_{axis}"][row]) for axis in ("x", "y", "yaw")))


def _path_length(x: FloatArray, y: FloatArray) -> float:
    known = ~np.isnan(x) & ~np.isnan(y)
    return float(np.hypot(np.diff(x[known]), np.diff(y[known])).sum())
