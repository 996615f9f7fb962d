"""Drives random sets of limits, gains and feed-forward that set_parameters accepts.

None makes a robot exceed the commanded speed by much, or shake without a cause.

A set is drawn around derived and described values, so widely that most sets are refused; the first accepted one is
driven. It is set at rest or in motion, and the robot then drives on and stops. The drive is a pure function of the
seed, which also selects the robot: ROBOTS[seed mod their number].

    exceeds    a true speed beyond the commanded one, or below rest, by 5 % of it, at least MIN_EXCESS, for 50 ms
               without a break; where 0 is commanded, by 20 % of the fastest rim's. On skid steers, whose treads scrub,
               the mean of the wheels over 50 ms counts
    shakes     a motor whose torque varies within 0.2 s by more than SHAKES of its limit, RMS, all of the last half
               second, while the monitor neither stops nor warns

Motion after a stop by the monitor does not count. Neither does motion of the same drive with the same limits and
derived gains: tyres and suspension follow steep limits in that way. A set may add to it no more than the tolerance. A
drive whose limits alone shake it, or exceed by more than the tolerance, is counted as such.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from robot_control._robot_control import ParameterError
from robot_control.loop.closed_loop import ClosedLoop, Log
from robot_control.loop.signal_names import causes_in

from bench.robot_corpus import DIFFBOT, robot_names, urdf_of
from bench.rows import Result, Say, plain
from bench.runs.runner import Processes, Runner

ROBOTS = (DIFFBOT, "kobuki", "boxer", "jackal", "pmb2")
ALL_RUNS = 100_000
PART = 0.05
ASIDE = 0.2  # share of the fastest rim's speed, along an axis that is to stand
MIN_EXCESS = 0.2  # m/s of a rim
EXCESS_TIME = 0.05  # s
SHAKES = 0.6  # share of the torque limit: 0.3 plus the effect of the encoders' counts on these robots
BEFORE, DRIVEN, STOPPING = 0.5, 1.5, 0.7  # s
DRAWS = 200  # refused sets in a row after which the seed is given up

GAINS = {"pid_kp": 100.0, "pid_ki": 100.0, "tracking_bandwidth": 20.0}  # factors of the drawn range, either way
FORWARD = {"mass": 6.0, "yaw_inertia": 12.0, "wheel_inertia": 40.0}
LIMITS = {
    "max_linear_speed": (0.05, 1.2),
    "max_angular_speed": (0.1, 2.5),
    "max_linear_acceleration": (0.1, 4.0),
    "max_angular_acceleration": (0.3, 12.0),
    "max_linear_deceleration": (0.1, 4.0),
    "max_angular_deceleration": (0.3, 12.0),
    "max_linear_jerk": (1.0, 1000.0),
    "max_angular_jerk": (4.0, 4000.0),
}  # SI units
EMERGENCY = {"max_linear_emergency_deceleration": 4.0, "max_angular_emergency_deceleration": 12.0}


@dataclass(frozen=True)
class Tuned:
    """Result of one seed. `values`: the set that was driven; empty if every drawn set was refused."""

    robot: str
    seed: int
    values: dict[str, Any] = field(default_factory=dict)
    refused: int = 0
    faults: tuple[str, ...] = ()
    faults_of_limits: tuple[str, ...] = ()
    causes: tuple[str, ...] = ()

    def __str__(self) -> str:
        return (
            f"seed {self.seed}: {self.robot}, {self.values}: {'; '.join(self.faults) or 'nothing amiss'}\n"
            f"    again: scripts/bench tuning --first {self.seed} --runs 1"
        )


def draw(random: np.random.Generator, derived: Log, joint: str, effort_limit: float, speed: float) -> dict[str, Any]:
    """Draws a set; `derived`: a row of the log, `joint`: a wheel's; `effort_limit` N m and `speed` rad/s are limits."""

    def times(factor: float) -> float:
        return float(np.exp(random.uniform(-np.log(factor), np.log(factor))))

    def between(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    values: dict[str, Any] = {}
    forward: dict[str, float] = {}
    for name, bound in GAINS.items():
        if random.random() < 0.3:
            column = name if name == "tracking_bandwidth" else f"{joint}_{name}"
            values[name] = float(derived[column][0]) * times(bound)
    if random.random() < 0.1:
        values["pid_kd"] = float(derived[f"{joint}_pid_kp"][0]) * between(1e-5, 1e-2)
    for name, bound in FORWARD.items():
        if random.random() < 0.2:
            column = f"{joint}_feed_forward_inertia" if name == "wheel_inertia" else f"feed_forward_{name}"
            forward[name] = float(derived[column][0]) * times(bound)
    if random.random() < 0.2:
        forward["wheel_damping"] = effort_limit / speed * between(1e-3, 10)
    if random.random() < 0.2:
        forward["wheel_friction"] = effort_limit * between(1e-3, 3)
    for name, (low, high) in LIMITS.items():
        if random.random() < 0.15:
            values[name] = between(low, high)
    if any("acceleration" in name or "deceleration" in name for name in values):
        values |= EMERGENCY
    if random.random() < 0.2:
        values["keep_curvature"] = bool(random.random() < 0.5)
    if forward:
        values["feed_forward"] = forward
    return values or {"pid_kp": float(derived[f"{joint}_pid_kp"][0]) * times(3)}


def longest_excess(speed: NDArray[np.float64], bound: float, back: float, cycles: int) -> float:
    """By how much `speed` exceeds `bound`, or falls below −`back`, for `cycles` in a row; at most 0: never."""
    windows = np.lib.stride_tricks.sliding_window_view(np.maximum(speed - bound, -speed - back), cycles)
    return float(windows.min(axis=1).max(initial=-np.inf))


def shaking(effort: NDArray[np.float64], cycles: int) -> float:
    """RMS of a torque without its mean over `cycles`."""
    mean = np.convolve(effort, np.full(cycles, 1 / cycles), mode="valid")
    inner = effort[cycles // 2 : cycles // 2 + len(mean)]
    return float(np.sqrt(np.mean((inner - mean) ** 2)))


def carry_out(robot: str, seed: int) -> Tuned:
    """Sets and drives one set."""
    random = np.random.default_rng([seed, ROBOTS.index(robot)])
    motion = _Motion(robot, seed, random)
    limits = {joint["name"]: joint["effort_limit"] for joint in motion.loop.robot["joints"]}
    limit, speed = limits[motion.wheels[0]], (1.0 + 2.0 * motion.rim) / motion.loop.robot["wheels"][0]["radius"]
    values, refused = _taken(motion.loop, lambda: draw(random, motion.before, motion.wheels[0], limit, speed))
    if not values:
        return Tuned(robot, seed, refused=refused)
    judged = motion.judge()
    if not judged.faults({}):
        return Tuned(robot, seed, values, refused, causes=judged.causes)
    derived = _Motion(robot, seed, np.random.default_rng([seed, ROBOTS.index(robot)]))
    if same := {name: value for name, value in values.items() if name in {*LIMITS, *EMERGENCY, "keep_curvature"}}:
        derived.loop.set_parameters(same)
    usual = derived.judge()
    return Tuned(robot, seed, values, refused, judged.faults(usual.shares), tuple(usual.faults({})), judged.causes)


@dataclass(frozen=True)
class Judged:
    """One motion. `shares`: each kind of fault as a share of its tolerance, with a description."""

    shares: dict[str, tuple[float, str]]
    causes: tuple[str, ...]

    def faults(self, usual: dict[str, tuple[float, str]]) -> tuple[str, ...]:
        """Descriptions of all that exceeds its tolerance, and the `usual` share by as much."""
        return tuple(
            text for kind, (share, text) in self.shares.items() if share > 1 + max(0.0, usual.get(kind, (0.0, ""))[0])
        )


class _Motion:
    """A robot stands or drives, drives on, and stops; `random` selects the motion."""

    def __init__(self, robot: str, seed: int, random: np.random.Generator) -> None:
        errors = {"sensor_errors": "data_sheet"}  # gains and limits are judged, not what shakes the IMU
        self.loop = ClosedLoop({"mujoco_plant": errors}, seed=seed, urdf=urdf_of(robot))
        self.wheels = [wheel["joint"] for wheel in self.loop.robot["wheels"]]
        self.rim = self.loop.robot["effective_wheel_base"] / 2  # m
        on_the_way = bool(random.random() < 0.5)
        kind = random.integers(3)
        share = 10 ** random.uniform(-1, 0) if random.random() < 0.5 else 1.0
        linear, angular = (share * part for part in ((1.0, 0.0), (0.0, 2.0), (0.5, 1.0))[kind])
        self.command = (linear, angular)
        self.before = self.loop.run(BEFORE, self.command if on_the_way else (0.0, 0.0))

    def judge(self) -> Judged:
        """Drives and judges the rest of the motion."""
        driven = self.loop.run(DRIVEN, self.command)
        stopping = self.loop.run(STOPPING, (0.0, 0.0))
        limits = {joint["name"]: joint["effort_limit"] for joint in self.loop.robot["joints"]}
        shares = _exceeds(self.loop, driven, stopping, self.command, self.rim)
        shares |= _shakes(self.loop, driven, self.wheels, limits)
        causes = causes_in(np.concatenate([driven["permit_causes"], stopping["permit_causes"]]))
        return Judged(shares, tuple(causes))


def _taken(loop: ClosedLoop, draw_one: Callable[[], dict[str, Any]]) -> tuple[dict[str, Any], int]:
    """The first set that is accepted, and the number of refused ones before."""
    for refused in range(DRAWS):
        values = draw_one()
        try:
            loop.set_parameters(values)
        except ParameterError:
            continue
        return values, refused
    return {}, DRAWS


def _exceeds(
    loop: ClosedLoop, driven: Log, stopping: Log, command: tuple[float, float], rim: float
) -> dict[str, tuple[float, str]]:
    shares = {}
    cycles = max(1, round(EXCESS_TIME / loop.period))
    fastest = abs(command[0]) + rim * abs(command[1])
    stops = np.concatenate([driven["permit_causes"], stopping["permit_causes"]]) > 0
    good = int(np.argmax(stops)) if stops.any() else len(stops)
    speeds = _speeds(loop, [driven, stopping], cycles)
    for name, asked, scale in (("linear", command[0], 1.0), ("angular", command[1], rim)):
        speed = speeds[name][:good]
        tolerance = max(PART * abs(asked) * scale if asked else ASIDE * fastest, MIN_EXCESS) / scale
        if len(speed) < cycles:
            continue
        for side, bound, back in (("beyond", asked, np.inf), ("below", np.inf, 0.0)):
            excess = longest_excess(speed, bound, back, cycles)
            text = f"{name} speed {side} {asked if side == 'beyond' else 0:.3g} by {excess:.3g} for {EXCESS_TIME} s"
            shares[f"{name} {side}"] = (excess / tolerance, text)
    return shares


def _speeds(loop: ClosedLoop, logs: list[Log], cycles: int) -> dict[str, NDArray[np.float64]]:
    """Linear [m/s] and angular [rad/s] speed: true; on skid steers by the wheels, over `cycles`."""
    wheels = loop.robot["wheels"]
    if len(wheels) == 2:
        return {name: np.concatenate([log[f"truth_{name}"] for log in logs]) for name in ("linear", "angular")}
    rims: dict[str, list[NDArray[np.float64]]] = {"left": [], "right": []}
    for wheel in wheels:
        travel = wheel["sign"] * wheel["radius"] * np.concatenate([log[f"{wheel['joint']}_position"] for log in logs])
        moved = np.concatenate([np.zeros(cycles), travel[cycles:] - travel[:-cycles]])
        rims[wheel["side"]].append(moved / (cycles * loop.period))
    left, right = (np.mean(rims[side], axis=0) for side in ("left", "right"))
    return {"linear": (left + right) / 2, "angular": (right - left) / loop.robot["effective_wheel_base"]}


def _shakes(loop: ClosedLoop, driven: Log, wheels: list[str], limits: dict[str, float]) -> dict[str, tuple[float, str]]:
    last = round(0.5 / loop.period)
    if np.any(driven["permit_causes"] > 0) or np.any(driven["permit_warnings"][-last:] > 0):
        return {}
    shares = {
        name: shaking(driven[f"{name}_effort"][-last:], round(0.2 / loop.period)) / limits[name] for name in wheels
    }
    return {name: (share / SHAKES, f"{name} shakes with {share:.2f} of its torque") for name, share in shares.items()}


def robot_of(seed: int) -> str:
    """The robot of `seed`."""
    return ROBOTS[seed % len(ROBOTS)]


def _one(seed: int) -> Tuned:
    return carry_out(robot_of(seed), seed)


def bench(first: int, runs: int, say: Say, runner: Runner | None = None) -> Result:
    """Runs `runs` seeds from `first` on, except those of absent robots; returns the table, and whether there was no
    fault.
    """
    began = time.monotonic()
    present = robot_names()
    seeds = [seed for seed in range(first, first + runs) if robot_of(seed) in present]
    driven = refused = amiss = stopped = of_limits = 0
    runner = runner or Processes()
    for outcome in runner.outcomes(_one, seeds, say, chunk=8):
        driven += bool(outcome.values)
        refused += outcome.refused
        stopped += bool(outcome.causes)
        of_limits += bool(outcome.faults_of_limits)
        if outcome.faults:
            amiss += 1
            say(str(outcome))
    figures = [
        ("sets driven", driven, ""),
        ("sets refused", refused, ""),
        ("sets stopped by the monitor", stopped, ""),
        ("sets amiss with derived gains, too", of_limits, ""),
        ("sets amiss", amiss, ""),
        ("speed", len(seeds) / (time.monotonic() - began), "sets per s"),
    ]
    rows = [plain(*figure) for figure in figures]
    absent = [robot for robot in ROBOTS if robot not in present]
    return {"bench": "tuning", "rows": rows, "not_judged": absent}, amiss == 0 and driven == len(seeds) > 0
