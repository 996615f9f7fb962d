"""The slip runs of the benchmark: wheels spin, lock and slide between stretches of normal grip.

The controller's limits are raised to 8 m/s², more than any of this ground carries and than the motors give. The
commands themselves ramp gentle stretches. The safety monitor, which would stop such driving, only watches.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bench.odometry.program import Program

KINDS = ("straight", "turns", "patches", "one side", "kerbs", "wall")
SECONDS = 60.0
GRAVITY = 9.81

# m/s², rad/s²; without a jerk limit the motors give all they can.
HARD_LIMITS: dict[str, Any] = {
    "max_linear_acceleration": 8.0,
    "max_angular_acceleration": 32.0,
    "max_linear_emergency_deceleration": 8.0,
    "max_angular_emergency_deceleration": 32.0,
    "max_linear_jerk": 0.0,
    "max_angular_jerk": 0.0,
}
SILENT = (
    "wheel_speed",
    "wheel_acceleration",
    "torque_oscillation",
    "stall",
    "runaway",
    "wrong_direction",
    "not_stopping",
    "yaw_rate",
    "impact",
)
SAFETY: dict[str, Any] = {name: {"reaction": "off"} for name in (*SILENT, "tip_over", "tilt", "free_fall", "power")}


def slip_world(kind: str, random: np.random.Generator) -> str:
    """MJCF text of the ground."""
    shapes = []
    slippery = random.uniform(0.05, 0.3)
    floor = slippery if kind in {"straight", "turns"} else random.uniform(0.2, 0.5) if kind == "wall" else 1.0
    if kind == "patches":
        shapes = [_patch(i, random, random.uniform(0.5, 2.0), random.uniform(0.5, 2.0)) for i in range(60)]
    if kind == "one side":  # strips of ice along x, as wide as the wheels are apart
        shapes = [
            f'<geom name="friction/strip{i}" type="box" size="30 0.25 0.01" pos="0 {0.25 + i} 0" contype="0" '
            f'conaffinity="0" friction="{random.uniform(0.05, 0.2):.3f} 0.005 0.0001"/>'
            for i in range(-15, 16)
        ]
    if kind == "kerbs":
        shapes = [_patch(i, random, random.uniform(0.3, 1.0), random.uniform(0.3, 1.0)) for i in range(30)]
        for i in range(25):
            height, angle = random.uniform(0.005, 0.02), random.uniform(0, np.pi)
            x, y = random.uniform(-5, 5, 2)
            shapes.append(
                f'<geom name="kerb{i}" type="cylinder" size="0.05 {random.uniform(0.2, 1.0):.3f}" '
                f'pos="{x:.3f} {y:.3f} {height - 0.05:.4f}" zaxis="{np.cos(angle):.5f} {np.sin(angle):.5f} 0" '
                f'friction="{floor:.3f} 0.005 0.0001"/>'
                if np.hypot(x, y) > 0.8
                else ""
            )
    if kind == "wall":
        shapes = [
            '<geom name="ahead" type="plane" size="1 9 1" pos="1.2 0 1" zaxis="-1 0 0" friction="0.5 0.005 0.0001"/>'
        ]
    return (
        '<mujoco model="slip"><worldbody>'
        f'<geom name="floor" type="plane" size="50 50 1" friction="{floor:.3f} 0.005 0.0001"/>'
        f'{"".join(shapes)}<site name="start" pos="0 0 0"/></worldbody></mujoco>'
    )


def _patch(number: int, random: np.random.Generator, length: float, width: float) -> str:
    x, y = random.uniform(-8, 8, 2)
    return (
        f'<geom name="friction/patch{number}" type="box" size="{length / 2:.3f} {width / 2:.3f} 0.01" '
        f'pos="{x:.3f} {y:.3f} 0" euler="0 0 {np.rad2deg(random.uniform(0, np.pi)):.2f}" contype="0" conaffinity="0" '
        f'friction="{random.uniform(0.05, 0.3):.3f} 0.005 0.0001"/>'
    )


def slip_drive(kind: str, random: np.random.Generator, program: Program) -> None:
    """Drives a slip run of a minute."""
    if kind == "wall":
        _wall(random, program)
        return
    end = program.cycle + round(1000 * SECONDS)
    while program.cycle < end:
        _gentle(random, program)
        _hard(kind, random, program)
        program.ramp(0.0, 0.0, 0.4)
        program.stand(random.uniform(0.5, 2.0))
    program.stand(1.0)


def _gentle(random: np.random.Generator, program: Program) -> None:
    speed, turn = random.uniform(-0.2, 0.4), random.uniform(-0.4, 0.4)
    program.ramp(speed, turn, 0.25)  # half of what friction 0.05 carries
    program.drive(speed, turn, random.uniform(2.0, 5.0))
    program.ramp(0.0, 0.0, 0.25)
    program.stand(random.uniform(0.3, 1.0))


def _hard(kind: str, random: np.random.Generator, program: Program) -> None:
    for _ in range(random.integers(1, 4)):
        speed = random.choice([-1.0, 1.0]) * random.uniform(0.5, 1.0)
        turn = 0.0 if kind in {"straight", "one side"} else random.uniform(-2.0, 2.0)
        if kind == "turns" and random.random() < 0.3:
            speed = 0.0
        program.drive(speed, turn, random.uniform(0.5, 2.0))
        if random.random() < 0.5:
            program.stand(random.uniform(0.5, 1.0))  # locked


def _wall(random: np.random.Generator, program: Program) -> None:
    for _ in range(4):
        program.ramp(0.3, 0.0, 0.25)
        program.drive(0.3, 0.0, random.uniform(3.0, 4.0))
        program.drive(random.uniform(0.5, 1.0), random.uniform(-0.3, 0.3), random.uniform(1.0, 4.0))
        program.stand(random.uniform(1.0, 2.0))
        program.ramp(-0.3, random.uniform(-0.3, 0.3), 0.25)
        program.drive(-0.3, 0.0, random.uniform(2.0, 3.0))
        program.ramp(0.0, 0.0, 0.25)
        program.stand(random.uniform(0.5, 1.5))
