"""Many loops in one process: their speed, what Python adds to a step, and what a cycle costs beside the physics.

speed          ClosedLoops against bare mj_step in the same threads (bench/programs/bench_loops.cpp)
python         a step of 64 loops without a cycle: arrays, columns and the way to the compiled part
instructions   of 2,000 cycles of a ClosedLoop that drives, counted by callgrind; physics: mj_step1 and mj_step2
"""

from __future__ import annotations

import json
import re
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from robot_control import ClosedLoops

from bench.rows import Result, Row, Say, bounded, compared, judged, plain

LEAST_SHARE = 0.75  # of bare mj_step in the same threads
LEAST_SCALING = 0.9  # per thread, of that of bare mj_step
MOST_PYTHON = 20.0  # µs per step
MOST_BESIDE = 40.0  # million instructions in 2,000 cycles
LOOPS, ROUNDS, CALLS = 64, 50, 20
COLUMNS = ("estimate_x", "estimate_y", "estimate_yaw", "estimate_linear", "estimate_angular", "permit_action")
PHYSICS = ("mj_step1", "mj_step2")
LEAST = {
    "ClosedLoops, 1 thread": LEAST_SHARE,
    "ClosedLoops, 2 threads": LEAST_SHARE,
    "scaling from 1 thread to 2": LEAST_SCALING,
}
"""Bound of the ratio of each figure of the program"""


def speed(programs: Path, params: Path) -> list[Row]:
    """The absolute figures; below them their ratios, each with its bound."""
    done = subprocess.run([programs / "bench_loops", params], stdout=subprocess.PIPE, check=True, text=True)
    rows: list[Row] = json.loads(done.stdout)["rows"]
    by_name = {row["name"]: row for row in rows}
    figures = [plain(row["name"], row["value"], row["unit"]) for row in rows]
    return figures + [
        bounded(f"lowest {name}", by_name[name]["ratio"], f"of {by_name[name]['reference_name']}", bound)
        for name, bound in LEAST.items()
    ]


def python() -> list[Row]:
    """The least of many rounds, for other programs only add to it."""
    loops = ClosedLoops(LOOPS, threads=1)
    commands = np.full((LOOPS, 2), (0.5, 0.2))
    loops.step(1, commands, COLUMNS)
    times = []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        for _ in range(CALLS):
            loops.step(0, commands, COLUMNS)
        times.append((time.perf_counter() - began) / CALLS)
    return [bounded(f"Python, per step of {LOOPS} loops", 1e6 * min(times), "µs", MOST_PYTHON)]


def instructions(programs: Path, params: Path) -> list[Row]:
    """Counts in the whole program and in the functions of the physics engine."""
    with tempfile.TemporaryDirectory(prefix="loops-") as folder:
        out = Path(folder) / "counts"
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--toggle-collect=*counted_cycles*"]
        subprocess.run(
            [*command, programs / "bench_loops", params, "count"],
            check=True,
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        table = subprocess.run(
            ["callgrind_annotate", "--inclusive=yes", "--threshold=100", out],
            check=True,
            stdout=subprocess.PIPE,
            text=True,
        ).stdout
    total, physics = counts(table)
    beside = (total - physics) / 1e6
    return [
        plain("instructions of 2,000 cycles", total / 1e6, "million"),
        compared("instructions of the physics", physics / 1e6, "million", total / 1e6, "all"),
        bounded("instructions beside the physics", beside, "million", MOST_BESIDE),
    ]


def counts(table: str) -> tuple[int, int]:
    """Instructions of the program and of `PHYSICS`, from what callgrind_annotate prints.

    Raises:
        RuntimeError: a function is not in the table.
    """
    found = []
    for name in ("PROGRAM TOTALS", *(rf"\S*:{function}" for function in PHYSICS)):
        match = re.search(rf"^\s*([\d,]+) \([\d. ]+%\)\s+{name}(?: \[|$)", table, re.MULTILINE)
        if match is None:
            raise RuntimeError(f"callgrind_annotate names no {name}")
        found.append(int(match[1].replace(",", "")))
    return found[0], sum(found[1:])


def bench(parts: Sequence[str], programs: Path, params: Path, say: Say) -> Result:
    """The table of these parts, and whether all figures meet their bounds."""
    measured: dict[str, Callable[[], list[Row]]] = {
        "speed": lambda: speed(programs, params),
        "python": python,
        "instructions": lambda: instructions(programs, params),
    }
    rows: list[Row] = []
    for part in parts:
        say(f"loops: {part}")
        rows += measured[part]()
    _, good = judged("loops", [row for row in rows if row["reference_name"] == "the bound"])
    return {"bench": "loops", "rows": rows}, good
