"""latency.py's ROS side: receives /diagnostics, prints a table once per second, saves a plot at the end."""

import argparse
import contextlib
import sys
import time
from collections import deque

import rospy
from diagnostic_msgs.msg import DiagnosticArray

from robot_control.files.files import given_path
from robot_control.robot.boundary import subscribe
from robot_control.robot.diagnosis.recent import Diagnostics, values_of
from robot_control.robot.ros_master import require_master
from robot_control.robot.ros_node import begin_node
from robot_control.ui.picture_file import check_picture
from robot_control.watch.latency.figures import Figures, figures_of, table

FRAME = 1.0
"""s between two tables; nodes report once per second"""
FIGURE = "period_10s_us"
"""Key of a report with figures"""
MAX_SAMPLES = 1_000_000
"""of the plot; four nodes make them in three days"""


class Listener:
    """Keeps the newest values of each node with figures, and all figures for the plot."""

    def __init__(self) -> None:
        self._reports = Diagnostics()
        self._start = time.monotonic()
        self.samples: deque[tuple[float, str, dict[str, Figures]]] = deque(maxlen=MAX_SAMPLES)
        subscribe("/diagnostics", DiagnosticArray, self._receive, queue_size=100)

    def _receive(self, message: DiagnosticArray) -> None:
        now = time.monotonic()
        for status in message.status:
            values = values_of(status)
            if FIGURE in values:
                self.samples.append((now - self._start, status.name, figures_of(values)))

    def nodes(self) -> dict[str, dict[str, str]]:
        """Node → values, of those that report."""
        newest = [status for _, (_, status) in sorted(self._reports.items(time.monotonic()).items())]
        return {each.name: values for each in newest if FIGURE in (values := values_of(each))}


def show(listener: Listener, seconds: float) -> None:
    """Prints until `seconds` have passed (0: until it is interrupted). On a terminal each table replaces the last."""
    end = time.monotonic() + seconds if seconds else float("inf")
    terminal = sys.stdout.isatty()
    while not rospy.is_shutdown() and time.monotonic() < end:
        time.sleep(FRAME)
        nodes = listener.nodes()
        lines = table(nodes) if nodes else ["no node of the loop reports; check that it runs on the wall clock"]
        print(("\x1b[2J\x1b[H" if terminal else "") + "\n".join(lines), flush=True)


def main() -> None:
    """Entry point of scripts/timing/latency.py."""
    parser = argparse.ArgumentParser(
        prog="latency.py",
        description="How punctual are the real-time threads? Period, wake-up latency, execution time, sensor to "
        "command and sensor to torque of each node, live from /diagnostics.",
    )
    parser.add_argument("--seconds", type=float, default=0.0, help="end after so many seconds (0: at Ctrl-C)")
    parser.add_argument("--plot", type=given_path, metavar="FILE", help="at the end, draw the figures over time")
    given = parser.parse_args(rospy.myargv()[1:])
    if not 0 <= given.seconds < float("inf"):
        parser.error(f"--seconds {given.seconds:g} must be 0 (until Ctrl-C) or more")
    if given.plot:
        try:
            check_picture(given.plot)
        except ValueError as error:
            parser.error(str(error))
    require_master()
    begin_node("latency", anonymous=True)
    listener = Listener()
    with contextlib.suppress(KeyboardInterrupt):
        show(listener, given.seconds)
    if not listener.samples:
        listened = f" in {given.seconds:g} s" if given.seconds else ""
        what = f"latency.py: no node has reported{listened}"
        sys.exit(f"{what}; nodes report once per second, and only on the wall clock (robot.clock: wall)")
    if given.plot:
        from robot_control.watch.latency.picture import draw  # noqa: PLC0415 (matplotlib takes a second)

        draw(list(listener.samples), given.plot)
        print(f"written: {given.plot}")
