"""Turns that load wheels behind each other most: on the spot and back, and around a wheel that nearly stands.

Floors are between slippery and sticky, joints have more and less friction than described, and encoders are coarse and
fine. The drive is a pure function of robot and seed.

A warning of `yaw_rate` is true, and no fault, if tyres slide by the truth: some robots turn faster than a slippery
floor allows.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from typing import Any

import numpy as np
from robot_control.loop.closed_loop import ClosedLoop
from robot_control.loop.signal_names import causes_in

from bench.drives.sensor_errors import plant_parameters
from bench.drives.wheel_command import for_drives
from bench.robot_corpus import urdf_of

GRAVITY = 9.81  # m/s²
GROUND = (0.3, 3.0)  # times friction 1, that of the scenes
JOINTS = (0.3, 3.0)  # times the described dry friction
COUNTS = (64, 90, 128, 256, 512, 1024, 2048, 4096)
SPARE = 0.8  # share of the torque limit that a turn may need; with more no loop turns the robot
REST, PHASE, PHASES = 1.0, 2.0, 5  # s
SLIDES, SLIDES_FOR, WINDOW = 0.8, 0.2, 0.05  # rad/s between wheels and body, s; s over which wheels are measured
LINEAR_LIMIT, ANGULAR_LIMIT = 1.0, 2.0  # m/s, rad/s: full speed of the default parameters


@dataclass(frozen=True)
class Turning:
    """Result of one seed. `causes`, `warnings`: names; empty if there were none."""

    robot: str
    seed: int
    friction: float
    joints: float  # times the described friction
    counts: int
    commands: tuple[tuple[float, float], ...]
    causes: tuple[str, ...]
    warnings: tuple[str, ...]
    worst: float  # rad/s between commanded and true yaw rate at the end of a phase; 0 on slippery ground

    @property
    def seconds(self) -> float:
        """Simulated time, s."""
        return REST + PHASE * len(self.commands)

    def __str__(self) -> str:
        what = f"{self.robot}, turns of seed {self.seed}, ground friction {self.friction:.2f}, "
        what += f"{self.joints:.2f} times the joints', {self.counts} counts"
        asked = ", ".join(f"({linear:.2f}, {angular:.2f})" for linear, angular in self.commands)
        return f"{what}, {asked}: stopped: {list(self.causes)}, warned: {list(self.warnings)}"


def _joint_friction(robot: str) -> float:
    """N·m, the largest friction in the description."""
    joints = ET.parse(urdf_of(robot)).iter("dynamics")
    return max((float(joint.get("friction", 0.0)) for joint in joints), default=0.0)


def _scrub(robot: dict[str, Any]) -> float:
    """N·m of the most loaded wheel in a turn at friction 1 (scrub.h); 0 if no wheel is behind another."""
    wheels = robot["wheels"]
    if len(wheels) == 2:
        return 0.0
    x = np.array([wheel["centre"][0] for wheel in wheels])
    x -= x.mean()
    along = (robot["effective_wheel_base"] - robot["wheel_base"]) / 2
    ahead = robot["centre_of_gravity"][0] - np.mean([wheel["centre"][0] for wheel in wheels])
    loads = robot["mass"] * GRAVITY / len(wheels) * (1 + ahead * x / np.mean(x**2))
    return float(np.max(wheels[0]["radius"] * loads * along / np.hypot(along, x)))


def draw_frictions(random: np.random.Generator, robot: str, loop: ClosedLoop) -> tuple[float, float]:
    """Friction of the ground, and of the joints relative to the description, with which the motors can still turn the
    robot.
    """
    scrub = _scrub(loop.robot)
    limits = {joint["name"]: joint["effort_limit"] for joint in loop.robot["joints"]}
    spare = SPARE * min(limits[wheel["joint"]] for wheel in loop.robot["wheels"])
    own = _joint_friction(robot)
    joints = _between(random, JOINTS, (spare - GROUND[0] * scrub) / own if own else JOINTS[1])
    return _between(random, GROUND, (spare - joints * own) / scrub if scrub else GROUND[1]), joints


def _between(random: np.random.Generator, ends: tuple[float, float], bound: float) -> float:
    """A value from a range, evenly by its logarithm, and at most `bound`."""
    return float(np.exp(random.uniform(np.log(ends[0]), np.log(np.clip(bound, *ends)))))


def draw(random: np.random.Generator, half_base: float) -> list[tuple[float, float]]:
    """Commands [m/s, rad/s]: turns on the spot and their reversals, and other curves. In some curves the inner wheel
    nearly stands, within a tenth of the outer one's speed.
    """
    commands: list[tuple[float, float]] = []
    while len(commands) < PHASES:
        angular = float(random.choice([-1, 1]) * ANGULAR_LIMIT * 10 ** random.uniform(-1.3, 0))
        kind = random.integers(3)
        if kind == 0:
            commands += [(0.0, angular), (0.0, -angular)]
        elif kind == 1:
            linear = float(random.choice([-1, 1]) * abs(angular) * half_base * random.uniform(0.8, 1.2))
            commands += [(float(np.clip(linear, -LINEAR_LIMIT, LINEAR_LIMIT)), angular)]
        else:
            commands += [(float(random.uniform(-1, 1)), angular)]
    return commands[:PHASES]


def slides(loop: ClosedLoop, log: dict[str, Any]) -> bool:
    """True if wheels, one a side, turn otherwise than the robot by more than SLIDES for SLIDES_FOR, by the truth."""
    wheels = loop.robot["wheels"]
    if len(wheels) > 2:
        return False
    window = round(WINDOW / loop.period)
    yaw = np.zeros(len(log["truth_yaw"]) - window)
    for wheel in wheels:
        travel = wheel["sign"] * wheel["radius"] * log[f"{wheel['joint']}_position"]
        yaw += (travel[window:] - travel[:-window]) * (1 if wheel["side"] == "right" else -1)
    rate = yaw / loop.robot["effective_wheel_base"] / (window * loop.period)
    true = np.convolve(log["truth_angular"], np.full(window, 1 / window), mode="valid")[1:]
    spans = np.lib.stride_tricks.sliding_window_view(np.abs(rate - true) > SLIDES, round(SLIDES_FOR / loop.period))
    return bool(spans.all(axis=1).any())


def carry_out(robot: str, seed: int, errors: str = "data_sheet", wheel_command: str = "torque") -> Turning:
    """Drives it with sensors that err as `errors` says, one of sensor_errors.LEVELS, and drives of `wheel_command`."""
    random = np.random.default_rng([seed, len(robot), sum(robot.encode())])
    urdf = urdf_of(robot)
    described = ClosedLoop(urdf=urdf)
    friction, joints = draw_frictions(random, robot, described)
    counts = int(random.choice(COUNTS))
    plant = {"ground_friction": friction, "wheel_friction_error": joints - 1, "encoder_resolution": counts}
    plant |= plant_parameters(errors)
    estimator = {"encoder_noise": 2 * np.pi / counts / 12**0.5}
    params = for_drives(wheel_command, {"mujoco_plant": plant, "state_estimator": estimator})
    loop = ClosedLoop(params, seed=seed, urdf=urdf)
    logs = [loop.run(REST, (0.0, 0.0))]
    commands = draw(random, loop.robot["effective_wheel_base"] / 2)
    logs += [loop.run(PHASE, command) for command in commands]
    last = round(0.5 / loop.period)
    yaw_errors = [
        abs(float(np.mean(log["truth_angular"][-last:])) - command[1])
        for log, command in zip(logs[1:], commands, strict=True)
    ]
    log = {name: np.concatenate([part[name] for part in logs]) for name in logs[0]}
    causes, warnings = (tuple(causes_in(log[name])) for name in ("permit_causes", "permit_warnings"))
    if warnings == ("yaw_rate",) and slides(loop, log):
        warnings = ()
    return Turning(robot, seed, friction, joints, counts, tuple(commands), causes, warnings, max(yaw_errors))
