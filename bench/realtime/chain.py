"""Measures the way from the sensor frame to the command frame over three processes. Its references are a bare futex
ping-pong of as many hops, and the same frames over roscpp topics on loopback.
"""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from robot_control.common.run_log import FloatArray

from bench.realtime.cost import free_port
from bench.realtime.jitter import median_interval
from bench.realtime.loops import loop_for
from bench.rows import bounded, compared

HOPS = 2  # driver → estimator → controller
SECONDS = 4.0
MAX_RATIO = 1.5
MIN_FASTER = 10.0
LAWS = (
    ("driver_woke_ns", "sensors_published_ns"),
    ("estimator_woke_ns", "state_published_ns"),
    ("controller_woke_ns", "command_published_ns"),
)

BETWEEN = (
    ("in it, until the monitor wakes: gate and machine", "sensors_published_ns", "monitor_woke_ns"),
    ("in it: the monitor", "monitor_woke_ns", "permit_published_ns"),
)
"""what runs on the core of the loop before the estimator, because its priority is higher"""


def hops(programs: Path) -> FloatArray:
    """Returns the times of the bare ping-pong, µs."""
    words = [str(programs / "bench_hops"), str(HOPS), str(int(SECONDS * 1000))]
    done = subprocess.run(words, stdout=subprocess.PIPE, check=True, text=True, stdin=subprocess.DEVNULL)
    return np.array(done.stdout.split(), dtype=float) / 1000


def topics(programs: Path) -> FloatArray:
    """Returns the times over roscpp, µs."""
    port = free_port()
    environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
    cycles = str(int(SECONDS * 1000))
    given: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environment}
    master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL, text=True, **given)
    started: list[subprocess.Popen[str]] = []
    try:
        time.sleep(2)
        for role in ("sink", "relay", "source"):
            words = [str(programs / "bench_topics"), role, cycles]
            started.append(subprocess.Popen(words, stdout=subprocess.PIPE, text=True, **given))
            time.sleep(1)
        started[2].wait(SECONDS + 20)
        time.sleep(0.5)
        started[0].terminate()
        text, _ = started[0].communicate(timeout=20)
    finally:
        for process in (*started, master):
            process.kill()
            process.wait()
    values = np.array([line for line in text.splitlines() if line.isdecimal()], dtype=float) / 1000
    if values.size == 0:
        raise RuntimeError("no frame arrived over the topics")
    return values


def bench(blocks: int, programs: Path, say: Callable[[str], None]) -> tuple[list[dict[str, Any]], bool]:
    """The rows, and whether both bounds are met."""
    chains, floors, laws, bare = [], [], [], []
    between: dict[str, list[float]] = {name: [] for name, _, _ in BETWEEN}
    for block in range(blocks):
        say(f"chain: block {block + 1} of {blocks}")
        rows = loop_for(SECONDS, programs)
        chains.append(float(np.nanmedian(rows["command_published_ns"] - rows["driver_woke_ns"])) / 1000)
        laws.append(sum(float(np.nanmedian(rows[end] - rows[begin])) / 1000 for begin, end in LAWS))
        for name, begin, end in BETWEEN:
            between[name].append(float(np.nanmedian(rows[end] - rows[begin])) / 1000)
        bare.append(float(np.median(hops(programs))))
        floors.append(bare[-1] + laws[-1])
    say("chain: topics")
    over_topics = float(np.median(topics(programs)))
    chain = float(np.median(chains))
    low, middle, high = median_interval([a / b for a, b in zip(chains, floors, strict=True)])
    faster = over_topics / chain
    return [
        compared("sensors to command, median", chain, "µs", float(np.median(bare)), f"ping-pong of {HOPS} hops"),
        compared("computation of the three nodes", float(np.median(laws)), "µs", 0, ""),
        *(
            compared(name, float(np.median(times)), "µs", chain, "sensors to command")
            for name, times in between.items()
        ),
        bounded("ratio to ping-pong and computation together", middle, f"[{low:.2f}, {high:.2f}]", MAX_RATIO),
        compared("the same frames over topics", over_topics, "µs", chain, "sensors to command"),
        bounded("times faster than topics", faster, "at least", MIN_FASTER),
    ], low <= MAX_RATIO and faster >= MIN_FASTER
