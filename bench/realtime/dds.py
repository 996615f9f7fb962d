"""The loop of one robot, alone and while the bridges and DDS of another one work on the other cores, in turn.

The other robot is quadbot as a simulated Go2 (tests/drivers/unitree_go/go_walk.cpp), whose physics runs there, too. Its
states and commands pass DDS on the loopback at 500 Hz.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from robot_control.data.run_log import Log

from bench.devices.walk_bridge import bridge_of, drive_file
from bench.realtime.chain import CHAIN
from bench.realtime.jitter import median_interval, wake_up
from bench.realtime.loops import FREE_WHEELS, loop_for
from bench.realtime.machine import CORE
from bench.rows import Row, Say, bounded, compared

SECONDS = 4.0  # of a block
START = 4.0  # s until the other robot walks
WALK = 3600.0  # s; it is ended before
MAX_RATIO = 1.1


def require_bridge(build: Path) -> None:
    """Raises RuntimeError with the remedy where the bridge or another core is missing."""
    if not bridge_of(build).exists() or not walk_of(build).exists():
        raise RuntimeError("no unitree_bridge: scripts/setup --unitree, then build; without it, name the other parts")
    if not other_cores():
        raise RuntimeError(f"no core beside {CORE}: run this on a machine with two")


def walk_of(build: Path) -> Path:
    """The other robot, which is built with the tests."""
    return build / "tests/drivers/go_walk"


def other_cores() -> list[int]:
    """Those that the loop does not use."""
    return sorted(os.sched_getaffinity(0) - {CORE})


@contextlib.contextmanager
def traffic(build: Path) -> Iterator[None]:
    """The other robot walks while the block lasts.

    Raises:
        RuntimeError: one of its programs has ended.
    """
    program, placed = bridge_of(build), ["taskset", "-c", ",".join(map(str, other_cores()))]
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as started:
        driver, robot = (drive_file(Path(folder) / f"{end}.yaml") for end in ("driver", "robot"))

        def start(*words: str | Path) -> subprocess.Popen[bytes]:
            process = subprocess.Popen([*placed, *words], stdout=subprocess.DEVNULL)
            started.callback(process.wait)
            started.callback(process.kill)
            return process

        bridge = start(program, driver)
        programs = [bridge, start(program, robot, "--side", "robot")]
        programs.append(start(walk_of(build), driver, robot, str(bridge.pid), "0", str(WALK), "1"))
        time.sleep(START)
        yield
        if any(process.poll() is not None for process in programs):
            raise RuntimeError("the other robot has ended")


def figures(rows: Log) -> dict[str, float]:
    """The p99 of each, µs."""
    begin, end = CHAIN
    chain = (rows[end] - rows[begin]) / 1000
    times = {"wake-up": wake_up(rows), "sensors to command": chain}
    return {name: float(np.nanpercentile(values, 99)) for name, values in times.items()}


def bench(blocks: int, programs: Path, say: Say) -> tuple[list[Row], bool]:
    """The rows, and whether no lower end exceeds the bound."""
    alone, beside = [], []
    for block in range(blocks):
        say(f"dds: block {block + 1} of {blocks}")
        alone.append(figures(loop_for(SECONDS, programs, FREE_WHEELS)))
        with traffic(programs.parent):
            beside.append(figures(loop_for(SECONDS, programs, FREE_WHEELS)))
    rows: list[Row] = []
    good = True
    for name in alone[0]:
        pairs = [(with_it[name], without[name]) for with_it, without in zip(beside, alone, strict=True)]
        medians = [float(np.median(values)) for values in zip(*pairs, strict=True)]
        low, middle, high = median_interval([a / b for a, b in pairs])
        rows.append(compared(f"{name}, p99, beside DDS", medians[0], "µs", medians[1], "that of the loop alone"))
        rows.append(bounded(f"ratio of p99, {name}", middle, f"[{low:.2f}, {high:.2f}]", MAX_RATIO))
        good = good and low <= MAX_RATIO
    return rows, good
