"""What is driven in the odometry benchmark: scenario and seed → robot, world, commands. A pure function of both.

Every run begins with FIRST_STAND s of standstill, as a robot does that is switched on. Controllers use no pose, so the
sensors' data do not depend on the estimator.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bench.drives.sensor_errors import plant_parameters
from bench.odometry import drives
from bench.odometry.drives import FIRST_STAND, Draft
from bench.odometry.errors import Errors, draw_errors
from bench.odometry.program import Array

SCENARIO_STREAM = 2  # index of this random stream; errors.py uses another one


@dataclass(frozen=True)
class Trial:
    """One run. `params` lie over the defaults. `scene` is the text of an MJCF world; "" stands for that of the
    parameters. `marks` has the cycles of events by name. `up` points away from the centre of the earth, in truth's axes
    (their z is the ground's normal).
    """

    scenario: str
    seed: int
    errors: Errors
    plant_seed: int  # seed of the sensors' random numbers
    params: dict[str, Any]
    commands: Array
    scene: str = ""
    marks: dict[str, list[int]] = field(default_factory=dict)
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)


SCENARIOS: dict[str, Callable[[Draft], None]] = {
    "umbmark": drives.umbmark,
    "random": drives.random_drive,
    "eight": drives.figure_eight,
    "slope": drives.slope,
    "ice": drives.ice,
    "kerb": drives.kerb,
    "standstill": drives.standstill,
    "waves": drives.waves,
    "slip": drives.slip,
}


def draw_trial(scenario: str, seed: int, level: str = "data_sheet") -> Trial:
    """The run of that name and seed, with sensors that err as `level` says, one of sensor_errors.LEVELS."""
    number = list(SCENARIOS).index(scenario)
    draft = Draft(np.random.default_rng([SCENARIO_STREAM, number, seed]), kind=seed)
    draft.program.stand(FIRST_STAND)
    SCENARIOS[scenario](draft)
    errors = draw_errors(seed)
    tilt = float(draft.plant.get("slope", 0.0))
    plant = {**plant_parameters(level), **errors.plant(), **draft.plant}
    params = {"mujoco_plant": plant, "diff_drive_controller": draft.controller, "safety_monitor": draft.safety}
    up = (float(np.sin(tilt)), 0.0, float(np.cos(tilt)))
    plant_seed = len(SCENARIOS) * seed + number
    return Trial(scenario, seed, errors, plant_seed, params, draft.program.commands, draft.scene, draft.marks, up)
