"""A log as the table run.csv: a header line, then one line per row of all runs."""

import csv
import math
from collections.abc import Mapping
from pathlib import Path

from robot_control._robot_control import each_part_of_run_bag
from robot_control.data.run_log import FloatArray
from robot_control.files.files import utf8


def write_csv(source: Path, target: Path) -> str:
    """Writes the columns of `read_run`. A number reads back as the same bits; where there is none, the cell is empty.
    Returns `RunLog.cut`.

    Raises:
        BagError, TraceError, RuntimeError, OSError: no log can be read, or no table written.
    """
    with target.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")

        def write(columns: Mapping[str, FloatArray], integers: set[str]) -> None:
            if file.tell() == 0:
                writer.writerow(columns)
            cells = (_cells(values, integer=name in integers) for name, values in columns.items())
            writer.writerows(zip(*cells, strict=True))

        return each_part_of_run_bag(utf8(source), write)


def _cells(values: FloatArray, *, integer: bool) -> list[float | int | str]:
    shown = int if integer else float
    return ["" if math.isnan(value) else shown(value) for value in values.tolist()]
