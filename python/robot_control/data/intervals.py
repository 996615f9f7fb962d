"""Finds the stretches in which a condition lasts."""

import numpy as np

from robot_control.data.run_log import BoolArray, FloatArray


def intervals(true: BoolArray, column: FloatArray | None = None) -> list[tuple[int, int]]:
    """First row and the row behind the last one of every stretch.

    `column` is the one that the condition judges. A row in which it is NaN neither begins nor ends a stretch.
    """
    rows = np.arange(true.size) if column is None else np.flatnonzero(~np.isnan(column))
    edges = np.diff(np.concatenate([[False], true[rows], [False]]).astype(np.int8))
    begins, ends = rows[edges[:-1] == 1], np.append(rows, true.size)[edges == -1]
    return list(zip(begins.tolist(), ends.tolist(), strict=True))


def joined(found: list[tuple[int, int]], gap: int) -> list[tuple[int, int]]:
    """Joins stretches that at most `gap` rows separate."""
    result: list[tuple[int, int]] = []
    for begin, end in found:
        if result and begin - result[-1][1] <= gap:
            result[-1] = (result[-1][0], end)
        else:
            result.append((begin, end))
    return result


def runs_of(values: FloatArray) -> list[tuple[int, int, int]]:
    """First row, the row behind the last one, and value of every stretch of one whole number; NaN is none."""
    known = ~np.isnan(values)
    codes = np.where(known, np.nan_to_num(values), -1).astype(np.int64)
    edges = np.flatnonzero(np.diff(codes)) + 1
    begins = np.concatenate([[0], edges])
    ends = np.concatenate([edges, [codes.size]])
    found = zip(begins.tolist(), ends.tolist(), codes[begins].tolist(), strict=True)
    return [(begin, end, value) for begin, end, value in found if value >= 0]
