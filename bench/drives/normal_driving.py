"""Hours of normal driving over all scenes, robots and rates: the safety monitor reports nothing but true slip and true
stalls. Wheels slip on ice, and on robots that turn astride a bump. A robot that got stuck there is stalled, and so is a
wheel that stands before a bump under all of its torque. The turns of turning_drive.py are driven by every robot as
well.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace

import numpy as np
from robot_control.data.intervals import intervals
from robot_control.data.report.drive import Drive as ReportedDrive
from robot_control.data.report.figures import DEGRADED
from robot_control.loop.closed_loop import ClosedLoop, Log
from robot_control.loop.signal_names import causes_in, mask_of

from bench.drives import turning_drive
from bench.drives.normal_drive import LINEAR_LIMIT, WHEEL_COLUMNS, NormalDrive, area_of
from bench.drives.sensor_errors import plant_parameters
from bench.drives.wheel_command import for_drives
from bench.robot_corpus import DIFFBOT, SCENES, robot_names, scene_of, urdf_of
from bench.rows import Result, Say, plain
from bench.runs.runner import Processes, Runner

RATES = {1000: 960.0, 100: 240.0, 2000: 120.0}  # Hz → s in each scene, of the project's own robot
SLOW = 500  # Hz; below, the loops are too weak for bumps: wheels truly stall before them for a second
SKID_ICE_SPEED = 0.4  # m/s
OTHERS_SECONDS = 15.0  # in each scene, of each real robot
TRUE_WARNINGS = {"low_friction_patch": {"yaw_rate"}, "bumps": {"yaw_rate"}}
HARDLY = 0.3  # share of the target speed of a wheel that hardly turns
REST = 1.0  # s, in which the estimator learns the bias of the gyro
STANDSTILL = mask_of("StateFlag", "standstill")
TURNS = 40  # seeds of turning_drive.py, of each robot
MAX_DRIVE = 300.0  # s, of one drive; shorter drives keep all processors busy to the end


@dataclass(frozen=True)
class Drive:
    """One drive of `seconds` of simulated time."""

    robot: str
    scene: str
    rate: int  # Hz
    seconds: float
    seed: int
    errors: str = "data_sheet"  # one of sensor_errors.LEVELS
    wheel_command: str = "torque"  # one of WHEEL_COMMANDS


@dataclass(frozen=True)
class Driven:
    """Result of a drive. `causes`, `warnings`: names; empty if there were none."""

    drive: Drive
    causes: list[str]
    warnings: list[str]  # names of warnings without the true ones
    distance: float  # m
    degraded: float  # share of the time after the first rest, as report.py computes it; NaN without a rest

    def __str__(self) -> str:
        drive = self.drive
        what = f"{drive.robot} in {drive.scene} at {drive.rate} Hz, seed {drive.seed}, {drive.seconds:.0f} s"
        what += "" if drive.errors == "data_sheet" else f", errors: {drive.errors}"
        what += "" if drive.wheel_command == "torque" else f", drives of {drive.wheel_command}"
        said = [f"stopped: {', '.join(self.causes)}"] if self.causes else []
        said += [f"warned: {', '.join(self.warnings)}"] if self.warnings else []
        return f"{what}: {'; '.join(said) or 'nothing amiss'}"


def all_drives(share: float, errors: str = "data_sheet", wheel_command: str = "torque") -> list[Drive]:
    """Two hours, if the real robots are there, times `share`, with sensors that err as `errors` says."""
    drives: list[Drive] = []
    for scene in SCENES:
        for rate, seconds in RATES.items():
            if rate < SLOW and scene == "bumps":
                continue
            drives += _split(Drive(DIFFBOT, scene, rate, share * seconds, 0, errors, wheel_command))
    for robot in robot_names()[1:]:
        for scene in SCENES:
            drives += _split(Drive(robot, scene, 1000, share * OTHERS_SECONDS, 0, errors, wheel_command))
    return drives


def _split(drive: Drive) -> list[Drive]:
    count = max(1, round(drive.seconds / MAX_DRIVE))
    return [replace(drive, seconds=drive.seconds / count, seed=seed) for seed in range(count)]


def stuck(log: Log, rate: int) -> bool:
    """True if it moved by less than 1 cm and 0.05 rad in the quarter second before its first stop, by the truth."""
    stop = int(np.argmax(log["permit_causes"] > 0))
    before = max(0, stop - rate // 4)
    moved = np.hypot(log["truth_x"][stop] - log["truth_x"][before], log["truth_y"][stop] - log["truth_y"][before])
    return bool(moved < 0.01 and abs(log["truth_yaw"][stop] - log["truth_yaw"][before]) < 0.05)


def pushed_in_vain(log: Log, loop: ClosedLoop) -> bool:
    """True if a motor was at its torque limit in the quarter second before the first stop and hardly turned."""
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
    """m/s. Skid steers that slide sideways off the ice stand on blocked wheels, so a person would slow down there."""
    return SKID_ICE_SPEED if scene == "low_friction_patch" and len(loop.robot["wheels"]) > 2 else LINEAR_LIMIT


def carry_out(drive: Drive) -> Driven:
    """Carries out a drive."""
    params = {"robot": {"rate": drive.rate}, "mujoco_plant": plant_parameters(drive.errors)}
    loop = ClosedLoop(
        params=for_drives(drive.wheel_command, params),
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
    """Share of degraded time after the first rest; before it a robot does not know the bias of its gyro."""
    flags, time = log["estimate_flags"].astype(int), log["time"]
    rests = [end for begin, end in intervals(flags & STANDSTILL != 0) if time[end - 1] - time[begin] > REST]
    judged = ReportedDrive("", log).driving()
    judged[: rests[0] if rests else None] = False
    return float(np.mean(flags[judged] & DEGRADED != 0)) if judged.any() else math.nan


def _turn(job: tuple[str, int, str, str]) -> turning_drive.Turning:
    return turning_drive.carry_out(*job)


def bench(
    share: float,
    say: Say,
    runner: Runner | None = None,
    errors: str = "data_sheet",
    wheel_command: str = "torque",
) -> Result:
    """The result, and whether no drive had a fault; `say` receives the faults."""
    began = time.monotonic()
    drives = all_drives(share, errors, wheel_command)
    driven = []
    runner = runner or Processes()
    for outcome in runner.outcomes(carry_out, drives, say):
        driven.append(outcome)
        if outcome.causes or outcome.warnings:
            say(str(outcome))
    seeds = range(max(1, round(share * TURNS)))
    turns = [(robot, seed, errors, wheel_command) for robot in robot_names() for seed in seeds]
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
    rows = [plain(*figure) for figure in figures]
    amiss = [str(outcome) for outcome in driven if outcome.causes or outcome.warnings]
    amiss += [str(turning) for turning in turned if turning.causes or turning.warnings]
    return {"bench": "driving", "rows": rows, "amiss": amiss}, not amiss
