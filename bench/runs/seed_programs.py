"""Runs benchmark programs that judge seeds, `bench_NAME FIRST RUNS`, in blocks of seeds on a runner."""

from __future__ import annotations

import json
import subprocess
import time
from functools import partial
from pathlib import Path
from typing import Any

from bench.rows import Say
from bench.runs.runner import Runner

PROGRAMS = Path(__file__).resolve().parents[2] / "build" / "robot_control" / "bench"
BLOCKS = 200


def run_block(name: str, more: tuple[str, ...], block: tuple[int, int]) -> tuple[dict[str, Any], str]:
    """Runs on the worker: returns the result of (first seed, number of seeds), and the program's messages."""
    program = [str(PROGRAMS / f"bench_{name}"), *map(str, block), *more]
    done = subprocess.run(program, capture_output=True, check=True, text=True, stdin=subprocess.DEVNULL)
    result: dict[str, Any] = json.loads(done.stdout)
    return result, done.stderr


def run_seeds(name: str, first: int, runs: int, say: Say, runner: Runner, *more: str) -> dict[str, Any]:
    """The result of all seeds: the sums of the blocks' counts, and the speed of all of them; `more` follows the seeds
    on the program's command line.
    """
    began = time.monotonic()
    size = max(1, -(-runs // BLOCKS))
    blocks = [(start, min(size, first + runs - start)) for start in range(first, first + runs, size)]
    total: dict[str, Any] = {}
    for result, messages in runner.outcomes(partial(run_block, name, more), blocks, say):
        for line in messages.splitlines():
            if line.startswith(("seed ", "    ")):  # a violation; the other lines are the progress of a block
                say(line)
        total = _added(total, result) if total else result
    for row in total["rows"]:
        if row["name"] == "speed":
            row["value"] = runs / (time.monotonic() - began)
    return total


def _added(total: dict[str, Any], result: dict[str, Any]) -> dict[str, Any]:
    rows = zip(total["rows"], result["rows"], strict=True)
    return total | {"rows": [row | {"value": row["value"] + more["value"]} for row, more in rows]}
