"""Samples out of a CSV file, by the names of its columns."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import TextIO

import numpy as np

from robot_control.data.estimate.samples import ACCEL, GYRO, FloatArray, InputError, IntArray, Samples
from robot_control.files.files import MAX_TABLE, check_input, listed

NAMES = ("time", "left", "right", *GYRO, *ACCEL)
MAX_LINE = 100_000
"""characters; below the field limit of Python's csv, and a row of run.csv has some 3000"""
TIME_UNITS = {"s": 10**9, "ms": 10**6, "us": 10**3, "ns": 1}  # in ns
GYRO_UNITS = {"rad/s": 1.0, "deg/s": math.pi / 180}
ACCEL_UNITS = {"m/s2": 1.0, "g": 9.80665}


@dataclass(frozen=True)
class CsvForm:
    """How a CSV file is to be understood."""

    columns: Mapping[str, str] = field(default_factory=dict)  # our name → the file's
    counts_per_turn: float = 2 * math.pi  # counts of the wheel columns per turn; 2π: they are in rad
    time_unit: str = "s"
    gyro_unit: str = "rad/s"
    accel_unit: str = "m/s2"


def read_csv(path: Path, form: CsvForm) -> Samples:
    """Reads a file with one header line.

    Raises:
        InputError: no header, a column that is not there, a cell that is no number, time that does not increase; with
            the line.
        OSError: it cannot be opened.
    """
    check_input(path, MAX_TABLE)
    with path.open(newline="", encoding="utf-8-sig", errors="replace") as file:
        table = _Table(path, _lines(path, file))
        return _read_table(table, form)


def _lines(path: Path, file: TextIO) -> Iterator[str]:
    """The lines of a text; reading stops early in a file that has none."""
    number = 0
    while line := file.readline(MAX_LINE + 1):
        number += 1
        if len(line) > MAX_LINE:
            raise InputError(f"{path}, line {number}: longer than {MAX_LINE} characters; check that it is a CSV")
        if "\0" in line:
            raise InputError(f"{path}, line {number}: contains a NUL character; check that it is a CSV")
        yield line


def _read_table(table: _Table, form: CsvForm) -> Samples:
    columns = _columns_of(table, form)
    time_ns, values = table.read(columns["time"], form.time_unit, [columns[name] for name in columns])
    cells = dict(zip(columns, values.T, strict=True))
    to_radians = 2 * math.pi / form.counts_per_turn
    accel = None
    if ACCEL[0] in cells:
        accel = np.column_stack([cells[name] for name in ACCEL]) * ACCEL_UNITS[form.accel_unit]
    gyro = _gyro(cells, GYRO_UNITS[form.gyro_unit])
    return Samples(time_ns, cells["left"] * to_radians, cells["right"] * to_radians, gyro, accel, table.notes)


def _gyro(cells: Mapping[str, FloatArray], scale: float) -> FloatArray | None:
    """Angular velocity; a gyro with one axis has zeros in the others."""
    if "gyro_z" not in cells:
        return None
    absent = np.where(np.isnan(cells["gyro_z"]), np.nan, 0.0)
    return np.column_stack([cells.get(name, absent) for name in GYRO]) * scale


def _columns_of(table: _Table, form: CsvForm) -> dict[str, str]:
    """Our name → the file's, of all columns to be read."""
    unknown = sorted(set(form.columns) - set(NAMES))
    if unknown:
        raise InputError(f"--columns names {', '.join(unknown)}; there are {', '.join(NAMES)}")
    missing = [name for name in form.columns.values() if name not in table.header]
    columns = {name: form.columns.get(name, name) for name in NAMES}
    missing += [columns[name] for name in ("time", "left", "right") if columns[name] not in table.header]
    if missing:
        what = f"{table.path}: no column {', '.join(dict.fromkeys(missing))}; its header is {listed(table.header)}"
        raise InputError(f"{what}. Set them: --columns time=…,left=…,right=…,gyro_z=…")
    found = {name: column for name, column in columns.items() if column in table.header}
    for group, needed in ((GYRO, ("gyro_z",)), (ACCEL, ACCEL)):
        present = [name for name in group if name in found]
        absent = [columns[name] for name in needed if name not in found]
        if present and absent:
            raise InputError(f"{table.path}: there is {found[present[0]]}, but no {', '.join(absent)}")
    return found


