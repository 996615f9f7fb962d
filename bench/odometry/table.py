"""Prints the odometry benchmark as lines of text."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from bench.odometry.judge import Run
from bench.odometry.methods import METHODS
from bench.odometry.promises import CALIBRATED, positions, runs_of, yaws
from bench.odometry.scenarios import SCENARIOS
from bench.odometry.slip import KINDS
from bench.odometry.tested_estimator import OURS
from bench.odometry.truth import Array

NAMES = (*METHODS, OURS)


def table(runs: Sequence[Run]) -> list[str]:
    """Errors of each method by scenario; how honest ours is; slip runs by their kind."""
    lines = _errors(runs)
    lines += ["", *_by_scenario(runs)]
    return [*lines, "", *_by_kind(runs_of(runs, "slip"))] if runs_of(runs, "slip") else lines


def _errors(runs: Sequence[Run]) -> list[str]:
    lines = [f"{'median / p95 over seeds':<26}" + "".join(f"{name:>20}" for name in NAMES)]
    for scenario in (name for name in SCENARIOS if runs_of(runs, name)):
        for what, values, unit, scale in (("position", positions, "mm", 1e3), ("yaw", yaws, "°", 1.0)):
            cells = [_spread(scale * values(runs, scenario, name)) for name in NAMES]
            lines.append(f"{f'{scenario}, {what} [{unit}]':<26}" + "".join(f"{cell:>20}" for cell in cells))
    return lines


def _by_scenario(runs: Sequence[Run]) -> list[str]:
    titles = (
        "runs",
        "way [m]",
        "NEES pose",
        "NEES twist",
        "flagged [%]",
        "alarms [%]",
        "slip [%]",
        "pitch [°]",
        "jump [mm]",
    )
    lines = [f"{'mean':<26}" + "".join(f"{title:>14}" for title in titles)]
    for scenario in (name for name in SCENARIOS if runs_of(runs, name)):
        some = runs_of(runs, scenario)
        cells = [
            float(len(some)),
            np.mean([run.distance for run in some]),
            _mean([run.pose_nees for run in some]),
            _mean([run.twist_nees for run in some]),
            *_noticed(some),
            np.rad2deg(np.mean([run.pitch for run in some])),
            1e3 * np.mean([run.jump for run in some]),
        ]
        lines.append(f"{scenario:<26}" + "".join(f"{cell:14.4g}" for cell in cells))
    return lines


def _noticed(runs: Sequence[Run]) -> list[float]:
    """%: flagged share of the time with slip, of the time without slip, and share of the time with slip."""

    def total(of_run: Callable[[Run], int]) -> int:
        return sum(map(of_run, runs))

    slipping, rolling = total(lambda run: run.notice.slipping), total(lambda run: run.notice.rolling)
    noticed, alarms = total(lambda run: run.notice.noticed), total(lambda run: run.notice.alarms)
    share = slipping / total(lambda run: run.notice.rows)
    return [100 * noticed / max(1, slipping), 100 * alarms / max(1, rolling), 100 * share]


def _by_kind(runs: Sequence[Run]) -> list[str]:
    titles = (
        "runs",
        "wheels [mm]",
        "ours [mm]",
        "5 × better [%]",
        "flagged [%]",
        "alarms [%]",
        "slip [%]",
        "NEES pose",
    )
    lines = [f"{'slip runs, medians':<26}" + "".join(f"{title:>16}" for title in titles)]
    for number, kind in enumerate(KINDS):
        some = [run for run in runs if run.seed % len(KINDS) == number]
        if some:
            wheels, ours = positions(some, "slip", CALIBRATED), positions(some, "slip")
            better = 100 * np.mean(wheels >= 5 * ours)
            cells = [
                float(len(some)),
                1e3 * np.median(wheels),
                1e3 * np.median(ours),
                better,
                *_noticed(some),
                _mean([run.pose_nees for run in some]),
            ]
            lines.append(f"{kind:<26}" + "".join(f"{cell:16.4g}" for cell in cells))
    return lines


def _mean(series: Sequence[Array]) -> float:
    """NaN where no robot moved at a sampled time."""
    values = np.concatenate(series)
    return float(np.nanmean(values)) if np.isfinite(values).any() else np.nan


def _spread(values: Array) -> str:
    return f"{np.median(values):.3g} / {np.percentile(values, 95):.3g}"
