"""Runs a robot's nodes without ROS (tests/support/processes/participant.cpp); their telemetry records all cycles."""

from __future__ import annotations

import math
import subprocess
import time
from collections.abc import Iterable, Mapping
from pathlib import Path

from robot_control.installed_files import share_file
from robot_control.loop.roles import NAMES_ON_LEGS

from bench.robot_corpus import DIFFBOT, QUADBOT, urdf_of

START_LIMIT = 30.0  # s until all nodes run
RECORDING = {
    "robot.wait_for_nodes": "true",
    "robot.wait_for_telemetry": "true",
    "telemetry.record": "always",
}


def command(
    programs: Path, node: str, bus: str, folder: Path, settings: Mapping[str, object], *, robot: str = DIFFBOT
) -> list[str]:
    """Command line of one node, which reads commands from script.csv in `folder`; the log goes there, too. `node` is
    the program of a robot on wheels.
    """
    script_and_log = {"robot.command_script": folder / "script.csv", "telemetry.directory": folder}
    own = {"robot.urdf": urdf_of(robot)}
    pairs = [f"{key}={value}" for key, value in {**RECORDING, **script_and_log, **own, **settings}.items()]
    on_legs = NAMES_ON_LEGS if robot == QUADBOT else {}
    program = support_program(programs, "rc_participant")
    parameters = share_file("config/robot_params.yaml")
    start = [str(program), on_legs.get(node, node), "--bus", bus, "--params", str(parameters)]
    return [*start, *(w for p in pairs for w in ("--set", p))]


def support_program(programs: Path, name: str) -> Path:
    """A program of tests/support; `programs` is the folder of the benchmarks."""
    return programs.parent / "tests" / "support" / name


def remove_shared_memory(bus: str) -> None:
    """Removes the shared memory that killed nodes have left."""
    for path in Path("/dev/shm").glob(f"robot_control.*.{bus}.*"):
        path.unlink(missing_ok=True)


def await_log(bag: Path, size: int, nodes: Iterable[subprocess.Popen[bytes]] = ()) -> None:
    """Waits until the log has so many bytes. Raises RuntimeError: it has not in time, or a node has ended."""
    end = time.monotonic() + START_LIMIT
    while not bag.exists() or bag.stat().st_size < size:
        if time.monotonic() > end or any(node.poll() is not None for node in nodes):
            raise RuntimeError(f"the nodes have not begun to write {bag.name}")
        time.sleep(0.05)


def script(cycles: int) -> str:
    """A script with a command every half second, so that none times out; speeds and turns never repeat."""
    rows = ["cycle,linear,angular,event"]
    for k in range(1, cycles, 500):
        t = k / 1000
        rows.append(f"{k},{0.4 * math.sin(0.31 * t):.4f},{0.5 * math.sin(0.47 * t):.4f},")
    return "\n".join(rows) + "\n"
