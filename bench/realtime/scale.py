"""How many robots one machine carries at 1 kHz: N loops on N buses, spread over the cores, beside cyclictest."""

from __future__ import annotations

import os
import time
from pathlib import Path

import numpy as np
from robot_control.data.run_log import Log

from bench.realtime.loops import FIRST, LAST, Loop
from bench.realtime.machine import latencies, start_cyclictest
from bench.rows import Row, Say, bounded, compared

NUMBERS = (1, 2, 4, 6, 8)
MIN_ROBOTS = 4
MAX_MISSED = 0.1  # % of the cycles, beyond cyclictest's own
SECONDS = 10.0
PERIOD = 1000.0  # µs


def missed(rows: Log) -> float:
    """Share of the cycles, %, that found no fresh command or permit, or that began a period late."""
    cycles = float(rows["cycle"][-1] - rows["cycle"][0])
    counted = sum(float(rows[name][-1] - rows[name][0]) for name in ("held", "missed", "late_permits"))
    slips = float(np.count_nonzero(np.diff(rows["slipped_ns"]) > 0))
    return 100 * (counted + slips) / cycles


def bench(_blocks: int, programs: Path, say: Say) -> tuple[list[Row], bool]:
    """The rows, and whether so many robots miss no more than that."""
    rows: list[Row] = []
    carried = 0
    cores = len(os.sched_getaffinity(0))
    for number in NUMBERS:
        say(f"scale: {number} robots")
        loops: list[Loop] = []
        try:
            buses = [f"scale-{os.getpid()}-{i}" for i in range(number)]
            loops.extend(Loop(programs, bus, {"robot.core": i % cores}) for i, bus in enumerate(buses))
            for loop in loops:
                loop.await_start()
            time.sleep((FIRST + LAST) / 1000)
            reference = latencies(start_cyclictest(SECONDS))
            worst = max(missed(loop.end()) for loop in loops)
        finally:
            for loop in loops:
                loop.close()
        own = 100 * float(np.count_nonzero(reference >= PERIOD)) / reference.size
        rows.append(compared(f"{number} robots, missed cycles of the worst", worst, "%", own, "cyclictest ≥ 1 ms"))
        if worst <= own + MAX_MISSED:
            carried = number
    rows.append(bounded("robots with at most 0.1 % missed beyond cyclictest", carried, "robots", MIN_ROBOTS))
    return rows, carried >= MIN_ROBOTS
