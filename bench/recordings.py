"""`scripts/bench recordings`: the estimators on recordings of real robots, beside the simple ways.

The folder of recordings is that of bench/odometry/recordings.py. Without it a part is skipped, with the reason.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from bench.odometry import recorded_drives, recorded_walks
from bench.odometry.recordings import ABSENT, recordings_folder
from bench.rows import Result, Row, Say

PARTS = ("wheels", "legs")


def bench(parts: Sequence[str], say: Say, program: Callable[..., Any], file: Path | None) -> Result:
    """The tables of these parts one below the other, and their rows. `program` runs that of this name. `file` is a
    recording of a robot on legs.
    """
    table: list[str] = []
    rows: list[Row] = []
    for part in parts:
        if recordings_folder() is None and (part != "legs" or file is None):
            table.append(f"{part}: skipped, {ABSENT}")
            continue
        lines, figures = recorded_drives.bench(say) if part == "wheels" else recorded_walks.bench(say, program, file)
        table += lines
        rows += figures
    return {"bench": "recordings", "rows": rows, "table": table}, all(row["ratio"] <= 1 for row in rows)
