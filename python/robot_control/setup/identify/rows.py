"""Selects the cycles of a log that describe the machine: driven ones, by the wheels' own torque, with grip."""

import itertools
from collections.abc import Sequence

import numpy as np

from robot_control.data.run_log import BoolArray, FloatArray, Log, joint_names, last
from robot_control.loop.signal_names import causes_in, mask_of, number_of

EFFORT_MODE = number_of("JointMode", "effort")
UNCHANGED = tuple(number_of("GateVerdict", name) for name in ("passed", "held"))
SATURATED = mask_of("CommandReason", "saturated")
CLAMPED = mask_of("GateReason", "effort_clamped", "rate_clamped", "speed_clamped", "position_clamped")
SLIP = mask_of("StateFlag", "slip")
SLIP_SHARE = 0.2
"""Largest share of slip among the driven cycles; a bump alone does not exceed it."""
CLAMPED_SHARE = 0.02
"""Largest share of clamped cycles among the driven ones."""


class UnfitError(ValueError):
    """The log cannot be used; the message names the reason and the remedy."""


def fit_rows(log: Log, joints: Sequence[str]) -> tuple[list[slice], float]:
    """Stretches of consecutive rows in which every wheel follows the controller, and the period [s].

    Raises:
        UnfitError: another robot's log, nothing driven, slip, saturation.
    """
    missing = [joint for joint in joints if f"{joint}_effort_command" not in log]
    if missing:
        what = f"the log is from another robot: it has no joint {', '.join(missing)}, but {', '.join(joint_names(log))}"
        raise UnfitError(f"{what}; set the parameters of this log")
    cycle, time = log["cycle"], log["time"]
    if len(cycle) < 2:
        raise UnfitError("the log has no two cycles: drive first")
    period = float((time[-1] - time[0]) / (cycle[-1] - cycle[0]))

    driven = _driven(log, joints)
    if not driven.any():
        raise UnfitError(f"the robot did not drive in this log: {_why_not(log)}")
    moving = driven & _any_wheel_planned(log, joints)
    if not moving.any():
        raise UnfitError("only zero was requested: drive ramps and turns, or use this tool")
    for joint in joints:
        effort = log[f"{joint}_effort"][moving]
        if np.ptp(effort) == 0:
            what = f"{joint}: its measured effort is {effort[0]:g} N·m throughout: the driver does not measure it"
            raise UnfitError(f"{what}; set it to report at least the commanded effort")
    clamped = driven & (_bits(log, "gate_reasons", CLAMPED) | _bits(log, "command_reasons", SATURATED))
    _refuse(
        clamped & moving,
        moving,
        CLAMPED_SHARE,
        "torque or speed of a wheel was at its limit",
        "reduce --max-speed, max_linear_acceleration and max_angular_acceleration; if the wheels oscillate, drive with "
        "half of pid_kp and a quarter of pid_ki",
    )
    slipping = _bits(log, "estimate_flags", SLIP)
    remedy = "drive on firm ground, and reduce max_linear_acceleration and max_angular_acceleration"
    _refuse(slipping & moving, moving, SLIP_SHARE, "the wheels slipped", remedy)
    return _stretches(driven & ~clamped & ~slipping, cycle), period


def _driven(log: Log, joints: Sequence[str]) -> BoolArray:
    driven: BoolArray = np.isin(log["gate_verdict"], UNCHANGED)
    for joint in joints:
        driven &= log[f"{joint}_mode"] == EFFORT_MODE
        for column in ("position", "effort", "effort_command", "velocity_command"):
            driven &= np.isfinite(log[f"{joint}_{column}"])
    return driven


def _any_wheel_planned(log: Log, joints: Sequence[str]) -> BoolArray:
    return np.asarray(np.any([log[f"{joint}_velocity_command"] != 0 for joint in joints], axis=0))


def _bits(log: Log, column: str, bits: int) -> BoolArray:
    return np.asarray((np.nan_to_num(log[column]).astype(np.int64) & bits) != 0)


def _refuse(bad: BoolArray, considered: BoolArray, share: float, what: str, remedy: str) -> None:
    found = bad.sum() / considered.sum()
    if found > share:
        raise UnfitError(f"{what} in {found:.0%} of the driven cycles, {share:.0%} are allowed: {remedy}")


def _why_not(log: Log) -> str:
    causes = causes_in(log["permit_causes"])
    if causes:
        return (
            f"the safety monitor had stopped the robot: {', '.join(causes)}; remove the cause, then call e_stop_reset"
        )
    if last(log["requests_received"]) == 0:
        return "nothing arrived on cmd_vel"
    return "the driver applied no command; check: rosrun robot_control why.py"


def _stretches(good: BoolArray, cycle: FloatArray) -> list[slice]:
    breaks = np.flatnonzero(~(good[1:] & good[:-1] & (np.diff(cycle) == 1))) + 1
    edges = [0, *breaks.tolist(), len(good)]
    return [slice(a, b) for a, b in itertools.pairwise(edges) if b - a > 1 and good[a]]
