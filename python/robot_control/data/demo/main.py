"""Launches the closed loop in wall-clock time, drives it, ends it, and judges what it did."""

import contextlib
import os
import re
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import FrameType

from robot_control.data.csv_table import write_csv
from robot_control.data.demo.arguments import LEGGED_ROBOT, parse
from robot_control.data.demo.run_picture import draw_run
from robot_control.data.demo.run_summary import summarize, to_json, to_table
from robot_control.data.loop_timing import processor_time, stolen_share
from robot_control.data.run_log import LogError, read_log
from robot_control.files.files import in_words, printable
from robot_control.installed_files import share_file
from robot_control.loop.drives import DRIVES
from robot_control.loop.roles import DRIVER, LEGGED, LOOP, TELEMETRY, WHEELED, Kind
from robot_control.loop.signal_names import number_of
from robot_control.ui.child import Child
from robot_control.ui.program import run

LINEAR, ANGULAR = 0.5, 0.2
"""m/s, rad/s: what send_cmd.py sends by default; the source article's command."""
START_LIMIT = 60.0
"""s for master, nodes and first rows, and again for the sender; 3 s and 1 s on an idle machine."""
REST_TIME = 2.0
"""s of the robot's clock before it drives: at rest it learns the bias of its gyro, to 0.35 mrad/s in that time."""
PERIOD = 1e-3
"""s, of the package's parameters"""
RAMP_TIME = 1.5
"""s between the sender's zero and the end of the log: 0.5 s of ramp at 1 m/s², tripled."""
BUS = f"demo_{os.getpid()}"
"""The bus belongs to this demo alone, which removes it: 12 MB that outlive the nodes would fill a small /dev/shm."""
SHOWN = (
    *("cycle", "requested_linear", "limited_linear", "legged_phase"),
    *("truth_x", "truth_y", "truth_linear", "truth_angular"),
)
"""columns that show how far the run is"""
Row = dict[str, float]
"""column → value"""
OUTPUTS = ("run.bag", "run.csv", "summary.json", "run.png", "launch.log", "send_cmd.log", "set_posture.log")
EVERY_CYCLE = "telemetry: {record: always}\n"
"""parameters laid over the package's"""
VELOCITY = "robot: {wheel_command: velocity}\n"
SIMULATED_VELOCITY = f"{DRIVER}: {{drive: velocity}}\n"
"""the same, of drives that take speeds; the second one where no other drives stand before the motors"""


class DemoError(RuntimeError):
    """Something did not start, or died; the message names the file with the reason."""


def run_demo(seconds: float, out: Path, robot: str, drives: Path | None = None, *, velocity: bool = False) -> int:
    """Drives `robot` for `seconds` and writes everything to `out`; `drives`: a drive file, `velocity`: of
    speeds.
    Returns the exit code.
    """
    out.mkdir(parents=True, exist_ok=True)
    for name in OUTPUTS:
        (out / name).unlink(missing_ok=True)
    os.environ["ROS_HOME"] = str(out / "ros")
    shutil.rmtree(out / "ros", ignore_errors=True)

    before = processor_time()
    parameters = out / "ros" / "overlay.yaml"
    parameters.parent.mkdir()
    parameters.write_text(overlay(drives, velocity=velocity))
    driven = _drive(seconds, out, robot, drives, parameters)
    stolen = stolen_share(before, processor_time())

    _print_refusals((out / "launch.log").read_text(errors="replace"))
    try:
        log = read_log(out / "run.bag")
        write_csv(out / "run.bag", out / "run.csv")
    except (OSError, LogError) as error:
        raise DemoError(f"no log of the run: {in_words(error)}; see {out / 'launch.log'}") from error
    summary = summarize(log, LINEAR, ANGULAR, driven, stolen, legged=robot == LEGGED_ROBOT)
    (out / "summary.json").write_text(to_json(summary))
    verdict = "tracked" if summary.passed else "NOT TRACKED"
    title = f"{robot}, {LINEAR} m/s and {ANGULAR} rad/s, wall clock, 1 ms cycles: {verdict}"
    draw_run(log, summary, title, out / "run.png")
    print(f"\n{to_table(summary)}\n\n{verdict}; see {printable(str(out))}/summary.json, run.bag, run.csv, run.png")
    return 0 if summary.passed else 1


def overlay(drives: Path | None, *, velocity: bool) -> str:
    """The parameters that are laid over the package's."""
    if not velocity:
        return EVERY_CYCLE
    simulated = SIMULATED_VELOCITY if drives is None else ""
    return EVERY_CYCLE + VELOCITY + simulated


def refusals(launch_log: str) -> list[str]:
    """The real-time privileges that were not granted, with their remedy. Each kind appears once although every node
    reports it.
    """
    found: dict[str, str] = {}
    kinds = "memory is|SCHED_FIFO priority|core|cpu_dma_latency"
    for match in re.finditer(rf"({kinds}) [^(\n]*\([^)\n]*remedy: [^)\n]*\)", launch_log):
        found.setdefault(match[1], match[0])
    return list(found.values())


