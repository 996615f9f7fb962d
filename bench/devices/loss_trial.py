"""One loss behind simulated drives at full speed, in virtual time, and what it may do.

The robot rests, and drives at `SPEED`. At a random time a drive or the cable fails, while the request for motion goes
on. After `LOSS_TIME` the fault ends, then the request. The operator resets until the drives are ready. A new request
follows.

    seen     the driver reports the loss within `LATEST` of its kind
    brake    the gate brakes within `BRAKE_CYCLES` after that
    latch    the stop is latched with the cause driver_fault
    pose     while the drives come back, the estimate moves in no `JUMP_TIME` by more than `MAX_JUMP` beyond the truth,
             unless towards it; the truth stays within `DEVIATIONS` of it
    torque   from `STEADY_TIME` after the brake on, the robot does not become faster. A RoboClaw without supply brakes
             when it is switched on again
    release  it stands between the reset and the new request: each side, over `JUMP_TIME`. A brake answers one count of
             an encoder with a jerk of milliseconds
    drives   after the new request it reaches its speed
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from robot_control import ClosedLoop
from robot_control.installed_files import share_file
from robot_control.loop.closed_loop import Log
from robot_control.loop.signal_names import mask_of

from bench.faults.sequence_judge import BRAKE, STOPPED_STATES

BOARD, ROBOCLAW = "board", "roboclaw"
SERIAL = {BOARD: "torque", ROBOCLAW: "velocity"}
"""The wheel commands of boards on a serial line."""
CABLE = "cable"
EVERY_DIALECT = {  # s, by the driver's own promises: 20 missing samples, or a heartbeat of 0.1 s with what follows it
    CABLE: 0.025,
    "off": 0.025,
    "reset": 0.025,
    "other_zero": 0.005,
    "released": 0.15,
    "encoder": 0.15,
    "under_voltage": 0.15,
}
VESC = {CABLE: 0.025, "off": 0.025, "reset": 0.025, "other_zero": 0.005, "under_voltage": 0.15}
"""s; a release shows as soon as the order needs a current, which that of an even drive does not"""
LATEST = {"odrive": EVERY_DIALECT, "cia402": EVERY_DIALECT, "vesc": VESC}
DIALECTS = tuple(LATEST)
SERIAL_LATEST = {
    BOARD: {CABLE: 0.016, "stalled": 0.016, "off": 0.016, "reset": 0.016, "brown_out": 0.016, "fault": 0.005},
    ROBOCLAW: {CABLE: 0.105, "stalled": 0.105, "off": 0.105, "reset": 0.105, "brown_out": 0.105, "fault": 0.06},
}
"""s, by 12 missing reports; by 100 ms without counts, and a status in 24 exchanges"""
SPEED = 1.0  # m/s, the default limit
BRAKE_CYCLES = 5
REST_TIME = 2.0  # s, in which the gyro's bias is learned; a later rest would correct the pose by it
LOSS_TIME = 3.0  # s
STEADY_TIME = 1.0  # s, in which a light robot has fallen back on its casters
FASTER = 0.02  # m/s, tolerance
STANDING = 0.01  # m/s
RESETS = 20
JUMP_TIME = 0.1  # s
MAX_JUMP = {True: 0.05, False: 0.01}  # m, where both drives were lost, and one
DEVIATIONS = 5  # of a proof: one error in 1.7 million

DRIVER_FAULT = mask_of("StopCause", "driver_fault")

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LossTrial:
    """A loss of this kind at one seed."""

    dialect: str
    kind: str
    seed: int


@dataclass(frozen=True)
class Outcome:
    """The cycles until the loss was seen, those from there to the brake, and the rules that were broken."""

    seen: int
    brake: int
    broken: tuple[str, ...]


def robot_behind(
    dialect: str,
    seed: int,
    board_rate: float = 1000.0,
    safety: dict[str, Any] | None = None,
    wheel_command: str | None = None,
) -> ClosedLoop:
    """A robot behind such drives; behind a board it runs at `board_rate` in Hz. `safety`: of `safety_monitor`."""
    robot: dict[str, Any] = {"wheel_command": wheel_command or SERIAL.get(dialect, "torque")}
    if dialect in SERIAL:
        robot |= {"driver": dialect, "rate": board_rate}
    drives = share_file(f"config/drives/{dialect}.yaml")
    return ClosedLoop({"robot": robot, "safety_monitor": safety or {}}, seed=seed, drives=drives)


def latest(trial: LossTrial) -> float:
    """s, from the loss until the driver reports it."""
    return (LATEST | SERIAL_LATEST)[trial.dialect][trial.kind]


def first(condition: NDArray[np.bool_]) -> int:
    """The first cycle in which it holds; the number of cycles if there is none."""
    return int(np.argmax(condition)) if condition.any() else len(condition)


def speed_of(log: Log, wheel_base: float) -> Array:
    """m/s, of the faster side; `wheel_base` is in m."""
    speed: Array = np.abs(log["truth_linear"]) + np.abs(log["truth_angular"]) * wheel_base / 2
    return speed


def mean_speed(log: Log, wheel_base: float, cycles: int, period: float) -> float:
    """m/s, of the faster side in its fastest span of so many cycles; `wheel_base` is in m, `period` in s."""
    yaw = np.unwrap(log["truth_yaw"])
    turned = np.abs(yaw[cycles:] - yaw[:-cycles]) * wheel_base / 2
    return float(np.max(moved([log], "truth", cycles) + turned)) / (cycles * period)


def moved(logs: list[Log], source: str, cycles: int) -> Array:
    """m, in each span of so many cycles; `source` is estimate or truth."""
    x, y = (np.concatenate([log[f"{source}_{axis}"] for log in logs]) for axis in "xy")
    distances: Array = np.hypot(x[cycles:] - x[:-cycles], y[cycles:] - y[:-cycles])
    return distances


def error_growth(logs: list[Log], cycles: int) -> Array:
    """m, by which the error of the estimated position grows in each span of so many cycles."""
    x, y = (np.concatenate([log[f"estimate_{axis}"] - log[f"truth_{axis}"] for log in logs]) for axis in "xy")
    errors: Array = np.hypot(x, y)
    grown: Array = errors[cycles:] - errors[:-cycles]
    return grown


def error(log: Log) -> float:
    """m, of the estimated position at the end."""
    return float(np.hypot(*(log[f"estimate_{axis}"][-1] - log[f"truth_{axis}"][-1] for axis in "xy")))


def deviation(log: Log) -> float:
    """m, of the estimated position at the end."""
    return float(np.sqrt(sum(log[f"estimate_{axis}_variance"][-1] for axis in "xy")))


def seen_in(log: Log) -> NDArray[np.bool_]:
    """Cycles in which the driver reports a fault."""
    drives = [log[name] for name in log if name.endswith("_joint_fault")]
    seen: NDArray[np.bool_] = np.any([log["faults"], *drives], axis=0)
    return seen


def run_trial(trial: LossTrial) -> Outcome:
    """Runs one trial."""
    random = np.random.default_rng(trial.seed)
    loop = robot_behind(trial.dialect, trial.seed)
    request = (random.choice((SPEED, -SPEED)), 0.0)
    loop.run(REST_TIME, (0.0, 0.0))
    loop.run(random.uniform(2.5, 3.5), request)
    joint = random.choice([wheel["joint"] for wheel in loop.robot["wheels"]])
    if trial.dialect in SERIAL:
        component = "line" if trial.kind in (CABLE, "stalled") else "board"
        kind = "cut" if trial.kind == CABLE else trial.kind
    else:
        component, kind = ("bus", "off") if trial.kind == CABLE else (joint, trial.kind)
    loop.inject_fault(component, kind)
    log = loop.run(LOSS_TIME, request)
    loop.inject_fault(component, "ok")
    seen = first(seen_in(log))
    brake = first(log["gate_verdict"] == BRAKE)
    return Outcome(seen, brake - seen, tuple(broken_rules(trial, loop, log, request)))


def broken_rules(trial: LossTrial, loop: ClosedLoop, log: Log, request: tuple[float, float]) -> Iterator[str]:
    """Yields the rules that the loss and the way back break."""
    period, base = loop.period, loop.robot["wheel_base"]
    span = round(JUMP_TIME / period)
    seen = first(seen_in(log))
    brake = first(log["gate_verdict"] == BRAKE)
    if seen * period > latest(trial):
        yield "seen"
    if brake > seen + BRAKE_CYCLES:
        yield "brake"
    if log["supervisor_state"][-1] not in STOPPED_STATES or not int(log["permit_causes"][-1]) & DRIVER_FAULT:
        yield "latch"
    brakes_late = STEADY_TIME if (trial.dialect, trial.kind) == (ROBOCLAW, "off") else 0.0
    after = loop.run(1.0 + brakes_late, request)
    parts = (log, brake + round(STEADY_TIME / period)), (after, round(brakes_late / period))
    steady = np.concatenate([speed_of(part, base)[begin:] for part, begin in parts])
    if np.any(steady > np.minimum.accumulate(steady) + FASTER):
        yield "torque"
    back = [after]
    for _ in range(RESETS):
        back.append(loop.run(0.5, (0.0, 0.0)))
        if back[-1]["supervisor_state"][-1] not in STOPPED_STATES:
            break
        loop.e_stop_reset()
    beyond = np.minimum(moved(back, "estimate", span) - moved(back, "truth", span), error_growth(back, span))
    jump = MAX_JUMP[trial.kind == CABLE or trial.dialect in SERIAL]
    if beyond.max() > jump or error(back[-1]) > DEVIATIONS * deviation(back[-1]):
        yield "pose"
    if mean_speed(loop.run(1.0), base, span, period) > STANDING:
        yield "release"
    if abs(loop.run(3.0, request)["truth_linear"][-1]) < 0.98 * SPEED:
        yield "drives"
