"""The table of `scripts/bench devices`: losses, failing answers, silence on a slope, and disturbed buses and lines, by
dialect. With `--robot quadbot` losses and disturbed walks of a robot on legs, by drive.

scripts/bench devices --first 40 --runs 1
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from bench.devices.answer_trial import KINDS, STATED, AnswerTrial, time_to_rest
from bench.devices.disturbed_drive import BUSES, DisturbedDrive, run_drive, together
from bench.devices.loss_trial import (
    BRAKE_CYCLES,
    DIALECTS,
    LATEST,
    SERIAL,
    SERIAL_LATEST,
    LossTrial,
    Outcome,
    latest,
    run_trial,
)
from bench.devices.slope_trial import as_stated
from bench.markdown import ALLOWED
from bench.rows import Result, Row, Say, judged
from bench.runs.runner import Runner

ALL_RUNS = 100
DRIVES = 6
"""On each bus. In a long drive without a rest a late correction of the heading outweighs lost frames."""
DRIVE_TIME = 300.0  # s
ODOMETRY, RIPPLE = 1.2, 2.0
"""Bounds of a drive with lost frames, and with late frames as well, by the undisturbed one."""


def bench(
    parts: Sequence[str], first: int, runs: int, say: Say, runner: Runner, *, program: Callable[..., dict[str, Any]]
) -> Result:
    """The table, and whether every figure keeps its bound.

    Args:
        parts: what is measured, of losses, answers, slope and disturbed.
        first: the first seed.
        runs: seeds of each kind of loss; the drives last `runs`/`ALL_RUNS` of `DRIVE_TIME`, but at least a minute.
        say: receives progress and every broken rule.
        runner: where the trials run.
        program: runs one of bench/programs.
    """
    rows: list[Row] = []
    if "losses" in parts:
        rows += program("bench_board_losses", first, runs)["rows"]
        rows += loss_rows(first, runs, say, runner)
    if "answers" in parts:
        rows += answer_rows(first, runs, say, runner)
    if "slope" in parts:
        rows += slope_rows(first, runs, say, runner)
    if "disturbed" in parts:
        rows += drive_rows(first, max(60.0, DRIVE_TIME * min(runs, ALL_RUNS) / ALL_RUNS), say, runner)
    return judged("devices", rows)


def row(name: str, value: float, unit: str, allowed: float) -> Row:
    """One figure with its bound."""
    ratio = value / allowed if allowed else float(value)
    return {"name": name, "value": value, "unit": unit, "reference": allowed, "reference_name": ALLOWED, "ratio": ratio}


def loss_rows(first: int, runs: int, say: Say, runner: Runner) -> list[Row]:
    """Per dialect and kind of loss: broken rules, and the latest times until it is seen and until the brake."""
    kinds = [(device, kind) for device, latest_of in (LATEST | SERIAL_LATEST).items() for kind in latest_of]
    trials = [LossTrial(dialect, kind, seed) for dialect, kind in kinds for seed in range(first, first + runs)]
    outcomes: dict[tuple[str, str], list[Outcome]] = {}
    for trial, outcome in zip(trials, runner.outcomes(run_trial, trials, say, chunk=10), strict=True):
        outcomes.setdefault((trial.dialect, trial.kind), []).append(outcome)
        if outcome.broken:
            say(f"{trial}: {', '.join(outcome.broken)}")
    rows = []
    for (dialect, kind), found in outcomes.items():
        allowed = 1e3 * latest(LossTrial(dialect, kind, first))
        rows += [
            row(f"{dialect} {kind}: losses that broke a rule", sum(bool(each.broken) for each in found), "", 0),
            row(f"{dialect} {kind}: until it is seen", max(each.seen for each in found), "ms", allowed),
            row(f"{dialect} {kind}: from there to the brake", max(e.brake for e in found), "cycles", BRAKE_CYCLES),
        ]
    return rows


def answer_rows(first: int, runs: int, say: Say, runner: Runner) -> list[Row]:
    """Per drive, wheel command and fault of its answers: the latest rest."""
    rows = []
    for (drive, command), stated in STATED.items():
        for kind in KINDS:
            trials = [AnswerTrial(drive, command, kind, seed) for seed in range(first, first + runs)]
            times = list(runner.outcomes(time_to_rest, trials, say, chunk=10))
            late = [trial.seed for trial, time in zip(trials, times, strict=True) if time > stated]
            if late:
                say(f"{drive} {command} {kind}: later than {stated} s with the seeds {late}")
            rows.append(row(f"{drive} with {command}, {kind}: latest rest", max(times), "s", stated))
    return rows


def slope_rows(first: int, runs: int, say: Say, runner: Runner) -> list[Row]:
    """Silence on a slope: a tenth of `runs`."""
    seeds = range(first, first + max(1, runs // 10))
    items = [(dialect, seed) for dialect in DIALECTS for seed in seeds]
    stated = list(runner.outcomes(as_stated, items, say))
    other = dict.fromkeys(DIALECTS, 0)
    for (dialect, _), good in zip(items, stated, strict=True):
        other[dialect] += not good
    return [row(f"{name} silence on 5°: not as docs/drivers.md states", count, "", 0) for name, count in other.items()]


def drive_rows(first: int, seconds: float, say: Say, runner: Runner) -> list[Row]:
    """False stops, and the ratios of odometry's error and of the ripple, of `DRIVES` drives."""
    seeds = range(first, first + DRIVES)
    kinds = [(dialect, bus) for dialect in (*DIALECTS, *SERIAL) for bus in BUSES]
    drives = [DisturbedDrive(dialect, bus, seconds, seed) for dialect, bus in kinds for seed in seeds]
    found = iter(runner.outcomes(run_drive, drives, say))
    figures = {kind: together([next(found) for _ in seeds]) for kind in kinds}
    rows = []
    for (dialect, bus), of in figures.items():
        undisturbed = figures[dialect, BUSES[0]]
        name = f"{dialect} {bus} {'line' if dialect in SERIAL else 'bus'}:"
        rows.append(row(f"{name} false stops", of.stops, "", 0))
        if bus == BUSES[0]:
            continue
        ratio = of.odometry / undisturbed.odometry
        rows.append(row(f"{name} error of the odometry, of the undisturbed", ratio, "", ODOMETRY))
        if dialect in DIALECTS:
            rows.append(
                row(f"{name} ripple of the turn, of the undisturbed", of.ripple / undisturbed.ripple, "", RIPPLE)
            )
    return rows