def _drive(seconds: float, out: Path, robot: str, drives: Path | None, parameters: Path) -> float:
    """Starts everything, drives, ends everything. Returns the seconds from the command's arrival, or from full speed of
    a robot that stands up first, to the command's end.
    """
    log = out / "run.bag"
    with _ended_at_the_end() as children:
        kind = Kind(LEGGED if robot == LEGGED_ROBOT else WHEELED)
        print(f"starting roscore, {kind.worded(', '.join(LOOP))}, {TELEMETRY}")
        port = os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1].strip("/")
        launch = Child(
            [
                *("roslaunch", "-p", port, "robot_control", "sim.launch", f"robot:={robot}"),
                *("telemetry:=true", "black_box:=false", f"out:={out}", f"bus:={BUS}", f"params:={parameters}"),
                *([] if drives is None else [f"drives:={drives}", f"driver:={DRIVES[drives.stem].driver}"]),
            ],
            out / "launch.log",
        )
        children.append(launch)
        wait_until = partial(_wait_until, log)
        wait_until(lambda row: row["cycle"] * PERIOD >= REST_TIME, f"rest of {REST_TIME:g} s", launch)
        print(f"sending {LINEAR} m/s and {ANGULAR} rad/s for {seconds:g} s")
        sender = Child(["rosrun", "robot_control", "send_cmd.py"], out / "send_cmd.log")
        children.append(sender)
        wait_until(lambda row: row["requested_linear"] == LINEAR, "command", launch, sender)
        if robot == LEGGED_ROBOT:
            fast = lambda row: _is(row, "walking") and row["limited_linear"] == LINEAR  # noqa: E731
            wait_until(fast, "walk at full speed", launch, sender)
        start, due = time.monotonic(), 0.0
        while (driven := time.monotonic() - start) < seconds:
            time.sleep(max(0.0, min(1.0, seconds - driven)))
            _see_alive(launch, sender)
            if driven >= due:  # the longer the log, the longer it takes to read it
                print(_progress(log, time.monotonic() - start))
                due = 1.1 * driven
        print("stopping")
        if not sender.end():
            print(f"send_cmd.py had to be killed; see {sender.output}")
        if robot == LEGGED_ROBOT:
            _lie_down(log, launch, children, out)
        time.sleep(RAMP_TIME)
        if not launch.end():
            print(f"roslaunch had to be killed; see {launch.output}")
    return driven


def _lie_down(log: Path, launch: Child, children: list[Child], out: Path) -> None:
    _wait_until(log, lambda row: _is(row, "standing"), "standing robot", launch)
    print("lying down")
    children.append(Child(["rosservice", "call", "set_posture", "lying"], out / "set_posture.log"))
    _wait_until(log, lambda row: _is(row, "lying"), "lying robot", launch)


@contextlib.contextmanager
def _ended_at_the_end() -> Iterator[list[Child]]:
    """Whatever happens, what was started is ended, the last one first, and its shared memory removed."""
    children: list[Child] = []
    try:
        yield children
    finally:
        for child in reversed(children):
            child.end()
        for left in Path("/dev/shm").glob(f"robot_control.{os.geteuid()}.{BUS}.*"):
            left.unlink(missing_ok=True)


def _wait_until(log: Path, condition: Callable[[Row], bool], what: str, *children: Child) -> None:
    """Polls the last row; raises when one of the children dies or START_LIMIT has passed without a `what`."""
    deadline = time.monotonic() + START_LIMIT
    while (row := _last_row(log)) is None or not condition(row):
        _see_alive(*children)
        if time.monotonic() > deadline:
            raise DemoError(f"no {what} within {START_LIMIT:g} s:\n{_tail(children[0].output)}")
        time.sleep(0.1)


def _see_alive(*children: Child) -> None:
    for child in children:
        if not child.running:
            raise DemoError(f"a part of the loop has died:\n{_tail(child.output)}")


def _progress(log: Path, driven: float) -> str:
    row = _last_row(log)
    if row is None:
        return f"{driven:5.1f} s"
    x, y, speed, turn = (row[f"truth_{name}"] for name in ("x", "y", "linear", "angular"))
    return f"{driven:5.1f} s  true: {speed:6.3f} m/s {turn:6.3f} rad/s at ({x:.2f}, {y:.2f}) m"


def _last_row(log: Path) -> Row | None:
    """Columns of the last complete row of a run.bag that is being written, a second old at most."""
    try:
        columns = read_log(log, SHOWN)
    except (OSError, LogError):  # it has just begun
        return None
    return {name: float(values[-1]) for name, values in columns.items()} if columns["cycle"].size else None


def _is(row: Row, posture: str) -> bool:
    return row["legged_phase"] == number_of("LegPhase", posture)


def _print_refusals(launch_log: str) -> None:
    said = refusals(launch_log)
    for refusal in said:
        print(f"real time: {refusal}")
    if said:
        print("real time: see docs/realtime.md")


def _tail(path: Path, lines: int = 25) -> str:
    return "\n".join(path.read_text(errors="replace").splitlines()[-lines:])


def _interrupt(signal_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt(signal.Signals(signal_number).name)


def main() -> int:
    """Entry point of scripts/demo."""
    given = parse()
    signal.signal(signal.SIGTERM, _interrupt)
    try:
        drives = Path(share_file(f"config/drives/{given.drives}.yaml")) if given.drives else None
        return run_demo(given.seconds, given.out, given.robot, drives, velocity=given.wheel_command == "velocity")
    except (DemoError, OSError) as error:
        print(f"scripts/demo: {in_words(error)}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("scripts/demo: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    run(main)
