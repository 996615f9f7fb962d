"""Reduces many rows to few pixels: the least and the largest value of every stretch stay at their times."""

import numpy as np

from robot_control.data.run_log import FloatArray

BINS = 1500
"""A plot is some 1200 pixels wide."""


def decimated(time: FloatArray, values: FloatArray, bins: int = BINS) -> tuple[FloatArray, FloatArray]:
    """At most two points per bin, in order of time; one NaN for a bin that holds nothing else."""
    if time.size <= 2 * bins:
        return time, values
    size = -(-time.size // bins)
    padding = size * bins - time.size
    table = np.concatenate([values, np.full(padding, np.nan)]).reshape(bins, size)
    first = np.arange(bins) * size
    empty = np.all(np.isnan(table), axis=1)
    least = np.where(empty, 0, np.argmin(np.where(np.isnan(table), np.inf, table), axis=1))
    largest = np.where(empty, 0, np.argmax(np.where(np.isnan(table), -np.inf, table), axis=1))
    rows = np.sort(np.column_stack([first + least, first + largest]), axis=1)
    double = (rows[:, 0] == rows[:, 1]) | (rows[:, 1] >= time.size)
    chosen = rows.reshape(-1)[np.column_stack([rows[:, 0] < time.size, ~double]).reshape(-1)]
    return time[chosen], values[chosen]
