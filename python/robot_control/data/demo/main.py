"""Launches the closed loop, drives it, and judges what it did."""

import os
import re
import shlex
import shutil
import signal
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from types import FrameType

from robot_control._robot_control import ParameterError, RobotError, describe
from robot_control.data.csv_table import write_csv
from robot_control.data.demo import lockstep, wall_clock
from robot_control.data.demo.arguments import LEGS, parse
from robot_control.data.demo.launched import ANGULAR, LINEAR, DemoError, Driven
from robot_control.data.demo.run_picture import draw_run
from robot_control.data.demo.run_summary import summarize, to_json, to_table
from robot_control.data.loop_timing import processor_time, stolen_share
from robot_control.data.run_log import LogError, read_log
from robot_control.files.files import in_words, printable
from robot_control.installed_files import share_file
from robot_control.loop.drives import drive_of
from robot_control.loop.roles import DRIVER, LEGGED, LOOP, TELEMETRY, WHEELED, Kind
from robot_control.ui.program import run

OUTPUTS = (
    *("run.bag", "run.csv", "summary.json", "run.png"),
    *("commands.csv", "launch.log", "send_cmd.log", "set_posture.log"),
)
EVERY_CYCLE = "telemetry: {record: always}\n"
"""parameters laid over the package's"""
SIMULATED_VELOCITY = f"{DRIVER}: {{drive: velocity}}\n"
"""the same, of drives that take speeds where no other drives stand before the motors"""
CLOCKS = {"lockstep": lockstep, "wall": wall_clock}
CLOCK_WORDS = {"lockstep": "lockstep", "wall": "wall clock"}


def run_demo(
    seconds: float,
    out: Path,
    robot: str,
    drives: Path | None = None,
    *,
    velocity: bool = False,
    clock: str = "lockstep",
    rate: int = 1000,
) -> int:
    """Drives `robot`, a name or a URDF file, for `seconds` and writes everything to `out`; `drives`: a drive file,
    `velocity`: of speeds, `clock`: lockstep or wall, `rate`: Hz. Returns the exit code.
    """
    out.mkdir(parents=True, exist_ok=True)
    for name in OUTPUTS:
        (out / name).unlink(missing_ok=True)
    os.environ["ROS_HOME"] = str(out / "ros")
    shutil.rmtree(out / "ros", ignore_errors=True)

    name, legged = robot_of(robot, drives, velocity=velocity)
    parameters = out / "ros" / "overlay.yaml"
    parameters.parent.mkdir()
    parameters.write_text(
        overlay(drives, rate, velocity=velocity) + lockstep.LIE_DOWN * (legged and clock == "lockstep")
    )
    print(f"starting roscore, {Kind(LEGGED if legged else WHEELED).worded(', '.join(LOOP))}, {TELEMETRY}")
    before, began = processor_time(), time.monotonic()
    asked = CLOCKS[clock].drive(seconds, Driven(robot, legged, out, parameters, drives, 1 / rate))
    stolen, took = stolen_share(before, processor_time()), time.monotonic() - began

    try:
        log = read_log(out / "run.bag")
    except (OSError, LogError) as error:
        raise DemoError(f"no log of the run: {in_words(error)}; see {out / 'launch.log'}") from error
    with ProcessPoolExecutor(1) as beside:
        table = beside.submit(write_csv, out / "run.bag", out / "run.csv")
        summary = summarize(log, LINEAR, ANGULAR, asked, stolen, legged=legged, clock=clock)
        (out / "summary.json").write_text(to_json(summary))
        verdict = "tracked" if summary.passed else "NOT TRACKED"
        what = f"{name}, {LINEAR} m/s and {ANGULAR} rad/s"
        title = f"{what}, {CLOCK_WORDS[clock]}, {1000 / rate:g} ms cycles: {verdict}"
        draw_run(log, summary, title, out / "run.png")
    try:
        table.result()
    except LogError as error:
        raise DemoError(f"no table of the run: {in_words(error)}") from error
    if clock == "wall":
        _print_refusals((out / "launch.log").read_text(errors="replace"))
    else:
        print(f"{log['time'][-1]:.1f} s of simulated time in {took:.1f} s")
    print(f"\n{to_table(summary)}\n\n{verdict}; see {printable(str(out))}/summary.json, run.bag, run.csv, run.png")
    print(f"see it in a browser: scripts/try {shlex.quote(printable(robot))}")
    return 0 if summary.passed else 1


def robot_of(robot: str, drives: Path | None, *, velocity: bool) -> tuple[str, bool]:
    """The name of a robot, and whether it has legs.

    Raises:
        DemoError: it cannot be used, or not with these drives or with speeds as commands.
    """
    urdf = share_file(f"urdf/{robot}.urdf") if robot in LEGS else robot
    try:
        machine = describe(share_file("config/robot_params.yaml"), [("robot.urdf", urdf)])
    except (RobotError, ParameterError, OSError) as error:
        raise DemoError(in_words(error)) from None
    legged = machine["kind"] == "legs"
    drive = None if drives is None else drive_of(drives)
    if drive is not None and drive.moves_legs != legged:
        raise DemoError(f"{robot} is a robot on {machine['kind']}: --drives {drive.name} do not move it")
    if velocity and legged:
        raise DemoError(f"{robot} has legs, but --wheel-command needs wheels: remove one of the two")
    return machine["name"], legged


def overlay(drives: Path | None, rate: int, *, velocity: bool) -> str:
    """The parameters that are laid over the package's."""
    command = ", wheel_command: velocity" * velocity
    simulated = SIMULATED_VELOCITY if velocity and drives is None else ""
    return f"{EVERY_CYCLE}robot: {{rate: {rate}{command}}}\n{simulated}"


def refusals(launch_log: str) -> list[str]:
    """The real-time privileges that were not granted, with their remedy. Each kind appears once although every node
    reports it.
    """
    found: dict[str, str] = {}
    kinds = "memory is|SCHED_FIFO priority|core|cpu_dma_latency"
    for match in re.finditer(rf"({kinds}) [^(\n]*\([^)\n]*remedy: [^)\n]*\)", launch_log):
        found.setdefault(match[1], match[0])
    return list(found.values())


def _print_refusals(launch_log: str) -> None:
    said = refusals(launch_log)
    for refusal in said:
        print(f"real time: {refusal}")
    if said:
        print("real time: see docs/realtime.md")


def _interrupt(signal_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt(signal.Signals(signal_number).name)


def main() -> int:
    """Entry point of scripts/demo."""
    given = parse()
    signal.signal(signal.SIGTERM, _interrupt)
    try:
        velocity = given.wheel_command == "velocity"
        return run_demo(
            *(given.seconds, given.out, given.robot, given.drives),
            velocity=velocity,
            clock=given.clock,
            rate=given.rate,
        )
    except (DemoError, OSError) as error:
        print(f"scripts/demo: {in_words(error)}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("scripts/demo: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    run(main)
