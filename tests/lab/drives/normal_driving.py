"""Hours of normal driving, over all scenes, robots and rates: the safety monitor has nothing to say, but that wheels
slip where they do: on ice, and of robots that turn astride a bump; and that who got stuck there is stalled. Beside
them the turns of turning_drive.py, of every robot. So is a wheel that stands before a bump under all of its torque.

python3 -m lab.drives.normal_driving --share 0.1     # a tenth of the two hours
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from robot_control.closed_loop import ClosedLoop, Log
from robot_control.common.cause_names import causes_in
from robot_control.common.signal_names import mask_of
from robot_control.report.drive import Drive as ReportedDrive
from robot_control.report.figures import DEGRADED
from robot_control.report.intervals import intervals

from lab.drives import turning_drive
from lab.drives.normal_drive import LINEAR_LIMIT, WHEEL_COLUMNS, NormalDrive, area_of
from lab.drives.sensor_errors import LEVELS, plant_parameters
from lab.robot_corpus import DIFFBOT, SCENES, robot_names, scene_of, urdf_of
from lab.runs.runner import Processes, Runner

RATES = {1000: 960.0, 100: 240.0, 2000: 120.0}  # Hz → s in each scene, of the project's own robot
SLOW = 500  # Hz; below, the loops are too weak for bumps: wheels stand before them for a second, stalled indeed
SKID_ICE_SPEED = 0.4  # m/s
OTHERS_SECONDS = 15.0  # in each scene, of each real robot
TRUE_WARNINGS = {"low_friction_patch": {"yaw_rate"}, "bumps": {"yaw_rate"}}
HARDLY = 0.3  # of the target
REST = 1.0  # s, in which the estimator learns the bias of the gyro
STANDSTILL = mask_of("StateFlag", "standstill")
TURNS = 40  # seeds of turning_drive.py, of each robot
LONGEST = 300.0  # s, of one drive: so that all processors have something to do to the end


@dataclass(frozen=True)
class Drive:
    """One drive of `seconds` of simulated time."""

    robot: str
    scene: str
    rate: int  # Hz
    seconds: float
    seed: int
    errors: str = "data_sheet"  # one of sensor_errors.LEVELS


@dataclass(frozen=True)
class Driven:
    """What came of it. `causes`, `warnings`: names; empty where nothing was amiss."""

    drive: Drive
    causes: list[str]
    warnings: list[str]  # but for the true ones
    distance: float  # m
    degraded: float  # share of the time while driving after the first rest, as report.py has it; NaN: there was none

    def __str__(self) -> str:
        drive = self.drive
        what = f"{drive.robot} in {drive.scene} at {drive.rate} Hz, seed {drive.seed}, {drive.seconds:.0f} s"
        what += "" if drive.errors == "data_sheet" else f", errors: {drive.errors}"
        said = [f"stopped: {', '.join(self.causes)}"] if self.causes else []
        said += [f"warned: {', '.join(self.warnings)}"] if self.warnings else []
        return f"{what}: {'; '.join(said) or 'nothing amiss'}"


def all_drives(share: float, errors: str = "data_sheet") -> list[Drive]:
    """Two hours, where the real robots are there, times `share`, with sensors that err as `errors` says."""
    drives: list[Drive] = []
    for scene in SCENES:
        for rate, seconds in RATES.items():
            if rate < SLOW and scene == "bumps":
                continue
            drives += _split(Drive(DIFFBOT, scene, rate, share * seconds, 0, errors))
    for robot in robot_names()[1:]:
        for scene in SCENES:
            drives += _split(Drive(robot, scene, 1000, share * OTHERS_SECONDS, 0, errors))
    return drives


def _split(drive: Drive) -> list[Drive]:
    count = max(1, round(drive.seconds / LONGEST))
    return [replace(drive, seconds=drive.seconds / count, seed=seed) for seed in range(count)]


def stuck(log: Log, rate: int) -> bool:
    """By truth: in the quarter second before its first stop it moved by less than 1 cm, and 0.05 rad."""
    stop = int(np.argmax(log["permit_causes"] > 0))
    before = max(0, stop - rate // 4)
    moved = np.hypot(log["truth_x"][stop] - log["truth_x"][before], log["truth_y"][stop] - log["truth_y"][before])
    return bool(moved < 0.01 and abs(log["truth_yaw"][stop] - log["truth_yaw"][before]) < 0.05)


def pushed_in_vain(log: Log, loop: ClosedLoop) -> bool:
    """In the quarter second before the first stop a motor was at its torque limit, and its wheel hardly turned."""
    stop = int(np.argmax(log["permit_causes"] > 0))
    before = slice(max(0, stop - round(0.25 / loop.period)), stop)
    limits = {joint["name"]: joint["effort_limit"] for joint in loop.robot["joints"]}
    for wheel in loop.robot["wheels"]:
        effort, speed, target = (log[f"{wheel['joint']}_{name}"][before] for name in WHEEL_COLUMNS)
        at_limit = np.abs(effort) > 0.99 * limits[wheel["joint"]]
        if at_limit.all() and abs(speed[-1]) < HARDLY * abs(target[-1]):
            return True
    return False


def top_speed(loop: ClosedLoop, scene: str) -> float:
    """m/s. Skid steers that slide sideways off the ice stand on blocked wheels: a person slows down there."""
    return SKID_ICE_SPEED if scene == "low_friction_patch" and len(loop.robot["wheels"]) > 2 else LINEAR_LIMIT


def carry_out(drive: Drive) -> Driven:
    """Drives it."""
    loop = ClosedLoop(
        params={"robot": {"rate": drive.rate}, "mujoco_plant": plant_parameters(drive.errors)},
        seed=drive.seed,
        urdf=urdf_of(drive.robot),
        scene=scene_of(drive.scene),
    )
    log = NormalDrive(loop, area_of(drive.scene), drive.seed, top_speed(loop, drive.scene)).run(drive.seconds)
    warnings = set(causes_in(log["permit_warnings"])) - TRUE_WARNINGS.get(drive.scene, set())
    causes = causes_in(log["permit_causes"])
    if causes == ["stall"] and (stuck(log, drive.rate) or pushed_in_vain(log, loop)):
        causes = []
    return Driven(drive, causes, sorted(warnings), float(log["distance"][0]), degraded_share(log))


def degraded_share(log: Log) -> float:
    """Before its first rest a robot does not know the bias of its gyro: that is no matter of how it drives."""
    flags, time = log["estimate_flags"].astype(int), log["time"]
    rests = [end for begin, end in intervals(flags & STANDSTILL != 0) if time[end - 1] - time[begin] > REST]
    judged = ReportedDrive("", log).driving()
    judged[: rests[0] if rests else None] = False
    return float(np.mean(flags[judged] & DEGRADED != 0)) if judged.any() else math.nan


def _turn(job: tuple[str, int, str]) -> turning_drive.Turning:
    return turning_drive.carry_out(*job)


def bench(
    share: float, say: Callable[[str], None], runner: Runner | None = None, errors: str = "data_sheet"
) -> tuple[dict[str, Any], bool]:
    """The result, and whether nothing was amiss; `say` receives what was."""
    began = time.monotonic()
    drives = all_drives(share, errors)
    driven = []
    runner = runner or Processes()
    for outcome in runner.outcomes(carry_out, drives, say):
        driven.append(outcome)
        if outcome.causes or outcome.warnings:
            say(str(outcome))
    seeds = range(max(1, round(share * TURNS)))
    turns = [(robot, seed, errors) for robot in robot_names() for seed in seeds]
    turned = []
    for turning in runner.outcomes(_turn, turns, say):
        turned.append(turning)
        if turning.causes or turning.warnings:
            say(str(turning))
    degraded = [outcome.degraded for outcome in driven if not math.isnan(outcome.degraded)]
    simulated = sum(drive.seconds for drive in drives) + sum(turning.seconds for turning in turned)
    figures = [
        ("simulated", simulated / 3600, "h"),
        ("distance", sum(outcome.distance for outcome in driven) / 1000, "km"),
        ("drives with a stop", sum(bool(outcome.causes) for outcome in driven), ""),
        ("drives with a warning", sum(bool(outcome.warnings) for outcome in driven), ""),
        ("drives with a rest", len(degraded), ""),
        ("degraded after it, most of any drive", 100 * max(degraded, default=0.0), "% of the time while driving"),
        ("sequences of turns", len(turned), ""),
        ("of them with a stop", sum(bool(turning.causes) for turning in turned), ""),
        ("of them with a warning", sum(bool(turning.warnings) for turning in turned), ""),
        ("speed", simulated / (time.monotonic() - began), "simulated s per s"),
    ]
    rows = [
        {"name": name, "value": value, "unit": unit, "reference": 0, "reference_name": "none", "ratio": 0}
        for name, value, unit in figures
    ]
    amiss = [str(outcome) for outcome in driven if outcome.causes or outcome.warnings]
    amiss += [str(turning) for turning in turned if turning.causes or turning.warnings]
    return {"bench": "driving", "rows": rows, "amiss": amiss}, not amiss


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit code 0: nothing was amiss."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--share", type=float, default=1.0, help="of the two hours")
    parser.add_argument("--errors", choices=LEVELS, default=LEVELS[0], help="of the sensors")
    given = parser.parse_args(arguments)
    result, fine = bench(given.share, print, errors=given.errors)
    for row in result["rows"]:
        print(f"{row['name']:<24}{row['value']:12.5g} {row['unit']}")
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
