"""Measures the cost of the nodes of one robot at 1 kHz: processor time, memory, switches. The robot stands.

Its driver is first the simulator, then that of a robot without physics (programs/bench_driver.cpp).
"""

from __future__ import annotations

import os
import socket
import subprocess
import tempfile
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robot_control.loop.roles import DRIVER, HARDWARE_DRIVER, LOOP, TELEMETRY

from bench.participants import START_LIMIT
from bench.realtime.machine import start_cyclictest
from bench.rows import Row, Say, bounded, compared

MASTER = "rosmaster"
SECONDS = 30.0
START = 8.0  # s until everything has settled
MAX_LOOP, MAX_LOOP_MEMORY = 5.0, 120.0  # % of a core, MiB
MAX_TELEMETRY, MAX_TELEMETRY_MEMORY = 4.0, 64.0
MAX_MASTER = 0.5


def processor_ns(pid: int) -> int:
    """Time that all threads of a process have run; ended threads are missing, which do not matter here."""
    tasks = Path(f"/proc/{pid}/task").iterdir()
    return sum(int((task / "schedstat").read_text().split()[0]) for task in tasks)


def switches(pid: int) -> int:
    """Voluntary and forced switches of all threads."""
    total = 0
    for task in Path(f"/proc/{pid}/task").iterdir():
        for line in (task / "status").read_text().splitlines():
            if "ctxt_switches" in line:
                total += int(line.split()[1])
    return total


def memory(pid: int) -> float:
    """Proportional set size, MiB: pages that several processes map are divided among them."""
    for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
        if line.startswith("Pss:"):
            return int(line.split()[1]) / 1024
    raise RuntimeError(f"/proc/{pid}/smaps_rollup has no Pss")


def free_port() -> int:
    """A port of the loopback."""
    with socket.socket() as opened:
        opened.bind(("127.0.0.1", 0))
        return int(opened.getsockname()[1])


@dataclass(frozen=True)
class Cost:
    """The cost of one process."""

    percent: float  # of a core
    memory: float  # MiB
    switches: float  # per s


def costs(programs: Mapping[str, Sequence[str]]) -> dict[str, Cost]:
    """Process → its cost, of these programs beside a master of their own."""
    port = free_port()
    environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environment}
    processes: dict[str, subprocess.Popen[bytes]] = {}
    try:
        for name, words in {MASTER: [MASTER, "--core", "-p", str(port)], **programs}.items():
            processes[name] = subprocess.Popen(words, **quiet)
        ids = {name: _program(process.pid, name) for name, process in processes.items()}
        time.sleep(START)
        before = {name: (processor_ns(pid), switches(pid)) for name, pid in ids.items()}
        began = time.monotonic()
        time.sleep(SECONDS)
        seconds = time.monotonic() - began
        return {
            name: Cost(
                (processor_ns(pid) - before[name][0]) / seconds / 1e7,
                memory(pid),
                (switches(pid) - before[name][1]) / seconds,
            )
            for name, pid in ids.items()
        }
    finally:
        for process in reversed(processes.values()):
            process.terminate()  # SIGINT may be ignored: that of a shell's background job is
            process.wait(20)


def bare_wake_ups() -> float:
    """Percent of a core that four threads take which only wake up once per cycle."""
    process = start_cyclictest(SECONDS, threads=len(LOOP))
    try:
        time.sleep(1)
        before, began = processor_ns(process.pid), time.monotonic()
        time.sleep(SECONDS / 3)
        return (processor_ns(process.pid) - before) / (time.monotonic() - began) / 1e7
    finally:
        process.kill()
        process.communicate()


def bench(_blocks: int, programs: Path, say: Say) -> tuple[list[Row], bool]:
    """The rows, and whether all figures meet their bounds."""
    with tempfile.TemporaryDirectory(prefix="cost-") as folder:
        others = {node: ["rosrun", "robot_control", node] for node in (*LOOP[1:], TELEMETRY)}
        others[TELEMETRY].append(f"_directory:={folder}")
        say(f"cost: {SECONDS:g} s with the simulated machine")
        simulated = costs({DRIVER: ["rosrun", "robot_control", DRIVER], **others})
        say(f"cost: {SECONDS:g} s without")
        bare = costs({HARDWARE_DRIVER: [str(programs / "bench_driver")], **others})
    wake_ups = bare_wake_ups()
    loop = sum(bare[node].percent for node in (HARDWARE_DRIVER, *LOOP[1:]))
    size = sum(simulated[node].memory for node in LOOP)
    judged = [
        bounded("the four nodes, without simulated physics", loop, "% of a core", MAX_LOOP),
        bounded("memory of the four nodes", size, "MiB", MAX_LOOP_MEMORY),
        bounded("telemetry with black box", simulated[TELEMETRY].percent, "% of a core", MAX_TELEMETRY),
        bounded("its memory", simulated[TELEMETRY].memory, "MiB", MAX_TELEMETRY_MEMORY),
        bounded(MASTER, simulated[MASTER].percent, "% of a core", MAX_MASTER),
    ]
    rows = list(judged)
    with_it = sum(simulated[node].percent for node in LOOP)
    rows.append(compared("the four nodes, with simulated physics", with_it, "% of a core", loop, "those without"))
    rows.append(compared("four threads that only wake up (cyclictest)", wake_ups, "% of a core", loop, "those without"))
    for name, cost in {HARDWARE_DRIVER: bare[HARDWARE_DRIVER], **simulated}.items():
        rows.append(compared(f"{name}: processor", cost.percent, "% of a core", 0, ""))
        rows.append(compared(f"{name}: memory", cost.memory, "MiB", 0, ""))
        rows.append(compared(f"{name}: switches", cost.switches, "per s", 0, ""))
    return rows, all(row["ratio"] <= 1 for row in judged)


def _program(pid: int, name: str) -> int:
    """The id of the program that rosrun becomes or starts; before, rosrun starts others, such as rospack."""
    end = time.monotonic() + START_LIMIT
    while time.monotonic() < end:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        for each in (pid, *map(int, children)):
            with suppress(FileNotFoundError):
                if Path(f"/proc/{each}/cmdline").read_text().split("\0")[0].endswith(name) or name == MASTER:
                    return each
        time.sleep(0.05)
    raise RuntimeError(f"{name} does not run")
