"""Measures on the simulated machine how well a robot keeps the promises of its limits.

Each function drives robots of robot_corpus.py and gives `Figure`s: a value and the bound it must not exceed.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from math import radians
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from robot_control.loop.closed_loop import ClosedLoop, Log

from bench.drives.wheel_command import for_drives
from bench.robot_corpus import DIFFBOT, urdf_of

Array = NDArray[np.float64]

REST = 1.0  # s at rest before a drive
STEP = 0.1  # m/s, that the gate lets pass in one cycle
BAND = 0.01  # share of the speed; a speed within it has settled
SLOPES = (0.0, radians(5), -radians(5))  # uphill positive
GRAVITY = 9.81  # m/s²
CASTER = -0.25  # m, of diffbot's caster ahead of its axle
RIPPLE_START, RIPPLE_TIME, RIPPLE_TURN = 2.0, 4.0, 0.2  # s, s, rad/s
WEAK_SPEED, WEAK_TORQUE = 0.8, 0.6  # shares of a drive's speed and torque that saturated wheels have


@dataclass(frozen=True)
class Figure:
    """`value` and `bound` in `unit`."""

    name: str
    value: float
    bound: float
    unit: str

    @property
    def good(self) -> bool:
        """True within its bound; NaN is not."""
        return abs(self.value) <= self.bound


def make(robot: str, params: Mapping[str, Any] | None = None) -> ClosedLoop:
    """A loop at rest for `REST` seconds, `params` laid over the defaults. Sensors err as their data sheets say, because
    the figures are those of the control law.
    """
    plant = {"sensor_errors": "data_sheet", **(params or {}).get("mujoco_plant", {})}
    loop = ClosedLoop({**(params or {}), "mujoco_plant": plant}, urdf=urdf_of(robot))
    loop.run(REST, (0.0, 0.0))
    return loop


def mass_of(robot: str) -> float:
    """kg"""
    return float(ClosedLoop(urdf=urdf_of(robot)).robot["mass"])


def profile(log: Log) -> Array:
    """m/s, speed of an ideal robot at each sample: the torque of cycle k acts over [t_k+1, t_k+2)."""
    return np.concatenate([[0.0, 0.0], log["limited_linear"][:-2]])


def settled(speed: Array, target: float, band: float) -> int:
    """Cycle from which on `speed` stays within `band` of `target`."""
    outside = np.flatnonzero(np.abs(speed - target) > band)
    return int(outside[-1]) + 1 if outside.size else 0


@dataclass(frozen=True)
class Straight:
    """Of one drive 0 → v → 0; parts of |v|, at either end."""

    rms: float
    overshoot: float
    swing: float  # swing to the other side after it
    late: float  # s from the end of its profile until it has settled


def straight(robot: str, speed: float, payload: float = 0.0, params: Mapping[str, Any] | None = None) -> Straight:
    """0 → `speed` [m/s] → 0 with `payload` [kg] unknown to the controller; `params` over the defaults."""
    loop = make(
        robot, {**(params or {}), "mujoco_plant": {"payload": payload, **(params or {}).get("mujoco_plant", {})}}
    )
    phases = (loop.run(3.0, (speed, 0.0)), loop.run(3.0, (0.0, 0.0)))
    log = {name: np.concatenate([phase[name] for phase in phases]) for name in phases[0]}
    true, wanted = np.sign(speed) * log["truth_linear"], np.sign(speed) * profile(log)
    size = abs(speed)
    half = len(true) // 2
    over, back, late = [], [], []
    for part, target, sign in ((slice(0, half), size, 1), (slice(half, None), 0.0, -1)):
        beyond = sign * (true[part] - target) / size
        over.append(float(beyond.max()))
        back.append(-float(beyond[int(beyond.argmax()) :].min()))
        late.append(settled(true[part], target, BAND * size) - settled(wanted[part], target, BAND * size))
    rms = float(np.sqrt(np.mean((true - wanted) ** 2))) / size
    return Straight(rms, max(over), max(back), max(late) * loop.period)


def response_time(robot: str, plant: Mapping[str, Any]) -> float:
    """s from a step of the ordered speed to 63 % of it: robot.wheel_response_time of drives of speeds with these
    parameters of `mujoco_plant`.
    """
    params = {
        "diff_drive_controller": {"max_linear_acceleration": 100.0, "max_linear_jerk": 0.0},
        "robot": {"wheel_response_time": 0.001},  # hardly any lead
        "mujoco_plant": {**plant, "drive_feed_forward": False},
    }
    loop = make(robot, for_drives("velocity", params))
    log = loop.run(1.0, (STEP, 0.0))
    begin = int(np.flatnonzero(log["limited_linear"])[0])
    cycles = int(np.flatnonzero(log["truth_linear"] >= (1 - np.exp(-1)) * STEP)[0]) - begin
    return cycles * loop.period


def stop_error(
    robot: str, speed: float, slope: float, *, silence: bool, params: Mapping[str, Any] | None = None
) -> tuple[float, float]:
    """Stops from `speed` [m/s] on `slope` [rad], commanded or by `silence`; `params` over the defaults.

    Returns:
        True way less the predicted one, and the predicted one [m].
    """
    plant = {"slope": slope, **(params or {}).get("mujoco_plant", {})}
    loop = make(robot, {**(params or {}), "mujoco_plant": plant})
    loop.run(2.0, (speed, 0.0))
    log = loop.run(3.0, None if silence else (0.0, 0.0))
    start = int(np.flatnonzero(log["limited_linear"] != speed)[0])
    distance = float(np.hypot(log["truth_x"][-1] - log["truth_x"][start], log["truth_y"][-1] - log["truth_y"][start]))
    predicted = loop.stop_distance(speed, emergency=silence)
    return distance - predicted, predicted


def rims(loop: ClosedLoop, linear: float, angular: float) -> float:
    """rad/s of the fastest wheel at this twist [m/s, rad/s]."""
    robot = loop.robot
    half = 0.5 * robot["wheel_base"] * robot["wheel_base_multiplier"]
    return float((abs(linear) + half * abs(angular)) / robot["wheels"][0]["radius"])


def off_the_curve(log: Log, linear: float, angular: float) -> float:
    """Relative error of the driven radius, from turn and way over all of the log, against the commanded one."""
    distance, turn = np.sum(log["truth_linear"]), np.sum(log["truth_angular"])
    return float(distance / turn) / (linear / angular) - 1


def scrubs(loop: ClosedLoop) -> bool:
    """True if it has wheels behind each other: its turning then depends on the ground as much as on the wheels."""
    return len(loop.robot["wheels"]) > 2


def fast_curve(robot: str, linear: float, angular: float) -> float:
    """Relative error of the radius in a curve that is too fast for the wheels. Skid steers are compared with the radius
    of the fastest curve that is not too fast.

    Raises:
        RuntimeError: it was not too fast.
    """
    free = make(robot)
    weak = make(robot, {"robot": {"wheel_velocity_limit": WEAK_SPEED * rims(free, linear, angular)}})
    saturated = weak.run(6.0, (linear, angular))
    done = float(saturated["limited_linear"][-1]), float(saturated["limited_angular"][-1])
    if not abs(done[0]) <= WEAK_SPEED * abs(linear):
        raise RuntimeError(f"{robot}: no wheel was at its speed limit")
    off = off_the_curve(saturated, linear, angular)
    return (1 + off) / (1 + off_the_curve(free.run(6.0, done), *done)) - 1 if scrubs(free) else off


def weak_curve(robot: str, linear: float, angular: float) -> float:
    """Relative error of the radius in a curve whose ramp asks for more torque than the wheels have, against one that
    they can do. It does not apply to skid steers: the torque of their turning does not depend on the ramp.
    """
    full = make(robot)
    log = full.run(3.0, (linear, angular))
    names = [f"{wheel['joint']}_effort_command" for wheel in full.robot["wheels"]]
    ramp = log["time"] < log["time"][0] + 0.5
    needed = max(float(np.quantile(np.abs(log[name][ramp]), 0.9)) for name in names)
    weak = make(robot, {"robot": {"wheel_effort_limit": WEAK_TORQUE * needed}})
    saturated = weak.run(3.0, (linear, angular))
    return (1 + off_the_curve(saturated, linear, angular)) / (1 + off_the_curve(log, linear, angular)) - 1


def wheel_column(loop: ClosedLoop, log: Log, name: str) -> Array:
    """A column of every wheel, shape (wheels, cycles)."""
    return np.array([log[f"{wheel['joint']}_{name}"] for wheel in loop.robot["wheels"]])


def standstill(robot: str) -> tuple[float, float]:
    """RMS of the torque [N·m] about its mean on the level, and the way [m] in 20 s on a slope, hand-over included."""
    level = make(robot)
    level.run(1.5, (0.3, 0.0))
    level.run(1.5, (0.0, 0.0))
    torque = wheel_column(level, level.run(10.0, (0.0, 0.0)), "effort")
    slope = make(robot, {"mujoco_plant": {"slope": SLOPES[1]}})
    slope.run(1.5, (0.3, 0.0))
    slope.run(1.0, (0.0, 0.0))
    log = slope.run(20.0, (0.0, 0.0))
    distance = np.hypot(log["truth_x"] - log["truth_x"][0], log["truth_y"] - log["truth_y"][0])
    return float(torque.std(axis=1).max()), float(distance.max())


def released(robot: str, speed: float) -> tuple[float, float]:
    """Brakes for some cycles at `speed` [m/s] for want of commands, and releases the brake.

    Returns:
        By how much it still slows down after the release, part of the speed; the largest torque then, part of the
        brake's before it.

    Raises:
        RuntimeError: the brake did not act.
    """
    loop = make(robot)
    loop.run(2.0, (speed, 0.0))
    loop.inject_fault("controller", "off")
    braked = loop.run(0.012, (speed, 0.0))
    loop.inject_fault("controller", "ok")
    log = loop.run(2.0, (speed, 0.0))
    passes = int(np.flatnonzero(log["gate_verdict"] == 1)[0]) + 1
    brake = float(np.max(np.abs(wheel_column(loop, braked, "effort"))))
    if not log["truth_linear"][passes] < 0.99 * speed:
        raise RuntimeError(f"{robot}: the brake did not act")
    after = wheel_column(loop, log, "effort")[:, passes + 1 : passes + 200]
    dip = float(log["truth_linear"][passes] - log["truth_linear"][passes:].min()) / speed
    return dip, float(np.max(np.abs(after))) / brake


def lifted(robot: str) -> float:
    """rad/s by which a wheel is off its target while a push lifts the robot onto its caster.

    The push carries just more than the wheels do: the robot stands up slowly, its wheels 10 mm above the ground.
    """
    description = ClosedLoop(urdf=urdf_of(robot)).robot
    centre, caster = float(description["centre_of_gravity"][0]), CASTER
    carried = float(description["mass"]) * GRAVITY * (centre - caster) / -caster
    start = REST + 1.5
    loop = make(robot, {"mujoco_plant": {"push_z": 1.01 * carried, "push_start": start, "push_duration": 1.0}})
    loop.run(start - REST, (0.5, 0.0))
    log = loop.run(0.8, (0.5, 0.0))
    if not np.max(log["truth_tilt"]) > 0.02:
        raise RuntimeError(f"{robot}: it was not lifted")
    error = wheel_column(loop, log, "velocity_measured") - wheel_column(loop, log, "velocity_command")
    return float(np.max(np.abs(error)))


def coarse(counts: int) -> dict[str, Any]:
    """Parameters of an encoder of `counts` a turn, which are known to the estimator."""
    return {
        "mujoco_plant": {"encoder_resolution": counts},
        "state_estimator": {"encoder_noise": 2 * np.pi / counts / 12**0.5},
    }


@dataclass(frozen=True)
class Steady:
    """Means over `RIPPLE_TIME` in a steady curve."""

    ripple: float  # RMS of the wheels' torque about its mean, part of its limit, the worst wheel's
    off: float  # mean linear speed, part of the commanded


def steady_curve(robot: str, counts: int, linear: float) -> Steady:
    """`linear` [m/s] with `RIPPLE_TURN`, after `RIPPLE_START`."""
    loop = make(robot, coarse(counts))
    loop.run(RIPPLE_START, (linear, RIPPLE_TURN))
    log = loop.run(RIPPLE_TIME, (linear, RIPPLE_TURN))
    limits = {joint["name"]: joint["effort_limit"] for joint in loop.robot["joints"]}
    shares = [float(np.std(log[f"{wheel['joint']}_effort"])) / limits[wheel["joint"]] for wheel in loop.robot["wheels"]]
    return Steady(max(shares), float(np.mean(log["truth_linear"])) / linear - 1)


def of_the_peer() -> tuple[float, float]:
    """Makes the two drives of diff_drive_controller's own test: 10 s at 0.1 m/s, and 10 s at π/10 rad/s; then a stop.
    The robot has that test's radius and separation.

    Returns:
        Way less 1 m [m], turn less half a turn [rad].
    """
    text = Path(urdf_of(DIFFBOT)).read_text()
    for own, of_peer in (('radius="0.1"', 'radius="0.11"'), ('<sphere radius="0.04"/>', '<sphere radius="0.05"/>')):
        text = text.replace(own, of_peer)  # the caster's centre stays, so it reaches as far down as the wheels
    with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
        file.write(text)
        file.flush()
        ahead, around = (
            ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}}, urdf=file.name) for _ in range(2)
        )
    around.run(REST, (0.0, 0.0))
    start = ahead.run(REST, (0.0, 0.0))
    ahead.run(10.0, (0.1, 0.0))
    end = ahead.run(2.0, (0.0, 0.0))
    distance = float(np.hypot(end["truth_x"][-1] - start["truth_x"][-1], end["truth_y"][-1] - start["truth_y"][-1]))
    logs = [around.run(10.0, (0.0, np.pi / 10)), around.run(2.0, (0.0, 0.0))]
    yaw = np.unwrap(np.concatenate([log["truth_yaw"] for log in logs]))
    return distance - 1.0, float(yaw[-1] - yaw[0]) - np.pi
