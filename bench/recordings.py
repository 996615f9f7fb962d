"""`scripts/bench recordings`: the estimators on recordings of real robots, beside the simple ways.

The folder of recordings is that of bench/odometry/recordings.py. Without it a part is skipped, with the reason.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from bench.odometry import recorded_drives
from bench.odometry.recordings import ABSENT, recordings_folder
from bench.rows import Result, Row, Say

Part = Callable[[Say], tuple[list[str], list[Row]]]
EACH: dict[str, Part] = {"wheels": recorded_drives.bench}
PARTS = tuple(EACH)


def bench(parts: Sequence[str], say: Say) -> Result:
    """The tables of these parts one below the other, and their rows."""
    table: list[str] = []
    rows: list[Row] = []
    for part in parts:
        if recordings_folder() is None:
            table.append(f"{part}: skipped, {ABSENT}")
            continue
        lines, figures = EACH[part](say)
        table += lines
        rows += figures
    return {"bench": "recordings", "rows": rows, "table": table}, True
