"""A run's log as arrays: reads the run.csv that the node `telemetry` writes."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from robot_control.common.files import LARGEST_TABLE, check_input, printable

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

Log = Mapping[str, FloatArray]
"""Column name → values, shape (rows,), a row per cycle; NaN where a node published nothing. The columns, with
their units, stand in src/telemetry/columns.cpp; the same log comes out of `ClosedLoop.run`."""


class LogError(ValueError):
    """The file is not a log, or holds no rows."""


def read_log(path: Path) -> dict[str, FloatArray]:
    """All rows of the last run in the file.

    A last line that was cut short, because its writer was killed, is left out.
    """
    check_input(path, LARGEST_TABLE)
    with path.open(newline="", errors="replace") as file:
        try:
            lines = csv.reader(file)
            header = next(lines, [])
            rows = [row for row in lines if len(row) == len(header)]
        except csv.Error as error:
            raise LogError(f"{path}: is no CSV: {error}") from None
    if "run" not in header or "cycle" not in header:
        raise LogError(f"{path}: no columns `run` and `cycle`; its header is {printable(str(header[:5]))}")
    if not rows:
        raise LogError(f"{path}: no rows")
    try:
        table = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows])
    except ValueError as error:
        raise LogError(f"{path}: {error}") from None
    run = table[:, header.index("run")]
    table = table[run == run.max()]
    return {name: table[:, i] for i, name in enumerate(header)}


def joint_names(log: Log) -> list[str]:
    """Joints in the log, in the order of its columns: those with a column `<joint>_effort`."""
    return [name.removesuffix("_effort") for name in log if name.endswith("_effort")]


def last(values: FloatArray) -> float:
    """The last value that is not NaN; NaN when there is none."""
    known = values[~np.isnan(values)]
    return float(known[-1]) if known.size else float("nan")
