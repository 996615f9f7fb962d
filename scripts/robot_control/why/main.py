"""why.py's ROS side: listens, asks the master, draws."""

import argparse
import os
import shutil
import sys
import time
from collections.abc import Sequence
from typing import Any, TextIO

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry

from robot_control.common.ros_master import COMMAND_TOPICS, Master, senders_of
from robot_control.msg import SafetyStatus
from robot_control.why.diagnosis import LOOP, SILENCE, Facts, Report, Safety, Verdict, judge
from robot_control.why.facts import below, nodes_of, other_robots, safety_of
from robot_control.why.screen import Look, render

FRAME = 0.25
"""s between two drawings"""
MASTER_PERIOD = 1.0
"""s between two questions to the master"""
PATIENCE = 2.5
"""s to wait for a report of every node before the first answer; each node reports once per second"""


class Listener:
    """The last message of each topic."""

    def __init__(self) -> None:
        self.namespace = rospy.get_namespace().rstrip("/") or "/"
        self.master = Master(rospy.get_name())
        self._state: Sequence[Any] | None = None
        self._asked = 0.0
        self._status: SafetyStatus | None = None
        self._status_at = 0.0
        self._reports: dict[str, tuple[float, Report]] = {}  # by absolute name
        self._limited: tuple[float, float, float] | None = None  # m/s, rad/s, when
        self._measured: tuple[float, float, float] | None = None
        self.strangers = 0  # how often in a row the master did not know this program
        rospy.Subscriber("safety_status", SafetyStatus, self._receive_status)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._receive_diagnostics)
        rospy.Subscriber("cmd_vel_out", TwistStamped, self._receive_limited, queue_size=1)
        rospy.Subscriber("odom", Odometry, self._receive_odometry, queue_size=1)

    def _receive_status(self, message: SafetyStatus) -> None:
        self._status, self._status_at = message, time.monotonic()

    def _receive_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            report = Report(status.message, {pair.key: pair.value for pair in status.values})
            self._reports["/" + status.name.lstrip("/")] = (time.monotonic(), report)

    def _receive_limited(self, message: TwistStamped) -> None:
        self._limited = (message.twist.linear.x, message.twist.angular.z, time.monotonic())

    def _receive_odometry(self, message: Odometry) -> None:
        self._measured = (message.twist.twist.linear.x, message.twist.twist.angular.z, time.monotonic())

    def ask_master(self) -> None:
        """At most every MASTER_PERIOD; waits up to ros_master.TIMEOUT."""
        now = time.monotonic()
        if now - self._asked < MASTER_PERIOD:
            return
        self._asked = now
        self._state = self.master.state()
        known = self._state is None or rospy.get_name() in nodes_of(self._state)
        self.strangers = 0 if known else self.strangers + 1

    def complete(self) -> bool:
        """Every node of the loop has reported."""
        facts = self.facts()
        return facts.safety is not None and all(facts.there(node) for node in LOOP)

    def facts(self) -> Facts:
        """As of now."""
        now = time.monotonic()
        state = self._state or ([], [], [])
        reports = {name: Report(last.message, last.values, now - at) for name, (at, last) in self._reports.items()}
        return Facts(
            master=self.master.uri,
            master_answers=self._state is not None,
            namespace=self.namespace,
            safety=self._safety(now),
            reports={below(self.namespace, name): report for name, report in reports.items()},
            registered=frozenset(below(self.namespace, name) for name in nodes_of(state)),
            elsewhere=other_robots(self.namespace, (name for name, report in reports.items() if report.age < SILENCE)),
            senders=senders_of(state[0], map(rospy.resolve_name, COMMAND_TOPICS), rospy.get_name()),
            seers=senders_of(state[0], [rospy.resolve_name("clearance")], rospy.get_name()),
            limited=_fresh(self._limited, now),
            measured=_fresh(self._measured, now),
        )

    def _safety(self, now: float) -> Safety | None:
        if self._status is None:
            return None
        held = max(0.0, (rospy.Time.now() - self._status.since).to_sec()) if self._status.since else 0.0
        return safety_of(self._status, held, now - self._status_at)


def _fresh(pair: tuple[float, float, float] | None, now: float) -> tuple[float, float] | None:
    return None if pair is None or now - pair[2] > SILENCE else pair[:2]


def _look_of(stream: TextIO) -> Look:
    colour = stream.isatty() and not os.environ.get("NO_COLOR")
    return Look(shutil.get_terminal_size((80, 24)).columns, colour)


class Screen:
    """Draws over itself on a terminal; elsewhere prints what changed."""

    def __init__(self) -> None:
        self._terminal = sys.stdout.isatty()
        self._last: list[str] = []

    def show(self, facts: Facts) -> None:
        """One frame."""
        lines = render(facts, _look_of(sys.stdout))
        essence = lines if self._terminal else render(facts, Look(times=False))
        if self._terminal:
            start = "\x1b[H" if self._last else "\x1b[2J\x1b[H"
            shown = lines[: max(1, shutil.get_terminal_size((80, 24)).lines - 1)]
            sys.stdout.write(start + "".join(f"{line}\x1b[K\n" for line in shown) + "\x1b[J")
        elif essence != self._last:
            sys.stdout.write("\n".join([*lines, "", ""]))
        self._last = essence
        sys.stdout.flush()


def _print_once(facts: Facts) -> int:
    print("\n".join(render(facts, _look_of(sys.stdout))), flush=True)
    return 1 if judge(facts).verdict is Verdict.STOPPED else 0


def _master_is_there(screen: Screen | None) -> bool:
    """Waits for it and says so on `screen`; without a screen prints that there is none."""
    namespace = rosgraph.names.get_ros_namespace()
    for argument in sys.argv[1:]:
        namespace = argument.removeprefix("__ns:=") if argument.startswith("__ns:=") else namespace
    master = Master("/why")
    while master.state() is None:
        facts = Facts(master=master.uri, master_answers=False, namespace=f"/{namespace.strip('/')}")
        if screen is None:
            _print_once(facts)
            return False
        screen.show(facts)
        time.sleep(MASTER_PERIOD)
    return True


def _listen() -> Listener:
    rospy.init_node("why", anonymous=True)
    listener = Listener()
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end and not rospy.is_shutdown():
        listener.ask_master()
        if listener.complete():
            break
        time.sleep(0.05)
    return listener


def answer_once() -> int:
    """One answer on stdout; the exit code."""
    return _print_once(_listen().facts()) if _master_is_there(None) else 1


def answer_live() -> int:
    """Until interrupted."""
    screen = Screen()
    _master_is_there(screen)
    listener = _listen()
    while not rospy.is_shutdown():
        listener.ask_master()
        screen.show(listener.facts())
        if listener.strangers > 1:  # another master: this program is no part of its graph
            os.execv(sys.executable, [sys.executable, *sys.argv])
        time.sleep(FRAME)
    return 0


def main() -> None:
    """Entry point of scripts/why.py."""
    parser = argparse.ArgumentParser(
        prog="why.py",
        description="Why does the robot not move? Its state, causes with value and limit, what to do, and by whom.",
        epilog="Another robot's: __ns:=robot2.",
    )
    parser.add_argument(
        "--once", action="store_true", help="one answer; exit code 1 if something stands against motion, else 0"
    )
    given = parser.parse_args(rospy.myargv(sys.argv)[1:])
    try:
        sys.exit(answer_once() if given.once else answer_live())
    except KeyboardInterrupt:
        sys.exit(0)
