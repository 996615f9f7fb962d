"""The table of `scripts/bench board_clock`: a motor board's samples have their own times in spite of jitter."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from bench.devices.bench import row
from bench.devices.disturbed_drive import BUSES, DisturbedDrive, rms, run_drive
from bench.devices.loss_trial import BOARD
from bench.rows import Result, Say, judged
from bench.runs.runner import Processes

ODOMETRY = 1.1
"""Bound of the odometry's error on a line with jitter, by that on a line with a constant delay."""
SECONDS = 1800.0
SEEDS = 8


def bench(program: Callable[..., dict[str, Any]], share: float, say: Say) -> Result:
    """The table, and whether every figure keeps its bound.

    Args:
        program: runs one of bench/programs.
        share: of the drives' time.
        say: receives progress.
    """
    rows = list(program("bench_board_clock")["rows"])
    lines = (BUSES[0], "late")
    drives = [DisturbedDrive(BOARD, line, share * SECONDS, seed) for seed in range(1, 1 + SEEDS) for line in lines]
    errors = [figures.odometry for figures in Processes().outcomes(run_drive, drives, say)]
    ratio = rms(errors[1::2]) / rms(errors[::2])
    rows.append(row(f"error of the odometry, {SEEDS} seeds, of that with exact stamps", ratio, "", ODOMETRY))
    return judged("board_clock", rows)
