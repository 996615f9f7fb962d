"""Measures the cost of recording every cycle: four nodes and a telemetry as processes on the wall clock, without ROS.

Ten minutes at 1 kHz are recorded with the default sensor errors, of diffbot and of a real robot with four wheels if
there is one. With --robot quadbot, they are those of a robot that walks. The bounds are on lost rows, bytes on disk,
and the processor times of telemetry, loading, replay and report. The black box, which was overwritten several times, is
replayed as well, and its length is judged.
"""

from __future__ import annotations

import math
import os
import signal
import subprocess
import tempfile
import time
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robot_control._robot_control import replay_log, save_black_box
from robot_control.data.replay.recorded_setup import recorded_setup
from robot_control.data.report.main import main as report_main
from robot_control.data.run_log import read_run
from robot_control.loop.roles import DRIVER, LOOP, TELEMETRY

from bench.participants import START_LIMIT, command, script
from bench.robot_corpus import DIFFBOT, QUADBOT, robot_names
from bench.rows import Result, Say, compared

SECONDS = 600.0
FOUR_WHEELS = "jackal"
ON_WHEELS = (DIFFBOT, FOUR_WHEELS)

MAX_LOST = 0
MAX_PROCESSOR = 0.10  # of one core
MAX_BYTES = {DIFFBOT: 0.7, QUADBOT: 1.5}  # MB/s; the figure of four wheels is only reported
MAX_LOADING = {DIFFBOT: 3.0, FOUR_WHEELS: 3.0}  # s of processor time for ten minutes; of quadbot only reported
SLOWEST_REPLAY = {DIFFBOT: 20.0, FOUR_WHEELS: 20.0, QUADBOT: 10.0}  # s of the log per s of processor time
MAX_REPORTING = 20.0  # s of processor time, of ten minutes or less
MAX_PAGE = 15.0  # MB
MAX_BEFORE_SNAPSHOT = 1024 + 8  # cycles at the begin of a black box; kSnapshotCycles, and what was on its way
BLACK_BOX = 0.2  # GB, telemetry.black_box for ten minutes; a shorter run has a share of it
MIN_HELD = 60.0  # s in it


@dataclass(frozen=True)
class Replayed:
    """The result of a replay; rows are those of all laws."""

    different: int
    not_compared: int
    seconds: float  # s of processor time


@dataclass(frozen=True)
class Recorded:
    """One run."""

    cycles: int  # made by the plant
    rows: int  # in the log
    lost: int  # as the log itself says
    megabytes: float
    processor: float  # s, of the telemetry
    loading: float  # s of processor time
    held: float  # s in the black box
    whole: Replayed  # of run.bag
    latest: Replayed  # of the black box
    reporting: float  # s of processor time
    page: float  # MB


def bench(share: float, programs: Path, keep: Path | None, say: Say, robot: str = DIFFBOT) -> Result:
    """Records `share` of ten minutes for each robot of this robot's kind; returns the table, and whether all figures
    meet their bounds.

    `keep`: folder for the logs and pages; None: they are removed.
    """
    seconds = SECONDS * share
    rows: list[dict[str, Any]] = []
    good = True
    wanted = ON_WHEELS if robot == DIFFBOT else (robot,)
    present = [name for name in wanted if name in (*robot_names(), QUADBOT)]
    for name in present:
        say(f"{name}: {seconds:.0f} s on the wall clock")
        with tempfile.TemporaryDirectory(prefix="record-") if keep is None else nullcontext(keep / name) as folder:
            Path(folder).mkdir(parents=True, exist_ok=True)
            found = record(name, seconds, programs, Path(folder))
        for figure, (value, unit, lower, upper) in figures(name, found, share).items():
            promised = upper if lower == 0 else lower
            rows.append(row(f"{name}: {figure}", value, unit, promised if math.isfinite(promised) else 0))
            good = good and lower <= value <= upper
    return {"bench": "record", "rows": rows, "not_judged": sorted(set(wanted) - set(present))}, good


