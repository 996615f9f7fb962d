"""Measures what a black box holds after SIGKILL of all nodes. Four nodes and a telemetry run as processes on the wall
clock, without ROS, and are killed at random moments.

A trial fails if its black box cannot be read or has a gap, or if too many cycles are missing. The missing cycles of a
node lie between its newest row in the black box and its newest published frame. That frame is still in shared memory.
"""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from robot_control._robot_control import RunLogError, save_black_box
from robot_control.data.run_log import read_log
from robot_control.loop.roles import LOOP, TELEMETRY

from bench.log_bench import row
from bench.participants import START_LIMIT, await_log, command, remove_shared_memory, script, support_program
from bench.rows import Result, Say

ALL_TRIALS = 100
MAX_MISSING = 10.0  # ms
MAX_DRIVE = 2.0  # s from the first second in run.bag to the kill
A_SECOND = 100_000  # bytes, less than one of run.bag
PROCESSES = (*LOOP, TELEMETRY)


def bench(first: int, trials: int, programs: Path, say: Say) -> Result:
    """The table of `trials` from seed `first` on, and whether all figures meet their bounds."""
    missing: list[float] = []
    bad = 0
    with tempfile.TemporaryDirectory(prefix="blackbox-") as name:
        folder = Path(name)
        (folder / "script.csv").write_text(script(60_000))
        try:
            for seed in range(first, first + trials):
                nodes = start(programs, folder)
                try:
                    missing.append(trial(nodes, folder, programs, seed))
                except (RunLogError, RuntimeError) as error:
                    bad += 1
                    say(f"seed {seed}: {error}")
                finally:
                    for node in nodes:
                        node.kill()
                        node.wait()
        finally:
            remove_shared_memory(bus())
    figures = sorted(missing) or [float("inf")]
    rows = [
        row("black boxes not readable or with a gap", bad, "of " + str(trials), 0),
        row("missing, median", figures[len(figures) // 2], "ms", 0),
        row("missing, most", figures[-1], "ms", MAX_MISSING),
        row("with more missing than that", sum(each > MAX_MISSING for each in figures), "of " + str(trials), 0),
    ]
    return {"bench": "blackbox", "rows": rows}, bad == 0 and figures[-1] <= MAX_MISSING


def bus() -> str:
    """All trials share one bus, so that shared memory of killed nodes is used again."""
    return f"blackbox-{os.getpid()}"


def start(programs: Path, folder: Path) -> list[subprocess.Popen[bytes]]:
    """Starts all nodes in one process group."""
    (folder / "run.bag").unlink(missing_ok=True)
    settings = {"telemetry.black_box": 0.03, "telemetry.incidents": 0}
    nodes: list[subprocess.Popen[bytes]] = []
    for node in PROCESSES:
        group = nodes[0].pid if nodes else 0
        words = command(programs, node, bus(), folder, settings)
        nodes.append(subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, process_group=group))
    return nodes


def trial(nodes: list[subprocess.Popen[bytes]], folder: Path, programs: Path, seed: int) -> float:
    """Kills all nodes at the same moment; returns the missing cycles of the worst node, ms.

    Raises:
        RuntimeError: a node ended before, or the black box has a gap.
        RunLogError: it cannot be read.
    """
    await_log(folder / "run.bag", A_SECOND)
    time.sleep(np.random.default_rng(seed).uniform(0, MAX_DRIVE))
    ended = [name for name, node in zip(PROCESSES, nodes, strict=True) if node.poll() is not None]
    os.killpg(nodes[0].pid, signal.SIGKILL)
    for node in nodes:
        node.wait(START_LIMIT)
    if ended:
        raise RuntimeError(f"{', '.join(ended)} ended by itself")
    out = folder / f"trial-{seed}"
    newest_ns: list[int]
    rows, newest_ns, missing = save_black_box(str(folder / "black_box" / "ring"), str(out / "run.bag"))
    if missing:
        raise RuntimeError(missing)
    cycles = read_log(out / "run.bag", ["cycle"])["cycle"]
    if rows == 0 or np.any(np.diff(cycles) != 1):
        raise RuntimeError(f"{rows} cycles, with gaps")
    missing_ns = [published - stored for published, stored in zip(newest_stamps(programs), newest_ns, strict=True)]
    return max(missing_ns) * 1e-6


def newest_stamps(programs: Path) -> list[int]:
    """Stamps of the newest frame that each node has published, ns."""
    program = support_program(programs, "rc_newest_stamps")
    answer = subprocess.run([program, "--bus", bus()], capture_output=True, text=True, check=True)
    return [int(line) for line in answer.stdout.split()]
