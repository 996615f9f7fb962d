"""A run's log as arrays: reads the run.bag that the node `telemetry` writes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml  # type: ignore[import-untyped]
from numpy.typing import NDArray

from robot_control._robot_control import BagError, NoTraceError, TraceError, read_run_bag, read_run_header
from robot_control.files.files import MAX_TABLE, check_input, utf8
from robot_control.loop.roles import ESTIMATOR, Kind

BAG_MAGIC = b"#ROSBAG"

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

Log = Mapping[str, FloatArray]
"""Column name → values, shape (rows,), a row per cycle; NaN where a node published nothing. msg/Trace.msg names the
columns and their units; `ClosedLoop.run` gives the same columns."""


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
    """The columns of the last run, as in `Log`."""
    ros_time: FloatArray
    """s, of each row"""
    header: Mapping[str, Any]
    """The header of run.bag; its fields are those of msg/TraceHeader.msg."""
    runs: int
    """Number of runs in the file."""
    lost: int
    """Rows that telemetry counted as lost before the last one in the file."""
    cut: str
    """The part that could be read of a file that was not completed; empty if the file is whole."""

    @property
    def notes(self) -> list[str]:
        """Sentences that name the part of the file that was read, if it is not all of it."""
        several = f"{self.runs} runs in the file; this is the last one" if self.runs > 1 else ""
        return [part for part in (self.header.get("missing"), self.cut, several) if part]


def is_bag(path: Path) -> bool:
    """Whether the file begins as a ROS bag does.

    Raises:
        InputFileError, OSError: it is no file to read.
    """
    check_input(path, MAX_TABLE)
    with path.open("rb") as file:
        return file.read(len(BAG_MAGIC)) == BAG_MAGIC


def is_run_log(path: Path) -> bool:
    """Whether the file is a run.bag: a ROS bag that begins with a TraceHeader.

    Raises:
        TraceError: it begins with a damaged one.
    """
    try:
        return is_bag(path) and bool(read_run_header(utf8(path)))
    except (BagError, NoTraceError):
        return False


def kind_in(header: Mapping[str, Any]) -> Kind:
    """The kind of robot that the header of a log names."""
    return Kind(str(header.get("kind", "")))


def odom_frame(parameters: str) -> str:
    """The name of the frame odom, from the YAML text in a log's header."""
    blocks = yaml.safe_load(parameters) or {}
    return str((blocks.get(ESTIMATOR) or {}).get("odom_frame", "odom"))


def read_log(path: Path | str, columns: Sequence[str] = ()) -> dict[str, FloatArray]:
    """All rows of the last run in a run.bag; `columns`: only these, where they are there.

    A last chunk that was cut short, because its writer was killed, is left out.
    """
    return read_run(path, columns).columns


def read_run(path: Path | str, columns: Sequence[str] = ()) -> RunLog:
    """As `read_log`, with what stands around the rows."""
    path = Path(path)
    if not is_bag(path):
        raise LogError(f"{path} is not a run.bag (export.py makes a run.csv of one, for other programs)")
    try:
        read = read_run_bag(utf8(path), list(columns))
    except (BagError, TraceError, RuntimeError) as error:
        named = str(error).startswith(str(path))
        raise LogError(str(error) if named else f"{path}: {error}") from None
    table = Columns(path, read["columns"])
    if not read["runs"]:
        raise LogError(f"{path}: no rows" + (f"; {read['cut']}" if read["cut"] else ""))
    return RunLog(table, read["ros_time"], read["header"], read["runs"], read["lost"], read["cut"])


def joint_names(log: Log) -> list[str]:
    """Joints in the log, in the order of its columns: those with a column `<joint>_effort`."""
    return [name.removesuffix("_effort") for name in log if name.endswith("_effort")]


def last(values: FloatArray) -> float:
    """The last value that is not NaN; NaN when there is none."""
    known = values[~np.isnan(values)]
    return float(known[-1]) if known.size else float("nan")
