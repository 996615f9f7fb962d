"""Measures the cost of the nodes of one robot at 1 kHz: processor time, memory, switches. The robot stands."""

from __future__ import annotations

import os
import socket
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robot_control.common.roles import LOOP, TELEMETRY

from bench.rows import bounded, compared

SECONDS = 30.0
START = 8.0  # s until everything has settled
MAX_LOOP, MAX_LOOP_MEMORY = 6.0, 120.0  # % of a core, MiB
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


def bench(_blocks: int, _programs: Path, say: Callable[[str], None]) -> tuple[list[dict[str, Any]], bool]:
    """The rows, and whether all figures meet their bounds."""
    port = free_port()
    environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environment}
    processes: dict[str, subprocess.Popen[bytes]] = {}
    with tempfile.TemporaryDirectory(prefix="cost-") as folder:
        try:
            processes["rosmaster"] = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], **quiet)
            for node in (*LOOP, TELEMETRY):
                own = [f"_directory:={folder}"] if node == TELEMETRY else []
                processes[node] = subprocess.Popen(["rosrun", "robot_control", node, *own], **quiet)
            time.sleep(START)
            ids = {name: _program(process.pid, name) for name, process in processes.items()}
            say(f"cost: {SECONDS:g} s")
            before = {name: (processor_ns(pid), switches(pid)) for name, pid in ids.items()}
            began = time.monotonic()
            time.sleep(SECONDS)
            seconds = time.monotonic() - began
            percent = {name: (processor_ns(pid) - before[name][0]) / seconds / 1e7 for name, pid in ids.items()}
            rate = {name: (switches(pid) - before[name][1]) / seconds for name, pid in ids.items()}
            size = {name: memory(pid) for name, pid in ids.items()}
        finally:
            for process in reversed(processes.values()):
                process.terminate()  # SIGINT may be ignored: that of a shell's background job is
                process.wait(20)
    loop = sum(percent[node] for node in LOOP)
    judged = [
        bounded("the four nodes", loop, "% of a core", MAX_LOOP),
        bounded("their memory", sum(size[node] for node in LOOP), "MiB", MAX_LOOP_MEMORY),
        bounded("telemetry with black box", percent[TELEMETRY], "% of a core", MAX_TELEMETRY),
        bounded("its memory", size[TELEMETRY], "MiB", MAX_TELEMETRY_MEMORY),
        bounded("rosmaster", percent["rosmaster"], "% of a core", MAX_MASTER),
    ]
    rows = list(judged)
    for name in ids:
        rows.append(compared(f"{name}: processor", percent[name], "% of a core", 0, ""))
        rows.append(compared(f"{name}: memory", size[name], "MiB", 0, ""))
        rows.append(compared(f"{name}: switches", rate[name], "per s", 0, ""))
    return rows, all(row["ratio"] <= 1 for row in judged)


def _program(pid: int, name: str) -> int:
    """The id of the program that rosrun became or started."""
    if name in Path(f"/proc/{pid}/cmdline").read_text().split("\0")[0] or name == "rosmaster":
        return pid
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    if not children:
        raise RuntimeError(f"{name} does not run")
    return int(children[0])
