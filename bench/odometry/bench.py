"""`scripts/bench odometry` runs every scenario with every seed on all processors; it prints a table, promises and
plots.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bench.odometry import parts
from bench.odometry.judge import Run, run
from bench.odometry.promises import Promise, all_promises, runs_of
from bench.odometry.scenarios import SCENARIOS
from bench.odometry.table import table
from bench.rows import Result, Say, compared, plain
from bench.runs.runner import Processes, Runner

SEEDS = 50
PARTS = "parts"  # parts.py; its drives need no rest at the beginning, which every other scenario has
ALL = (*SCENARIOS, PARTS)
SLOW_SCENARIOS = ("umbmark", "random", "standstill", "waves")  # so that all processors are busy to the end


def all_runs(
    seeds: Sequence[int],
    scenarios: Sequence[str],
    say: Say,
    level: str = "data_sheet",
    *,
    pictured: int | None = None,
    runner: Runner | None = None,
) -> list[Run]:
    """Runs in the order of scenarios and seeds. `level`: one of sensor_errors.LEVELS. `pictured`: the seed whose runs
    keep the data of a plot.
    """
    order = sorted(scenarios, key=lambda name: SLOW_SCENARIOS.index(name) if name in SLOW_SCENARIOS else 9)
    work = [(scenario, seed) for scenario in order for seed in seeds]
    runner = runner or Processes()
    runs = list(runner.outcomes(partial(_one, level=level, pictured=pictured), work, say))
    numbers = {name: number for number, name in enumerate(SCENARIOS)}
    return sorted(runs, key=lambda each: (numbers[each.scenario], each.seed))


def _one(work: tuple[str, int], level: str, pictured: int | None) -> Run:
    scenario, seed = work
    return run(scenario, seed, level, picture=seed == pictured)


def result_of(
    runs: Sequence[Run], seconds: float, level: str = "data_sheet", beside: Sequence[parts.Outcome] = ()
) -> dict[str, Any]:
    """As the benchmark programs print it; `seconds` of wall-clock time, `beside` the outcomes of `parts`."""
    rows = [
        compared(
            each.name, float(each.value), each.unit, each.bound, f"the {'least' if each.least else 'most'} promised"
        )
        | {"kept": bool(each.kept)}
        for each in every_promise(runs, level, beside)
    ]
    for scenario in SCENARIOS:
        pitch = [each.pitch for each in runs_of(runs, scenario)]
        if scenario == "waves" and pitch:
            rows.append(plain("waves, pitch RMS", float(np.rad2deg(np.median(pitch))), "°"))
    rows.append(plain("seeds", len({each.seed for each in runs}), ""))
    rows.append(plain("wall-clock time", seconds, "s"))
    listed = ("scenario", "seed", "distance", "position", "yaw", "stopped", "invalid")
    errors = [{name: getattr(each, name) for name in listed} for each in runs]
    lines = (table(runs) if runs else []) + (parts.table(beside) if beside else [])
    return {"bench": "odometry", "rows": rows, "table": lines, "runs": errors}


def every_promise(runs: Sequence[Run], level: str, beside: Sequence[parts.Outcome]) -> list[Promise]:
    """Those of the scenarios and of `parts`."""
    return (all_promises(runs, level) if runs else []) + (parts.promises(beside) if beside else [])


def bench(
    first: int,
    count: int,
    say: Say,
    level: str = "data_sheet",
    *,
    plots: Path | None = None,
    scenarios: Sequence[str] = ALL,
    runner: Runner | None = None,
) -> Result:
    """The result, and whether every promise is kept; `say` receives progress and broken promises."""
    began = time.monotonic()
    if plots is not None:
        plots.mkdir(parents=True, exist_ok=True)
    pictured = None if plots is None else first
    seeds = range(first, first + count)
    named = [scenario for scenario in scenarios if scenario != PARTS]
    runs = all_runs(seeds, named, say, level, pictured=pictured, runner=runner)
    beside = parts.all_outcomes(seeds, say, level, runner) if PARTS in scenarios else []
    if plots is not None:
        from bench.odometry.plots import draw_all  # noqa: PLC0415 (matplotlib takes half a second to load)

        draw_all(runs, plots)
    broken = [promise for promise in every_promise(runs, level, beside) if not promise.kept]
    for promise in broken:
        say(str(promise))
    return result_of(runs, time.monotonic() - began, level, beside), not broken
