"""Our wake-up latency against cyclictest's: same core, priority and cpu_dma_latency, in blocks that alternate."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from robot_control.data.run_log import FloatArray, Log
from robot_control.setup.doctor.measure import interval

from bench.realtime.loops import loop_for
from bench.realtime.machine import latencies, load, shallow_sleep, start_cyclictest
from bench.rows import Row, Say, bounded, compared

MAX_RATIO = 1.3
BLOCKS = 10
SECONDS = 4.0  # of a block


def wake_up(rows: Log) -> FloatArray:
    """Returns the latencies of the driver, µs; a tick that slips was late by what slipped (docs/timing.md)."""
    slipped = np.diff(rows["slipped_ns"], prepend=rows["slipped_ns"][0])
    values: FloatArray = (rows["driver_woke_ns"] + slipped) / 1000
    return np.asarray(values[~np.isnan(values)], dtype=float)


def median_interval(values: Sequence[float]) -> tuple[float, float, float]:
    """The median between the ends of its interval (doctor.py --measure judges by the same)."""
    low, high = interval(sorted(values))
    return low, float(np.median(values)), high


def bench(blocks: int, programs: Path, say: Say) -> tuple[list[Row], bool]:
    """The rows, and whether no lower end exceeds the bound."""
    rows: list[Row] = []
    good = True
    for busy in (False, True):
        for shallow in (False, True):
            name = f"{'under load' if busy else 'idle'}, cpu_dma_latency {'0' if shallow else 'not asked'}"
            ours, theirs = [], []
            with load(asked=busy), shallow_sleep(asked=shallow):
                for block in range(blocks):
                    say(f"jitter, {name}: block {block + 1} of {blocks}")
                    ours.append(float(np.percentile(wake_up(loop_for(SECONDS, programs)), 99)))
                    theirs.append(float(np.percentile(latencies(start_cyclictest(SECONDS)), 99)))
            low, middle, high = median_interval([a / b for a, b in zip(ours, theirs, strict=True)])
            rows.append(
                compared(f"p99, {name}", float(np.median(ours)), "µs", float(np.median(theirs)), "cyclictest p99")
            )
            rows.append(bounded(f"ratio of p99, {name}", middle, f"[{low:.2f}, {high:.2f}]", MAX_RATIO))
            good = good and low <= MAX_RATIO
    return rows, good
