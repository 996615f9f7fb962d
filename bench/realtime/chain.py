"""Measures the way from the sensor frame to the command frame over three processes, with and without simulated physics.

Its references are a bare futex ping-pong of as many hops, and the same frames over roscpp topics on loopback. All four
alternate. The bounds hold without the physics, because no driver of a real machine computes on the core of the loop.
"""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from robot_control.data.run_log import FloatArray, Log
from robot_control.loop.roles import DRIVER

from bench.realtime.cost import free_port
from bench.realtime.jitter import median_interval
from bench.realtime.loops import FREE_WHEELS, loop_for
from bench.rows import Row, Say, bounded, compared

HOPS = 2  # driver → estimator → controller
SECONDS = 4.0
MAX_RATIO = 1.5
MIN_FASTER = 5.0
CHAIN = ("driver_woke_ns", "command_published_ns")
LAWS = (
    ("driver_woke_ns", "sensors_published_ns"),
    ("estimator_woke_ns", "state_published_ns"),
    ("controller_woke_ns", "command_published_ns"),
)
MACHINE = ("sensors_published_ns", "monitor_woke_ns")
"""gate, machine and a wake-up; the threads of the driver and of the monitor run before that of the estimator"""
MONITOR = ("monitor_woke_ns", "permit_published_ns")


def between(rows: Log, stamps: tuple[str, str]) -> float:
    """The median time from one stamp of a cycle to another, µs."""
    begin, end = stamps
    return float(np.nanmedian(rows[end] - rows[begin])) / 1000


def hops(programs: Path) -> FloatArray:
    """Returns the times of the bare ping-pong, µs."""
    words = [str(programs / "bench_hops"), str(HOPS), str(int(SECONDS * 1000))]
    done = subprocess.run(words, stdout=subprocess.PIPE, check=True, text=True, stdin=subprocess.DEVNULL)
    return np.array(done.stdout.split(), dtype=float) / 1000


@contextmanager
def ros_master() -> Iterator[dict[str, str]]:
    """The environment of programs of a ROS master of their own."""
    port = free_port()
    environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
    words = ["rosmaster", "--core", "-p", str(port)]
    quiet = subprocess.DEVNULL
    master = subprocess.Popen(words, stdin=quiet, stdout=quiet, stderr=quiet, env=environment)
    try:
        time.sleep(2)
        yield environment
    finally:
        master.kill()
        master.wait()


def topics(programs: Path, environment: dict[str, str]) -> FloatArray:
    """Returns the times over roscpp, µs."""
    cycles = str(int(SECONDS * 1000))
    given: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environment}
    started: list[subprocess.Popen[str]] = []
    try:
        for role in ("sink", "relay", "source"):
            words = [str(programs / "bench_topics"), role, cycles]
            started.append(subprocess.Popen(words, stdout=subprocess.PIPE, text=True, **given))
            time.sleep(1)
        started[2].wait(SECONDS + 20)
        time.sleep(0.5)
        started[0].terminate()
        text, _ = started[0].communicate(timeout=20)
    finally:
        for process in started:
            process.kill()
            process.wait()
    values = np.array([line for line in text.splitlines() if line.isdecimal()], dtype=float) / 1000
    if values.size == 0:
        raise RuntimeError("no frame arrived over the topics")
    return values


def block(programs: Path, environment: dict[str, str]) -> dict[str, float]:
    """One measurement of each, medians, µs."""
    simulated = loop_for(SECONDS, programs, DRIVER)
    bare = loop_for(SECONDS, programs, FREE_WHEELS)
    return {
        "simulated": between(simulated, CHAIN),
        "simulator": between(simulated, MACHINE),
        "chain": between(bare, CHAIN),
        "laws": sum(between(bare, stamps) for stamps in LAWS),
        "gate": between(bare, MACHINE),
        "monitor": between(bare, MONITOR),
        "hops": float(np.median(hops(programs))),
        "topics": float(np.median(topics(programs, environment))),
    }


def bench(blocks: int, programs: Path, say: Say) -> tuple[list[Row], bool]:
    """The rows, and whether both bounds are met."""
    measured: list[dict[str, float]] = []
    with ros_master() as environment:
        for number in range(blocks):
            say(f"chain: block {number + 1} of {blocks}")
            measured.append(block(programs, environment))
    times = {name: float(np.median([each[name] for each in measured])) for name in measured[0]}
    low, middle, high = median_interval([each["chain"] / (each["hops"] + each["laws"]) for each in measured])
    least, faster, most = median_interval([each["topics"] / each["chain"] for each in measured])
    whole = (times["chain"], "sensors to command")
    return [
        compared("sensors to command, median", times["chain"], "µs", times["hops"], f"ping-pong of {HOPS} hops"),
        compared("computation of the three nodes", times["laws"], "µs", *whole),
        compared("in it, until the monitor wakes: gate and machine", times["gate"], "µs", *whole),
        compared("in it: the monitor", times["monitor"], "µs", *whole),
        bounded("ratio to ping-pong and computation together", middle, f"[{low:.2f}, {high:.2f}]", MAX_RATIO),
        compared("the same frames over topics", times["topics"], "µs", *whole),
        bounded("times faster than topics", faster, f"[{least:.2f}, {most:.2f}], at least", MIN_FASTER),
        compared("with simulated physics: sensors to command, median", times["simulated"], "µs", *whole),
        compared("with simulated physics: gate and machine", times["simulator"], "µs", times["simulated"], "that time"),
    ], low <= MAX_RATIO and faster >= MIN_FASTER
