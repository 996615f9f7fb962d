"""The scenario `parts`: the odometry beside its parts, which are wheels alone, and wheels with the gyro.

    start           8 s at 0.5 m/s and 0.2 rad/s without a rest, in the default world
    wander          36 s of arcs, straight lines and turns on the spot; errors of radii and base off and on, without a
                    rest and with one of REST s
    drawn           the same with errors that are drawn from the deviations that the parameters state

The gyro's part takes off the bias of the first rest, or none where there is no rest. The odometry is judged against the
better part where radii and base have errors: without errors no part could be better than the wheels. The robots of
`wander` have the mean radius of the model and a small bias, so that their deviations are too large. Whether deviations
are right is shown by `drawn`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import yaml  # type: ignore[import-untyped]
from robot_control.installed_files import share_file
from robot_control.settings.parameter_layers import DEFAULTS

from bench.drives.sensor_errors import plant_parameters
from bench.odometry.consistency import nees, pose_error, twist_error
from bench.odometry.errors import GYRO_BIAS, GYRO_SCALE, Errors, draw_errors
from bench.odometry.methods import bias_of_first_rest, raw_wheels
from bench.odometry.program import Program
from bench.odometry.promises import Promise
from bench.odometry.recording import record
from bench.odometry.scenarios import Trial
from bench.odometry.tested_estimator import OURS, estimate
from bench.odometry.truth import Array, Track, moving, truth_of
from bench.rows import Say
from bench.runs.runner import Processes, Runner

STREAM = 3  # index of this random stream; errors.py and scenarios.py use others
REST = 3.0  # s
SECONDS = 36.0
WHEELS, GYRO = "raw wheels", "gyro, bias of the first rest"
SAMPLE = 100  # truth rows of 10 ms between two samples of the NEES
QUANTILES = {"pose": (2.366, 7.815), "twist": (1.386, 5.991)}  # 50 and 95 % of χ² with 3 and 2 degrees of freedom


@dataclass(frozen=True)
class Case:
    """`errors` of radii and base; `most` and `most95` are the promised median and p95 of the position, mm. `drawn`: the
    errors and the gyro's bias are those that the parameters state.
    """

    errors: bool
    rest: float
    most: float = np.inf
    most95: float = np.inf
    start: bool = False
    drawn: bool = False


CASES = {
    "start": Case(errors=False, rest=0.0, most=60, most95=60, start=True),
    "wander": Case(errors=False, rest=0.0, most=16, most95=46),
    "wander, rest": Case(errors=False, rest=REST, most=12, most95=20),
    "wander, errors": Case(errors=True, rest=0.0, most=21, most95=100),
    "wander, errors, rest": Case(errors=True, rest=REST, most=12, most95=20),
    "drawn": Case(errors=True, rest=0.0, drawn=True),
    "drawn, rest": Case(errors=True, rest=REST, drawn=True),
}


@dataclass(frozen=True)
class Outcome:
    """`position`: m at the end, by method. `pose_nees`, `twist_nees` where the robot moves."""

    case: str
    position: dict[str, float]
    pose_nees: Array
    twist_nees: Array


def commands(case: Case, seed: int) -> Array:
    """(cycles, 2) of a case."""
    program, random = Program(), np.random.default_rng([STREAM, seed])
    if case.start:
        program.drive(0.5, 0.2, 8.0)
        return program.commands
    if case.rest:
        program.stand(case.rest)
    end = program.cycle + round(1000 * SECONDS)
    while program.cycle < end:
        kind = random.choice(["arc", "straight", "turn"], p=[0.5, 0.3, 0.2])
        speed = random.uniform(0.2, 0.8)
        if kind == "turn":
            rate = random.choice([-1, 1]) * random.uniform(0.3, 1.2)
            program.drive(0.0, rate, random.uniform(0.5, np.pi) / abs(rate))
        else:
            bend = float(np.clip(random.normal(0, 0.4), -1, 1)) if kind == "arc" else 0.0
            program.drive(speed, bend, random.uniform(2, 6))
    return program.commands[:end]


def drawn(seed: int) -> tuple[Errors, float]:
    """Errors, and the deviation of the gyro's bias [rad/s], as the parameters of the estimator state them."""
    stated = yaml.safe_load(Path(share_file(DEFAULTS)).read_text())["state_estimator"]
    random = np.random.default_rng([STREAM, seed, 1])
    radius = np.sqrt(3) * stated["wheel_radius_deviation"] * random.uniform(-1, 1)
    half = stated["radius_ratio_deviation"] * random.standard_normal() / 2
    base = stated["wheel_base_deviation"] * random.standard_normal()
    errors = Errors(radius - half, radius + half, base, random.uniform(-GYRO_SCALE, GYRO_SCALE))
    return errors, float(stated["gyro_bias_initial"])


