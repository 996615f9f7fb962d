"""What recording every cycle costs: four nodes and a telemetry as processes on the wall clock, without ROS.

Ten minutes at 1 kHz with the default sensor errors: diffbot, and a real robot with four wheels where there is one.
Judged are rows lost, the telemetry's processor time, bytes on disk, the processor time of loading the log, and how long
the black box reaches back.
"""

from __future__ import annotations

import math
import os
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robot_control._robot_control import save_black_box
from robot_control.common.run_log import read_run
from robot_control.installed_files import share_file

from lab.robot_corpus import DIFFBOT, robot_names, urdf_of

SECONDS = 600.0
FOUR_WHEELS = "jackal"
ROBOTS = (DIFFBOT, FOUR_WHEELS)
NODES = ("state_estimator", "diff_drive_controller", "safety_monitor", "telemetry")

MOST_LOST = 0
MOST_PROCESSOR = 0.10  # of one core
MOST_BYTES = 0.7  # MB/s, of diffbot; of four wheels it is stated
MOST_LOADING = 3.0  # s of processor time for ten minutes
BLACK_BOX = 0.2  # GB, telemetry.black_box for ten minutes; in proportion for less
LEAST_HELD = 60.0  # s in it
START_LIMIT = 30.0  # s until all nodes run


@dataclass(frozen=True)
class Recorded:
    """One run."""

    cycles: int  # that the plant made
    rows: int  # in the log
    lost: int  # as the log itself says
    megabytes: float
    processor: float  # s, of the telemetry
    loading: float  # s of processor time
    held: float  # s in the black box


def bench(share: float, programs: Path, say: Callable[[str], None]) -> tuple[dict[str, Any], bool]:
    """`share` of ten minutes for each robot; the table, and whether all figures are as they have to be."""
    seconds = SECONDS * share
    rows: list[dict[str, Any]] = []
    good = True
    there = [robot for robot in ROBOTS if robot in robot_names()]
    for robot in there:
        say(f"{robot}: {seconds:.0f} s on the wall clock")
        found = record(urdf_of(robot), seconds, programs)
        figures = {
            "rows lost": (found.cycles - found.rows, "rows", MOST_LOST),
            "telemetry": (found.processor / seconds, "of a core", MOST_PROCESSOR),
            "on disk": (found.megabytes / seconds, "MB/s", MOST_BYTES if robot == DIFFBOT else math.inf),
            "loading ten minutes": (found.loading / share, "s, processor", MOST_LOADING),
        }
        for name, (value, unit, most) in figures.items():
            rows.append(row(f"{robot}: {name}", value, unit, most if math.isfinite(most) else 0))
            good = good and value <= most
        held = found.held / share
        rows.append(row(f"{robot}: {BLACK_BOX:g} GB of black box hold", held, "s", LEAST_HELD))
        good = good and found.lost == 0 and held >= LEAST_HELD
    return {"bench": "record", "rows": rows, "not_judged": sorted(set(ROBOTS) - set(there))}, good


def row(name: str, value: float, unit: str, reference: float) -> dict[str, Any]:
    """Of the table: a value beside what is promised, 0 where nothing is."""
    return {
        "name": name,
        "value": value,
        "unit": unit,
        "reference": reference,
        "reference_name": "what is promised",
        "ratio": value / reference if reference > 0 else 0,
    }


def record(urdf: str, seconds: float, programs: Path) -> Recorded:
    """Drives for `seconds`; the plant ends by itself.

    Raises:
        RuntimeError: a node did not start or ended badly.
    """
    with tempfile.TemporaryDirectory(prefix="record-") as name:
        folder = Path(name)
        cycles = round(seconds * 1000)
        (folder / "script.csv").write_text(script(cycles))
        settings = {
            "robot.urdf": urdf,
            "robot.command_script": folder / "script.csv",
            "robot.wait_for_nodes": "true",
            "robot.wait_for_telemetry": "true",
            "mujoco_plant.cycles": cycles,
            "telemetry.directory": folder,
            "telemetry.csv": "false",
            "telemetry.record": "always",
            "telemetry.split_size": 0,
            "telemetry.quota": 0,
            "telemetry.black_box": BLACK_BOX * seconds / SECONDS,
        }
        processor = run_nodes(programs, f"record.{os.getpid()}", settings, seconds)
        bag = folder / "run.bag"
        began = time.process_time()
        run = read_run(bag)
        loading = time.process_time() - began
        held, _, _ = save_black_box(str(folder / "black_box" / "ring"), str(folder / "held.bag"))
        rows, megabytes = run.columns["cycle"].size, bag.stat().st_size / 1e6
        return Recorded(cycles, rows, run.lost, megabytes, processor, loading, held / 1000)


def run_nodes(programs: Path, bus: str, settings: dict[str, Any], seconds: float) -> float:
    """Processor time of the telemetry, s."""
    program = programs.parent / "support" / "rc_participant"
    pairs = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    arguments = ["--bus", bus, "--params", str(share_file("config/robot_params.yaml")), *pairs]
    nodes = {node: subprocess.Popen([program, node, *arguments]) for node in NODES}
    try:
        plant = subprocess.run([program, "mujoco_plant", *arguments], check=False, timeout=2 * seconds + START_LIMIT)
        if plant.returncode != 0:
            raise RuntimeError(f"mujoco_plant ended with {plant.returncode}")
        telemetry = nodes.pop("telemetry")
        telemetry.send_signal(signal.SIGINT)
        _, status, usage = os.wait4(telemetry.pid, 0)
        telemetry.returncode = os.waitstatus_to_exitcode(status)
        if telemetry.returncode != 0:
            raise RuntimeError(f"telemetry ended with {telemetry.returncode}")
        return usage.ru_utime + usage.ru_stime
    finally:
        for node in nodes.values():
            node.send_signal(signal.SIGINT)
        for node in nodes.values():
            node.wait(START_LIMIT)


def script(cycles: int) -> str:
    """A command every half second, so that none times out: speeds and turns that never repeat."""
    rows = ["cycle,linear,angular,event"]
    for k in range(1, cycles, 500):
        t = k / 1000
        rows.append(f"{k},{0.4 * math.sin(0.31 * t):.4f},{0.5 * math.sin(0.47 * t):.4f},")
    return "\n".join(rows) + "\n"
