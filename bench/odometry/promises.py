"""The promises of the odometry, each with its measured figure: `scripts/bench odometry`.

The bounds are those of the project's requirements. They hold for robots and sensors of errors.py, in the drives of
scenarios.py, judged by judge.py. A row says "with n seeds" if fewer seeds prove less.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bench.odometry.consistency import nees_band
from bench.odometry.judge import Run
from bench.odometry.scenarios import SCENARIOS
from bench.odometry.tested_estimator import OURS
from bench.odometry.truth import Array

SIMPLE, RAW, CALIBRATED = "simple odometry", "raw wheels", "calibrated wheels"


@dataclass(frozen=True)
class Promise:
    """`bound` is the upper bound of `value`; with `least` it is the lower one."""

    name: str
    value: float
    bound: float
    unit: str
    least: bool = False

    @property
    def kept(self) -> bool:
        """True if the bound holds; NaN never does."""
        return self.value >= self.bound if self.least else self.value <= self.bound

    def __str__(self) -> str:
        rule = "at least" if self.least else "at most"
        return f"{self.name}: {self.value:.4g} {self.unit}, promised {rule} {self.bound:.4g}".replace(" ,", ",")


def runs_of(runs: Sequence[Run], scenario: str) -> list[Run]:
    """The runs of one scenario."""
    return [run for run in runs if run.scenario == scenario]


def positions(runs: Sequence[Run], scenario: str, method: str = OURS) -> Array:
    """m, by seed."""
    return np.array([run.position[method] for run in runs_of(runs, scenario)])


def yaws(runs: Sequence[Run], scenario: str, method: str = OURS) -> Array:
    """degrees, by seed."""
    return np.rad2deg([run.yaw[method] for run in runs_of(runs, scenario)])


def all_promises(runs: Sequence[Run], level: str = "data_sheet") -> list[Promise]:
    """The promises of all present scenarios; beyond the errors of the data sheet, those of the field."""
    if level != "data_sheet":
        return field(runs)
    present = {run.scenario for run in runs}
    promises = []
    for scenario, part in {
        "umbmark": umbmark,
        "random": random_drive,
        "standstill": standstill,
        "slip": slip,
    }.items():
        if scenario in present:
            promises += part(runs)
    return promises + false_alarms(runs) + never_worse(runs)


def field(runs: Sequence[Run]) -> list[Promise]:
    """Promises for sensors that err as in the field."""
    promises = []
    if runs_of(runs, "umbmark"):
        promises.append(Promise("UMBmark, mean", 1e3 * positions(runs, "umbmark").mean(), 30, "mm"))
    if runs_of(runs, "slip"):
        promises += slip(runs)
    return promises + false_alarms(runs)


def umbmark(runs: Sequence[Run]) -> list[Promise]:
    """Promises on the largest mean return error."""
    ours, raw = positions(runs, "umbmark"), positions(runs, "umbmark", RAW)
    return [
        Promise("UMBmark, worst seed", 1e3 * ours.max(), 40, "mm"),
        Promise("UMBmark, mean", 1e3 * ours.mean(), 20, "mm"),
        Promise("UMBmark, raw wheels over ours", raw.mean() / ours.mean(), 20, "", least=True),
    ]


def random_drive(runs: Sequence[Run]) -> list[Promise]:
    """Promises on ten minutes, and on their second half without gyro."""
    drives = runs_of(runs, "random")
    share = 100 * np.array([run.position[OURS] / run.distance for run in drives])
    yaw = yaws(runs, "random")
    killed = {name: float(np.median([run.killed[name] for run in drives])) for name in (OURS, RAW)}
    return [
        Promise("random drive, position, p95", float(np.percentile(share, 95)), 0.5, "% of way"),
        Promise("random drive, yaw, mean", float(yaw.mean()), 1, "°"),
        Promise("random drive, yaw, p95", float(np.percentile(yaw, 95)), 3, "°"),
        Promise("NEES of the pose in its band", 100 * in_band(drives, "pose"), 90, "% of times", least=True),
        Promise("NEES of the twist in its band", 100 * in_band(drives, "twist"), 90, "% of times", least=True),
        Promise("gyro dead, over raw wheels", killed[OURS] / killed[RAW], 0.2, ""),
    ]


def standstill(runs: Sequence[Run]) -> list[Promise]:
    """Promises on ten minutes at rest, the worst seed."""
    drifts = np.array([run.drift for run in runs_of(runs, "standstill")])
    return [
        Promise("standstill, way in 10 min", 1e3 * drifts[:, 0].max(), 0.1, "mm"),
        Promise("standstill, yaw in 10 min", np.rad2deg(drifts[:, 1].max()), 0.01, "°"),
    ]


def slip(runs: Sequence[Run]) -> list[Promise]:
    """The promise on robots that are blocked; that on false slip is beside it."""
    notices = [run.notice for run in runs_of(runs, "slip")]
    spans, reported = sum(each.blocked for each in notices), sum(each.reported for each in notices)
    if not spans:
        return []
    share = 100 * reported / spans
    return [Promise("blocked for more than 1 s, flagged", share, 90, "% of spans", least=True)]


def false_alarms(runs: Sequence[Run]) -> list[Promise]:
    """Promises on all runs of a scenario together, in rows in which no wheel slips by more than 5 %."""
    promises = []
    for scenario in SCENARIOS:
        notices = [run.notice for run in runs_of(runs, scenario)]
        if notices and scenario != "standstill":
            alarms = sum(each.alarms for each in notices) / max(1, sum(each.rolling for each in notices))
            promises.append(Promise(f"false alarms, {scenario}", 100 * alarms, 3, "% of time"))
    return promises


def never_worse(runs: Sequence[Run]) -> list[Promise]:
    """Promise to stay below 1.1 × the simple odometry: ratio of the medians over the seeds, in every scenario."""
    promises = []
    for scenario in (name for name in SCENARIOS if runs_of(runs, name)):
        for what, errors in (("position", positions), ("yaw", yaws)):
            ratio = np.median(errors(runs, scenario)) / np.median(errors(runs, scenario, SIMPLE))
            promises.append(Promise(f"{scenario}, {what} over simple odometry's", float(ratio), 1.1, ""))
    return promises


def in_band(runs: Sequence[Run], what: str) -> float:
    """Share of the sampled times at which the mean NEES over the runs is inside the band."""
    _, means, low, high = mean_nees(runs, what)
    return float(np.mean((means >= low) & (means <= high)))


def mean_nees(runs: Sequence[Run], what: str) -> tuple[Array, Array, Array, Array]:
    """(K,) each: time s, mean over the runs in motion, and the band for as many runs. The times are those that all runs
    reach, with any of them in motion.
    """
    series = [run.pose_nees if what == "pose" else run.twist_nees for run in runs]
    count = min(len(each) for each in series)
    values = np.array([each[:count] for each in series])
    moved = (~np.isnan(values)).sum(axis=0)
    some = moved > 0
    bands = np.array([nees_band(int(each), 3 if what == "pose" else 2) for each in moved[some]]).reshape(-1, 2)
    return runs[0].times[:count][some], np.nanmean(values[:, some], axis=0), bands[:, 0], bands[:, 1]
