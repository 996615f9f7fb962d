"""The drives of the odometry benchmark, each a pure function of the random numbers that it receives.

A drive writes its commands and its settings of world, controller and monitor into a Draft.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from robot_control.installed_files import share_file

from bench.odometry import slip as slip_trial
from bench.odometry.program import RAMP, Program

FIRST_STAND = 3.0  # s, of every run
SET_DOWN = 10.0  # s, before each square
SIDE = 4.0  # m, of UMBmark's square
SQUARES = 5  # each way


@dataclass
class Draft:
    """The data that a scenario fills in."""

    random: np.random.Generator
    kind: int = 0  # the scenario's variant, in turn
    program: Program = field(default_factory=Program)
    plant: dict[str, Any] = field(default_factory=dict)
    controller: dict[str, Any] = field(default_factory=dict)
    safety: dict[str, Any] = field(default_factory=dict)
    scene: str = ""
    marks: dict[str, list[int]] = field(default_factory=dict)

    def mark(self, what: str) -> None:
        """Marks the next cycle."""
        self.marks.setdefault(what, []).append(self.program.cycle)


def umbmark(draft: Draft) -> None:
    """Borenstein & Feng 1996: a square of 4 m, five times each way, corners turned on the spot, at 0.2 … 0.5 m/s.

    The authors set the robot down at the start, measure its place and reset its odometry before each run. Here the next
    run begins at the robot's present place. It stands SET_DOWN s before each run, which is the least that setting down
    takes. Then the odometry is reset (at the marks cw, ccw).
    """
    speed = draft.random.uniform(0.2, 0.5)
    rate = draft.random.uniform(0.5, 1.0)  # rad/s
    draft.program.stand(SET_DOWN - FIRST_STAND)
    for direction in (-1, 1):
        for _ in range(SQUARES):
            draft.mark("cw" if direction < 0 else "ccw")
            for _ in range(4):
                draft.program.ways(speed, SIDE, 0.3)
                draft.program.turn(direction * rate, np.pi / 2, 0.3)
            draft.mark("end")
            draft.program.stand(SET_DOWN)


def random_drive(draft: Draft) -> None:
    """Ten minutes of a mobile robot's daily moves; 8 of 100 are stops of 0.5 … 2 s."""
    _moves(draft, 600.0, 0.8)


def figure_eight(draft: Draft) -> None:
    """Five figures of eight with radii of 0.8 … 1.5 m."""
    speed, radius = draft.random.uniform(0.3, 0.6), draft.random.uniform(0.8, 1.5)
    for _ in range(5):
        for direction in (1, -1):
            draft.program.drive(speed, direction * speed / radius, 2 * np.pi * radius / speed)
    draft.program.stand(2.0)


def slope(draft: Draft) -> None:
    """Drives for two minutes on 3 … 8°, in all directions."""
    draft.plant["slope"] = np.deg2rad(draft.random.uniform(3.0, 8.0))
    _moves(draft, 120.0, 0.5)


def ice(draft: Draft) -> None:
    """Drives over the patch of friction 0.1, 1 … 3 m ahead, bending, stopping and starting on it within default limits.
    Their 1 m/s² is just what the patch carries.
    """
    draft.scene = _scene("low_friction_patch")
    for _ in range(3):
        for direction in (1.0, -1.0):
            speed = direction * draft.random.uniform(0.4, 0.8)
            bend = draft.random.uniform(-0.4, 0.4)
            draft.program.drive(speed, 0.0, 1.5 / abs(speed))
            draft.program.drive(speed, bend, 0.5)
            draft.program.stand(draft.random.uniform(1.0, 2.0))
            draft.program.drive(speed, -bend, 0.5)
            draft.program.drive(speed, 0.0, 2.5 / abs(speed) - 1.0)
            draft.program.stand(2.0)


def kerb(draft: Draft) -> None:
    """Drives over a kerb of 20 mm, to and fro, aslant."""
    draft.scene = _scene("kerb")
    draft.program.turn(0.5 * np.sign(draft.random.uniform(-1, 1)), draft.random.uniform(0.0, 0.6), 0.3)
    for _ in range(4):
        for direction in (1.0, -1.0):
            draft.program.drive(direction * draft.random.uniform(0.3, 0.7), 0.0, 5.0)
            draft.program.stand(2.0)


def standstill(draft: Draft) -> None:
    """Drives a little, then stands for ten minutes."""
    draft.program.ways(0.4, 1.0, 0.3)
    draft.program.turn(0.8, 1.0, 1.0)
    draft.program.stand(600.0)


def waves(draft: Draft) -> None:
    """Drives over humps that pitch the body by 1° RMS, to and fro and in eights, within the 6 m that they cover."""
    draft.scene = _scene("waves")
    for _ in range(3):
        speed = draft.random.uniform(0.2, 0.5)
        for direction in (1.0, -1.0):
            draft.program.ways(direction * speed, 2.0, 0.5)
        draft.program.turn(0.8, draft.random.uniform(0.5, 2.5), 0.5)
        radius = draft.random.uniform(0.6, 1.0)
        for direction in (1, -1):
            draft.program.drive(speed, direction * speed / radius, 2 * np.pi * radius / speed)
        draft.program.stand(1.0 + draft.random.uniform(0.5, 2.0))


def _scene(name: str) -> str:
    return Path(share_file(f"urdf/scenes/{name}.xml")).read_text(encoding="utf-8")


def _moves(draft: Draft, seconds: float, top: float) -> None:
    """Drives arcs, straight lines, turns on the spot, some in reverse, and stops; up to `top` m/s."""
    random, program = draft.random, draft.program
    end = program.cycle + round(seconds * 1000)
    while program.cycle < end:
        kind = random.choice(["arc", "straight", "turn", "reverse", "stop"], p=[0.45, 0.25, 0.14, 0.08, 0.08])
        speed = random.uniform(0.2, top)
        if kind == "arc":
            program.drive(speed, float(np.clip(random.normal(0, 0.4), -1, 1)), random.uniform(2, 8))
        elif kind == "straight":
            program.drive(speed, 0.0, random.uniform(2, 8))
        elif kind == "turn":
            rate = random.choice([-1, 1]) * random.uniform(0.3, 1.2)
            program.drive(0.0, rate, random.uniform(0.5, np.pi) / abs(rate))
        elif kind == "reverse":
            program.drive(-random.uniform(0.1, 0.4), float(np.clip(random.normal(0, 0.3), -1, 1)), random.uniform(2, 4))
        else:
            program.stand(top / 1.0 + RAMP + random.uniform(0.5, 2.0))
    program.stand(2.0)


def slip(draft: Draft) -> None:
    """Spins, locks and slides wheels for a minute between stretches of normal grip (slip.py)."""
    kind = slip_trial.KINDS[draft.kind % len(slip_trial.KINDS)]
    draft.scene = slip_trial.slip_world(kind, draft.random)
    draft.controller = slip_trial.HARD_LIMITS
    draft.safety = slip_trial.SAFETY
    slip_trial.slip_drive(kind, draft.random, draft.program)
