#!/usr/bin/python3
"""A process that measures its own gaps, as an independent witness that this machine stood still.

As a program, `stall_witness.py CORE PRIORITY`, it wakes up again and again on that core (-1: any). It runs under
SCHED_FIFO if the priority is above 0 and granted. It prints the end and the length of each gap, until its parent ends.
"""

import contextlib
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PERIOD = 0.002
"""s"""
MIN_GAP = 0.01
"""s; shorter gaps are not reported"""


class StallWitness:
    """Runs the program. Above the loop's priority on the loop's core, no thread of the loop can delay it."""

    def __init__(self, core: int, priority: int) -> None:
        self._output = tempfile.NamedTemporaryFile(prefix="stall_witness-", suffix=".log")
        command = [sys.executable, __file__, str(core), str(priority)]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._output)

    def saw(self, length: float, begin: float, end: float) -> bool:
        """True if a gap of at least `length` s overlaps that time (s, monotonic)."""
        for line in Path(self._output.name).read_text().splitlines():
            ended, gap = map(float, line.split())
            if gap >= length and ended >= begin and ended - gap <= end:
                return True
        return False


def main() -> None:
    """Entry point of the program."""
    core, priority = map(int, sys.argv[1:])
    parent = os.getppid()
    with contextlib.suppress(OSError):
        if core >= 0:
            os.sched_setaffinity(0, {core})
        if priority > 0:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    last = time.monotonic()
    while os.getppid() == parent:
        time.sleep(PERIOD)
        now = time.monotonic()
        if now - last >= MIN_GAP:
            print(f"{now:.6f} {now - last:.6f}", flush=True)
        last = now


if __name__ == "__main__":
    main()
