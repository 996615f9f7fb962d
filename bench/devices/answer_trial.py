"""Every answer of the drives is lost, damaged, shifted by a byte or late, while all orders arrive: when is the robot at
rest?

The robot drives at a random speed, and turns. At a random phase of its exchanges the answers fail for a time,
while the request for motion goes on. It must be at rest within the time that docs/drivers.md states of these drives.
It stays there also when the answers are good again: only the operator's reset ends the stop.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from robot_control.loop.drives import DRIVES

from bench.devices.loss_trial import STANDING, robot_behind, speed_of

KINDS = ("answers_lost", "answers_damaged", "answers_shifted", "answers_late")
STATED = {(name, command): 1.0 for name, row in DRIVES.items() for command in row.wheel_commands}
"""s until rest from 1 m/s, by drive and wheel command (docs/drivers.md)"""
FAULT_TIME = 10.0  # s
AFTER_TIME = 1.0  # s, in which the answers are good again


@dataclass(frozen=True)
class AnswerTrial:
    """Answers of these drives that fail in this way at one seed."""

    drive: str
    wheel_command: str
    kind: str
    seed: int
    lasting: float = FAULT_TIME


def time_to_rest(trial: AnswerTrial) -> float:
    """s after which the robot stands for good."""
    random = np.random.default_rng(trial.seed)
    loop = robot_behind(trial.drive, trial.seed, wheel_command=trial.wheel_command)
    request = random.choice((-1, 1)) * random.uniform(0.2, 1.0), random.uniform(-0.4, 0.4)
    loop.run(0.5, (0.0, 0.0))
    loop.run(random.uniform(1.5, 2.5), request)
    component = "bus" if DRIVES[trial.drive].driver == "can" else "line"
    loop.inject_fault(component, trial.kind)
    fault = loop.run(trial.lasting, request)
    loop.inject_fault(component, "ok")
    after = loop.run(AFTER_TIME, request)
    base = loop.robot["wheel_base"]
    speed = np.concatenate([speed_of(log, base) for log in (fault, after)])
    moves = np.flatnonzero(speed > STANDING)
    return float(loop.period * (moves[-1] + 1)) if len(moves) else 0.0
