"""Tracepoints of the kernel that watch the real-time threads of running nodes, with perf(1)."""

import os
import re
import shutil
import signal
import subprocess
from pathlib import Path

from system.system_support import Robot

EVENTS = ("raw_syscalls:sys_enter", "exceptions:page_fault_user")
ALLOWED = {202: "futex", 230: "clock_nanosleep", 219: "restart_syscall", 228: "clock_gettime"}
"""System calls of x86-64: wait, wake, clock (src/rt/futex.cpp, src/rt/clock.cpp). The simulator has no own I/O."""
NAMES = {"driver", "estimator", "controller", "monitor"}
LINE = re.compile(r"^\s*(?P<comm>.+?)\s+(?P<tid>\d+)\s+(?P<time>\d+\.\d+):\s+(?P<rest>.*)$")


def absent() -> str:
    """Why tracepoints cannot be used here, with the remedy; empty if they can."""
    if shutil.which("perf") is None:
        return "perf is not installed: scripts/setup --realtime"
    if os.geteuid() != 0:
        return "tracepoints need root: sudo scripts/test --nightly realtime"
    return ""


def realtime_threads(pid: int) -> list[int]:
    """Ids of the threads of a node that run its loop."""
    tasks = Path(f"/proc/{pid}/task").iterdir()
    return [int(task.name) for task in tasks if (task / "comm").read_text().strip() in NAMES]


class Tracepoints:
    """Records every system call that is not allowed, and every page fault, of the loop's threads until `end`."""

    def __init__(self, robot: Robot, data: Path) -> None:
        self._data = data
        self.seen: list[tuple[float, str]] = []
        """CLOCK_MONOTONIC in s, and what was seen"""
        threads = [thread for node in robot.nodes.values() for thread in realtime_threads(node.pid)]
        allowed = " && ".join(f"id != {number}" for number in ALLOWED)
        events = ["-e", EVENTS[0], "--filter", allowed, "-e", EVENTS[1]]
        words = ["perf", "record", "-q", "-k", "mono", "-o", str(data), *events, "-t", ",".join(map(str, threads))]
        self._perf = subprocess.Popen(words, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def end(self) -> None:
        """Ends the recording and reads it."""
        if self._perf.poll() is None:
            self._perf.send_signal(signal.SIGINT)
        _, errors = self._perf.communicate(timeout=30)
        script = ["perf", "script", "-i", str(self._data), "-F", "comm,tid,time,event,trace"]
        done = subprocess.run(script, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            raise AssertionError(f"perf: {errors}\n{done.stderr}")
        for line in done.stdout.splitlines():
            found = LINE.match(line)
            if found is None:
                raise AssertionError(f"not understood: {line}")
            self.seen.append((float(found["time"]), line.strip()))
