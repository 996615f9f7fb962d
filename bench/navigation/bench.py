"""`scripts/bench navigation`: maps, localisation, goals, and drives with something wrong, in virtual time; costs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from bench.navigation import barn, goals, guard, routes
from bench.rows import Result, Say, judged

PARTS = ("map", "logs", "localization", "goals", "routes", "faults", "guard", "barn", "cost")
MAPS, SPEEDS = tuple(barn.SUCCESSES), tuple(barn.CLIPS)
MAPPING = ("map", "logs", "localization")


def bench(  # noqa: PLR0917 (the options of the command line)
    parts: Sequence[str],
    first: int,
    runs: int | None,
    programs: Path,
    say: Say,
    fields: barn.Fields,
    *,
    logs: Path | None = None,
    robot: str = "diffbot",
) -> Result:
    """The rows of these parts, and whether all bounds hold. `runs`: tours of each scene, drives or routes of each kind,
    worlds, or blocks of the costs. `robot`: of the goals. `logs`: the folder of the part of this name, which is left
    out without one.

    Raises:
        RuntimeError: MRPT is missing.
    """
    rows = _of_mrpt(parts, first, runs, say, logs) if set(parts) & set(MAPPING) else []
    if "goals" in parts:
        rows += goals.goals(first, runs, say, robot)
    if "routes" in parts:
        rows += routes.routes(first, runs or routes.ROUTES, say)
    if "faults" in parts:
        rows += goals.faults(first, runs or goals.FAULT_RUNS, say)
    if "guard" in parts:
        rows += guard.meetings(first, runs or guard.TRIALS, say) + guard.lies(first, runs or guard.LIE_RUNS, say)
    if "barn" in parts:
        rows += barn.barn(first, runs or barn.GENERATED, fields, say)
    if "cost" in parts:
        from bench.navigation import costs  # noqa: PLC0415 (needs ROS's messages of navigation)

        rows += costs.rows_of(runs or costs.BLOCKS, programs, say)
    return judged("navigation", rows)


def _of_mrpt(parts: Sequence[str], first: int, runs: int | None, say: Say, logs: Path | None) -> list[dict[str, Any]]:
    try:
        from bench.navigation import carried, localizing, mapping, on_logs, ring  # noqa: PLC0415 (without MRPT the other parts run)
    except ImportError:
        raise RuntimeError("MRPT is not installed: scripts/setup --navigation, then build again") from None
    rows: list[dict[str, Any]] = []
    if "map" in parts:
        rows += mapping.rows_of(first, runs or mapping.RUNS, say)
        rows += ring.rows_of(first, runs or ring.SEEDS, say)
        rows += carried.rows_of(first, runs or carried.KIDNAPS, say)
    if "logs" in parts and logs is None:
        say("logs: left out without --logs FOLDER")
    if "logs" in parts and logs is not None:
        rows += on_logs.rows_of(logs, first, runs or on_logs.SEEDS, say)
    if "localization" in parts:
        rows += localizing.rows_of(first, runs or localizing.DRIVES, say)
    return rows