def figures(robot: str, found: Recorded, share: float) -> dict[str, tuple[float, str, float, float]]:
    """By name: value, unit, lower and upper bound."""
    seconds = SECONDS * share
    return {
        "rows lost": (found.cycles - found.rows + found.lost, "rows", 0, MAX_LOST),
        "telemetry": (found.processor / seconds, "of a core", 0, MAX_PROCESSOR),
        "on disk": (found.megabytes / seconds, "MB/s", 0, MAX_BYTES.get(robot, math.inf)),
        "loading ten minutes": (found.loading / share, "s, processor", 0, MAX_LOADING.get(robot, math.inf)),
        "replay, rows different": (found.whole.different, "rows", 0, 0),
        "replay, rows not compared": (found.whole.not_compared, "rows", 0, 0),
        "speed of the replay": (seconds / found.whole.seconds, "s per s, processor", SLOWEST_REPLAY[robot], math.inf),
        f"{BLACK_BOX:g} GB of black box hold": (found.held / share, "s", MIN_HELD, math.inf),
        "black box, rows different": (found.latest.different, "rows", 0, 0),
        "black box, rows not compared": (found.latest.not_compared, "rows", 0, 4 * MAX_BEFORE_SNAPSHOT),
        "report": (found.reporting, "s, processor", 0, MAX_REPORTING),
        "its page": (found.page, "MB", 0, MAX_PAGE),
    }


def row(name: str, value: float, unit: str, reference: float) -> dict[str, Any]:
    """A row of the table: a value beside its bound, 0 without one."""
    return compared(name, value, unit, reference, "what is promised")


def record(robot: str, seconds: float, programs: Path, folder: Path) -> Recorded:
    """Drives for `seconds` and leaves run.bag, held.bag (of the black box) and run.html in `folder`.

    Raises:
        RuntimeError: a node did not start or ended badly.
    """
    cycles = round(seconds * 1000)
    (folder / "script.csv").write_text(script(cycles))
    settings = {
        "mujoco_plant.cycles": cycles,
        "telemetry.split_size": 0,
        "telemetry.quota": 0,
        "telemetry.black_box": BLACK_BOX * seconds / SECONDS,
    }
    processor = run_nodes(programs, folder, settings, seconds, robot)
    bag, held = folder / "run.bag", folder / "held.bag"
    began = time.process_time()
    run = read_run(bag)
    loading = time.process_time() - began
    held_rows, _, _ = save_black_box(str(folder / "black_box" / "ring"), str(held))
    began = time.process_time()
    report_main([str(bag)])
    reporting = time.process_time() - began
    return Recorded(
        cycles=cycles,
        rows=run.columns["cycle"].size,
        lost=run.lost,
        megabytes=bag.stat().st_size / 1e6,
        processor=processor,
        loading=loading,
        held=held_rows / 1000,
        whole=replayed(bag),
        latest=replayed(held),
        reporting=reporting,
        page=bag.with_suffix(".html").stat().st_size / 1e6,
    )


def replayed(bag: Path) -> Replayed:
    """Replays as replay.py does."""
    began = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        report = replay_log(str(bag), recorded_setup(bag, Path(folder)).layers(), None)
    seconds = time.process_time() - began
    laws = report["laws"].values()
    different = report["different_rows"] + len(report["header"]) + sum(law["different"] for law in laws)
    return Replayed(different, sum(law["not_compared"] for law in laws), seconds)


def run_nodes(programs: Path, folder: Path, settings: dict[str, Any], seconds: float, robot: str) -> float:
    """Processor time of the telemetry, s."""
    bus = f"record.{os.getpid()}"
    commands = {node: command(programs, node, bus, folder, settings, robot=robot) for node in (*LOOP, TELEMETRY)}
    plant_command = commands.pop(DRIVER)
    nodes = {node: subprocess.Popen(each) for node, each in commands.items()}
    try:
        plant = subprocess.run(plant_command, check=False, timeout=2 * seconds + START_LIMIT)
        if plant.returncode != 0:
            raise RuntimeError(f"mujoco_plant ended with {plant.returncode}")
        telemetry = nodes.pop(TELEMETRY)
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
