"""A run's log as arrays: reads the run.bag and run.csv that the node `telemetry` writes."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from robot_control._robot_control import BagError, TraceError, read_run_bag, read_run_header
from robot_control.common.files import MAX_TABLE, check_input, printable, utf8

BAG_MAGIC = b"#ROSBAG"
BLACK_BOX_MAGIC = b"RCBLACK"
MAX_LINE = 1 << 20
"""characters of a run.csv"""

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

Log = Mapping[str, FloatArray]
"""Column name → values, shape (rows,), a row per cycle; NaN where a node published nothing. The columns, with
their units, stand in src/telemetry/columns.cpp; the same log comes out of `ClosedLoop.run`."""


class LogError(ValueError):
    """The file is no log, or holds no rows."""


class Columns(dict[str, FloatArray]):
    """The `Log` of a file; a missing column that is asked for is reported as an error of the file."""

    def __init__(self, path: Path, columns: Mapping[str, FloatArray]) -> None:
        super().__init__(columns)
        self._path = path

    def __missing__(self, name: str) -> FloatArray:
        raise LogError(f"{self._path}: no column {name}, which is needed here")


@dataclass(frozen=True)
class RunLog:
    """A log with the data that describe its rows."""

    columns: dict[str, FloatArray]
    """Columns of the last run; see `Log`."""
    ros_time: FloatArray | None
    """s, of each row; None for a CSV, which does not hold it."""
    header: Mapping[str, Any]
    """The header of run.bag, with the fields of msg/TraceHeader.msg; empty for a CSV."""
    runs: int
    """Number of runs in the file."""
    lost: int
    """Rows that telemetry counted as lost before the last one in the file; 0 for a CSV, which does not hold it."""
    cut: str
    """The part that could be read of a file that was not completed; empty if the file is whole."""

    @property
    def notes(self) -> list[str]:
        """Sentences that name the part of the file that was read, if it is not all of it."""
        parts = [part for part in (self.header.get("missing"), self.cut) if part]
        return [*parts, *notes_on_runs(self.runs)]


def notes_on_runs(runs: int) -> list[str]:
    """The note for a file with several runs, of which the last one was read."""
    return [f"{runs} runs in the file; this is the last one"] if runs > 1 else []


def is_bag(path: Path) -> bool:
    """Whether the file begins as a ROS bag does.

    Raises:
        InputFileError, OSError: it is no file to read.
        LogError: it is a black box.
    """
    check_input(path, MAX_TABLE)
    with path.open("rb") as file:
        begin = file.read(len(BAG_MAGIC))
    if begin == BLACK_BOX_MAGIC:
        raise LogError(f"{path} is a black box: blackbox.py makes a run.bag of it")
    return begin == BAG_MAGIC


def is_run_log(path: Path) -> bool:
    """Whether the file is a run.bag: a ROS bag that begins with a TraceHeader."""
    try:
        return is_bag(path) and bool(read_run_header(utf8(path)))
    except (BagError, TraceError):
        return False


def read_log(path: Path, columns: Sequence[str] = ()) -> dict[str, FloatArray]:
    """All rows of the last run in the file, run.bag or run.csv; `columns`: only these, where they are there.

    A last line that was cut short, because its writer was killed, is left out.
    """
    return read_run(path, columns).columns


def read_run(path: Path, columns: Sequence[str] = ()) -> RunLog:
    """Reads rows as `read_log` does, with the data that describe them."""
    return _read_bag(path, columns) if is_bag(path) else _read_csv(path, columns)


def _read_bag(path: Path, columns: Sequence[str]) -> RunLog:
    try:
        read = read_run_bag(utf8(path), list(columns))
    except (BagError, TraceError, RuntimeError) as error:
        named = str(error).startswith(str(path))
        raise LogError(str(error) if named else f"{path}: {error}") from None
    table = Columns(path, read["columns"])
    if not read["runs"]:
        raise LogError(f"{path}: no rows" + (f"; {read['cut']}" if read["cut"] else ""))
    return RunLog(table, read["ros_time"], read["header"], read["runs"], read["lost"], read["cut"])


def _read_csv(path: Path, columns: Sequence[str]) -> RunLog:
    with path.open(newline="", errors="replace") as file:
        try:
            lines = csv.reader(_lines_of(file))
            header = next(lines, [])
            rows = []
            short = 0
            for row in lines:
                if short:
                    raise LogError(f"{path}, line {short}: it has not the {len(header)} cells of the header")
                if len(row) == len(header):
                    rows.append(row)
                elif row:
                    short = lines.line_num  # the last line may be cut short
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
    for name in ("run", "cycle"):
        if not np.isfinite(table[:, header.index(name)]).all():
            raise LogError(f"{path}: a row has no finite number in its column {name}")
    run = table[:, header.index("run")]
    table = table[run == run.max()]
    wanted = {name: table[:, i] for i, name in enumerate(header) if not columns or name in columns}
    return RunLog(Columns(path, wanted), None, {}, len(np.unique(run)), 0, "")


def _lines_of(file: TextIO) -> Iterator[str]:
    """Yields the lines up to one with NUL, which a disk that lost power leaves.

    Raises:
        csv.Error: a line is longer than any of a log.
    """
    while (line := file.readline(MAX_LINE)) and "\0" not in line:
        if len(line) == MAX_LINE:
            raise csv.Error(f"it has a line of {MAX_LINE} characters")
        yield line


def joint_names(log: Log) -> list[str]:
    """Joints in the log, in the order of its columns: those with a column `<joint>_effort`."""
    return [name.removesuffix("_effort") for name in log if name.endswith("_effort")]


def last(values: FloatArray) -> float:
    """The last value that is not NaN; NaN when there is none."""
    known = values[~np.isnan(values)]
    return float(known[-1]) if known.size else float("nan")
