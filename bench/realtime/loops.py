"""Runs loops as processes without ROS for some seconds, and reads their logs."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from robot_control.data.run_log import Log, read_log
from robot_control.loop.roles import DRIVER, LOOP, TELEMETRY

from bench.participants import START_LIMIT, await_log, command, remove_shared_memory, script

FIRST = 1000
"""cycles that are not judged: the nodes start one after the other"""
LAST = 200
"""likewise at the end"""
FREE_WHEELS = "free_wheels"
"""a driver of a robot without physics (tests/support/robots/free_wheels.h)"""
SOME_ROWS = 100_000
"""bytes of run.bag"""


class Loop:
    """Four nodes and a telemetry on the bus `name`, until `end`; FREE_WHEELS is a driver without physics."""

    def __init__(
        self, programs: Path, name: str, settings: Mapping[str, object] | None = None, driver: str = DRIVER
    ) -> None:
        self._name = name
        self._folder = tempfile.TemporaryDirectory(prefix=f"{name}-")
        folder = Path(self._folder.name)
        (folder / "script.csv").write_text(script(600_000))
        given = {"telemetry.black_box": 0, **(settings or {})}
        words = [command(programs, node, name, folder, given) for node in (TELEMETRY, driver, *LOOP[1:])]
        self.processes = [
            subprocess.Popen(each, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
            for each in words
        ]
        self._bag = folder / "run.bag"

    def await_start(self) -> None:
        """Waits until all nodes write."""
        await_log(self._bag, SOME_ROWS, self.processes)

    def end(self) -> Log:
        """Ends the nodes, telemetry last; returns the rows without their start and their end."""
        for process in reversed(self.processes):
            process.terminate()
            process.wait(START_LIMIT)
        rows = read_log(self._bag)
        self.close()
        return {name: values[FIRST:-LAST] for name, values in rows.items()}

    def close(self) -> None:
        """Removes everything; kills what still runs."""
        for process in self.processes:
            process.kill()
            process.wait()
        remove_shared_memory(self._name)
        self._folder.cleanup()


def loop_for(seconds: float, programs: Path, driver: str = DRIVER) -> Log:
    """The rows of one loop of so many seconds."""
    loop = Loop(programs, f"realtime-{os.getpid()}", driver=driver)
    try:
        loop.await_start()
        time.sleep(seconds + (FIRST + LAST) / 1000)
        return loop.end()
    finally:
        loop.close()
