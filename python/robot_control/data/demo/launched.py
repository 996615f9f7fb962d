"""The launch of a demonstration: its processes, and how far its log is."""

import contextlib
import os
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from robot_control.data.demo.arguments import LEGS
from robot_control.data.run_log import LogError, read_log
from robot_control.loop.drives import drive_of
from robot_control.loop.signal_names import number_of
from robot_control.ui.child import Child, children

LINEAR, ANGULAR = 0.5, 0.2
"""m/s, rad/s: what send_cmd.py sends by default; the source article's command."""
REST_TIME = 2.0
"""s of the robot's clock before it drives: at rest it learns the bias of its gyro, to 0.35 mrad/s in that time."""
BUS = f"demo_{os.getpid()}"
"""The bus belongs to this demo alone, which removes it: 12 MB that outlive the nodes would fill a small /dev/shm."""
SHOWN = (
    *("cycle", "requested_linear", "limited_linear", "legged_phase"),
    *("truth_x", "truth_y", "truth_linear", "truth_angular"),
)
"""columns that show how far the run is"""
Row = dict[str, float]
"""column → value"""


class DemoError(RuntimeError):
    """Something did not start, or died; the message names the file with the reason."""


@dataclass(frozen=True)
class Driven:
    """A robot, its clock and its files."""

    robot: str
    """an included robot or a URDF file"""
    legged: bool
    out: Path
    parameters: Path
    """laid over those of the package"""
    drives: Path | None = None
    period: float = 1e-3
    """s"""


def launch(driven: Driven, arguments: Sequence[str]) -> Child:
    """Starts sim.launch on the master of the environment, with `arguments` of it, and run.bag in `out`."""
    which = f"robot:={driven.robot}" if driven.robot in LEGS else f"urdf:={driven.robot}"
    out, drives = driven.out, driven.drives
    port = os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1].strip("/")
    return Child(
        [
            *("roslaunch", "-p", port, "robot_control", "sim.launch", which),
            *("telemetry:=true", "black_box:=false", f"out:={out}", f"bus:={BUS}", f"params:={driven.parameters}"),
            *([] if drives is None else [f"drives:={drives}", f"driver:={drive_of(drives).driver}"]),
            *arguments,
        ],
        out / "launch.log",
    )


@contextlib.contextmanager
def ended_at_the_end() -> Iterator[list[Child]]:
    """Whatever happens, what was started is ended, the last one first, and its shared memory removed."""
    try:
        with children() as started:
            yield started
    finally:
        for left in Path("/dev/shm").glob(f"robot_control.{os.geteuid()}.{BUS}.*"):
            left.unlink(missing_ok=True)


def wait_until(log: Path, condition: Callable[[Row], bool], what: str, limit: float, *parts: Child) -> None:
    """Polls the last row; raises when one of the parts dies or `limit` seconds have passed without a `what`."""
    deadline = time.monotonic() + limit
    while (row := last_row(log)) is None or not condition(row):
        see_alive(*parts)
        if time.monotonic() > deadline:
            raise DemoError(f"no {what} within {limit:g} s:\n{tail(parts[0].output)}")
        time.sleep(0.1)


def see_alive(*parts: Child) -> None:
    """Raises when one of them has ended."""
    for child in parts:
        if not child.running:
            raise DemoError(f"a part of the loop has ended:\n{tail(child.output)}")


def progress(row: Row | None, seconds: float) -> str:
    """One line: `seconds`, and the true motion of the row."""
    if row is None:
        return f"{seconds:5.1f} s"
    x, y, speed, turn = (row[f"truth_{name}"] for name in ("x", "y", "linear", "angular"))
    return f"{seconds:5.1f} s  true: {speed:6.3f} m/s {turn:6.3f} rad/s at ({x:.2f}, {y:.2f}) m"


def last_row(log: Path) -> Row | None:
    """Columns of the last complete row of a run.bag that is being written, a second old at most."""
    try:
        columns = read_log(log, SHOWN)
    except (OSError, LogError):  # it has just begun
        return None
    return {name: float(values[-1]) for name, values in columns.items()} if columns["cycle"].size else None


def is_in(row: Row, phase: str) -> bool:
    """True if the robot on legs is in this phase."""
    return row["legged_phase"] == number_of("LegPhase", phase)


def tail(path: Path, lines: int = 25) -> str:
    """The last lines of a file."""
    return "\n".join(path.read_text(errors="replace").splitlines()[-lines:])