class _Table:
    """The rows of a file below its header."""

    def __init__(self, path: Path, file: Iterator[str]) -> None:
        self.path = path
        self.notes: list[str] = []
        first = next(file, "")
        self._delimiter = max(",;\t", key=first.count)
        self.header = [name.strip() for name in next(csv.reader([first], delimiter=self._delimiter), [])]
        self.header[:1] = [name.lstrip("# ") for name in self.header[:1]]
        if not any(self.header):
            raise InputError(f"{path}: empty; the first line must name the columns")
        twice = sorted({name for name in self.header if self.header.count(name) > 1})
        if twice:
            raise InputError(f"{path}: two columns are named {listed(twice)}")
        self._file = file

    def read(self, time: str, unit: str, names: list[str]) -> tuple[IntArray, FloatArray]:
        """Time in ns, and the named columns."""
        at = self.header.index(time)
        cells = [self.header.index(name) for name in names]
        stamps: list[int] = []
        rows: list[list[float]] = []
        for line, row in self._rows():
            stamp = self._stamp(line, row[at], TIME_UNITS[unit])
            if stamps and stamp <= stamps[-1]:
                what = f"{self.path}, line {line}: {time} is {row[at]}, not after the row before"
                raise InputError(f"{what}; time must strictly increase: sort the file, and give one row to each time")
            stamps.append(stamp)
            rows.append([self._number(line, name, row[cell]) for name, cell in zip(names, cells, strict=True)])
        if not rows:
            raise InputError(f"{self.path}: no rows below the header")
        return np.array(stamps, dtype=np.int64), np.array(rows, dtype=np.float64)

    def _rows(self) -> Iterator[tuple[int, list[str]]]:
        """Number and cells of each line that is not empty. A last line that was cut short is left out."""
        width = len(self.header)
        short: tuple[int, int] | None = None
        for line, row in self._cells():
            if short is not None:
                raise InputError(f"{self.path}, line {short[0]}: {short[1]} cells, the header has {width}")
            if not any(cell.strip() for cell in row):
                continue
            if len(row) > width:
                raise InputError(f"{self.path}, line {line}: {len(row)} cells, the header has {width}")
            if len(row) < width:
                short = (line, len(row))
                continue
            yield line, row
        if short is not None:
            self.notes.append(f"line {short[0]}, the last one, is incomplete and ignored")

    def _cells(self) -> Iterator[tuple[int, list[str]]]:
        """Number and cells of each line. A quotation mark that is not closed would make one cell of all lines below."""
        reader = csv.reader(self._file, delimiter=self._delimiter)
        line = 2
        try:
            for row in reader:
                if reader.line_num >= line:
                    break
                yield line, row
                line += 1
            else:
                return
        except csv.Error:
            pass
        raise InputError(f"{self.path}, line {line}: a quotation mark is not closed in this line")

    def _stamp(self, line: int, cell: str, unit_ns: int) -> int:
        try:
            stamp = Decimal(cell.strip()) * unit_ns
            if not stamp.is_finite():
                raise InvalidOperation
        except InvalidOperation:
            why = f"{self.path}, line {line}: the time is {cell.strip()!r}; every row needs a finite number"
            raise InputError(why) from None
        if abs(stamp) >= 2**62:  # so that a difference of two is a number of 64 bits
            why = f"{self.path}, line {line}: the time is {cell.strip()}, beyond 146 years; check --time-unit"
            raise InputError(why)
        return round(stamp)

    def _number(self, line: int, name: str, cell: str) -> float:
        try:
            return float(cell) if cell.strip() else math.nan
        except ValueError:
            what = f"{self.path}, line {line}, column {name}: {cell.strip()!r} is not a number"
            raise InputError(f"{what}; leave the cell of an absent sample empty") from None
