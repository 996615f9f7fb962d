#!/usr/bin/python3
"""A process that measures its own gaps, as an independent witness that this machine stood still.

As a program, `stall_witness.py PARENT SHORTEST PRIORITY CORE…`, it wakes up again and again on each of these cores.
A program on another core does not notice that one is taken away. It runs under SCHED_FIFO if the priority is above 0.
It prints the end and the length (s) of each gap of at least SHORTEST, until the process PARENT ends. Shorter gaps of
at least a quarter of that are printed as one of a second if they take a quarter of it.
"""

import contextlib
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Collection
from pathlib import Path


class StallWitness:
    """Runs the program. Above the loop's priority on the loop's core, no thread of the loop can delay it."""

    def __init__(self, shortest: float, priority: int = 0, cores: Collection[int] | None = None) -> None:
        """`shortest`: s, of the gaps that count; `cores`: all on which this process may run if None."""
        self._output = tempfile.NamedTemporaryFile(prefix="stall_witness-", suffix=".log")
        cores = os.sched_getaffinity(0) if cores is None else cores
        command = [sys.executable, __file__, *map(str, (os.getpid(), shortest, priority, *cores))]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._output)

    def saw(self, begin: float, end: float) -> bool:
        """True if a gap overlaps that time (s, monotonic)."""
        for line in Path(self._output.name).read_text().splitlines():
            ended, gap = map(float, line.split())
            if ended >= begin and ended - gap <= end:
                return True
        return False


def watch(core: int, priority: int, shortest: float) -> None:
    """Prints the gaps of one core until this process ends."""
    with contextlib.suppress(OSError):
        os.sched_setaffinity(0, {core})
    with contextlib.suppress(OSError):
        if priority > 0:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    last = time.monotonic()
    second, lost = last, 0.0
    while True:
        time.sleep(shortest / 8)
        now = time.monotonic()
        if now - last >= shortest:
            print(f"{now:.6f} {now - last:.6f}\n", end="", flush=True)
        elif now - last >= shortest / 4:
            lost += now - last
        last = now
        if now - second >= 1.0:
            if lost >= 0.25:
                print(f"{now:.6f} {now - second:.6f}\n", end="", flush=True)
            second, lost = now, 0.0


def main() -> None:
    """Entry point of the program."""
    parent, shortest, priority, *cores = map(float, sys.argv[1:])
    for core in cores:
        threading.Thread(target=watch, args=(int(core), int(priority), shortest), daemon=True).start()
    while os.getppid() == parent:
        time.sleep(0.1)


if __name__ == "__main__":
    main()