def draw(name: str, seed: int, level: str) -> Trial:
    """The drive of a case. The start is in the default world, whatever `level` is."""
    case = CASES[name]
    errors, bias = draw_errors(seed) if case.errors else Errors(0, 0, 0, 0), float(GYRO_BIAS)
    if case.drawn:
        errors, bias = drawn(seed)
    plant: dict[str, Any] = {} if case.start else {**plant_parameters(level), **errors.plant(), "gyro_bias": bias}
    return Trial("parts", seed, errors, seed, {"mujoco_plant": plant}, commands(case, seed))


def outcome(work: tuple[str, int], level: str) -> Outcome:
    """One drive."""
    name, seed = work
    case = CASES[name]
    drive = record(draw(name, seed, level))
    truth, ours = truth_of(drive), estimate(drive)
    paths = {OURS: ours.path, WHEELS: raw_wheels(drive), GYRO: bias_of_first_rest(drive, case.rest)}
    rows = np.arange(SAMPLE, len(truth.linear), SAMPLE)
    rows = rows[moving(truth)[rows]]
    return Outcome(
        case=name,
        position={method: _away(path, truth.odom) for method, path in paths.items()},
        pose_nees=nees(pose_error(ours, truth)[rows], ours.pose_covariance[rows]),
        twist_nees=nees(twist_error(ours, truth)[rows], ours.twist_covariance[rows]),
    )


def _away(path: Track, true: Track) -> float:
    return float(np.hypot(path.x[-1] - true.x[-1], path.y[-1] - true.y[-1]))


def all_outcomes(seeds: Sequence[int], say: Say, level: str, runner: Runner | None = None) -> list[Outcome]:
    """Outcomes of all cases."""
    work = [(name, seed) for name in CASES for seed in seeds]
    return list((runner or Processes()).outcomes(partial(outcome, level=level), work, say))


def errors_of(outcomes: Sequence[Outcome], case: str, method: str = OURS) -> Array:
    """mm, at the end."""
    return 1e3 * np.array([each.position[method] for each in outcomes if each.case == case])


def promises(outcomes: Sequence[Outcome]) -> list[Promise]:
    """The promises on position, on the better part, and on the covariance both ways."""
    found = []
    for name, case in CASES.items():
        ours = errors_of(outcomes, name)
        for what, quantile, bound in (("median", 50, case.most), ("p95", 95, case.most95)):
            value = float(np.percentile(ours, quantile))
            if not case.drawn:
                found.append(Promise(f"parts, {name}, {what}", value, bound, "mm"))
            if case.errors:
                better = min(float(np.percentile(errors_of(outcomes, name, part), quantile)) for part in (WHEELS, GYRO))
                found.append(Promise(f"parts, {name}, {what} over the better part", value / better, 1.1, ""))
    for of, is_drawn in (("parts", False), ("parts, drawn", True)):
        cases = {name for name, case in CASES.items() if case.errors and case.drawn == is_drawn}
        found += covariance_promises(of, [each for each in outcomes if each.case in cases])
    return found


def covariance_promises(of: str, outcomes: Sequence[Outcome]) -> list[Promise]:
    """Those on the covariance of some outcomes, both ways."""
    found = []
    for what, (half, most) in QUANTILES.items():
        values = np.concatenate([getattr(each, f"{what}_nees") for each in outcomes])
        ideal = 3 if what == "pose" else 2
        found += [
            Promise(f"{of}, mean NEES of the {what}", float(values.mean()), 2 * ideal, ""),
            Promise(f"{of}, mean NEES of the {what}, least", float(values.mean()), ideal / 2, "", least=True),
            Promise(f"{of}, {what} inside 50 %", 100 * float(np.mean(values < half)), 75, "% of times"),
            Promise(f"{of}, {what} inside 50 %, least", 100 * float(np.mean(values < half)), 30, "%", least=True),
            Promise(f"{of}, {what} inside 95 %", 100 * float(np.mean(values < most)), 90, "%", least=True),
        ]
    return found


def table(outcomes: Sequence[Outcome]) -> list[str]:
    """Errors by case and method."""
    lines = [f"{'median / p95 over seeds [mm]':<30}" + "".join(f"{name:>30}" for name in (OURS, WHEELS, GYRO))]
    for name in CASES:
        cells = []
        for method in (OURS, WHEELS, GYRO):
            values = errors_of(outcomes, name, method)
            cells.append(f"{np.median(values):.3g} / {np.percentile(values, 95):.3g}")
        lines.append(f"{name:<30}" + "".join(f"{cell:>30}" for cell in cells))
    return lines
