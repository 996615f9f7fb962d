"""why.py's ROS side: receives the robot's reports, queries the master, draws."""

import argparse
import os
import shutil
import sys
import time

import rosgraph
import rospy

from robot_control.robot.boundary import boundary
from robot_control.robot.diagnosis.answer import Verdict
from robot_control.robot.diagnosis.diagnosis import judge
from robot_control.robot.diagnosis.listener import MASTER_PERIOD, Listener
from robot_control.robot.diagnosis.state import Facts
from robot_control.robot.ros_master import Master
from robot_control.robot.ros_node import begin_node
from robot_control.watch.why.screen import Layout, render
from robot_control.watch.words.words import LANGUAGES, Words, words_in

FRAME = 0.25
"""s between two drawings"""
TIMEOUT = 2.5
"""s to wait for a report of every node before the first answer; each node reports once per second"""


class Screen:
    """Overwrites itself on a terminal; elsewhere it prints the changes."""

    def __init__(self, words: Words) -> None:
        self._terminal, self._words = sys.stdout.isatty(), words
        self._last: list[str] = []

    def print_once(self, facts: Facts) -> int:
        """The answer alone; returns the exit code."""
        print("\n".join(render(facts, self._layout())))
        return 1 if judge(facts).verdict is Verdict.STOPPED else 0

    def show(self, facts: Facts) -> None:
        """One frame."""
        lines = render(facts, self._layout())
        essence = lines if self._terminal else render(facts, Layout(times=False))
        if self._terminal:
            start = "\x1b[H" if self._last else "\x1b[2J\x1b[H"
            shown = lines[: max(1, shutil.get_terminal_size((80, 24)).lines - 1)]
            sys.stdout.write(start + "".join(f"{line}\x1b[K\n" for line in shown) + "\x1b[J")
        elif essence != self._last:
            sys.stdout.write("\n".join([*lines, "", ""]))
        self._last = essence
        sys.stdout.flush()

    def _layout(self) -> Layout:
        colour = self._terminal and not os.environ.get("NO_COLOR")
        return Layout(shutil.get_terminal_size((80, 24)).columns, colour, words=self._words)


def _master_is_there(screen: Screen, *, once: bool) -> bool:
    """Waits for the master and reports that on `screen`; `once`: it prints that there is none, and waits no more."""
    namespace = rosgraph.names.get_ros_namespace()
    for argument in sys.argv[1:]:
        namespace = argument.removeprefix("__ns:=") if argument.startswith("__ns:=") else namespace
    master = Master("/why")
    while master.state() is None:
        facts = Facts(master=master.uri, master_answers=False, namespace=f"/{namespace.strip('/')}")
        if once:
            screen.print_once(facts)
            return False
        screen.show(facts)
        time.sleep(MASTER_PERIOD)
    return True


def _listen() -> Listener:
    begin_node("why", anonymous=True)
    listener = Listener()
    end = time.monotonic() + TIMEOUT
    while time.monotonic() < end and not rospy.is_shutdown():
        listener.query_master()
        if listener.complete():
            break
        time.sleep(0.05)
    return listener


def answer_once(screen: Screen) -> int:
    """Prints one answer on stdout and returns the exit code."""
    return screen.print_once(_listen().facts()) if _master_is_there(screen, once=True) else 1


def answer_live(screen: Screen) -> int:
    """Shows answers until interrupted."""
    _master_is_there(screen, once=False)
    listener = _listen()
    while not rospy.is_shutdown():
        with boundary.crossing("the robot's reports"):
            listener.query_master()
            screen.show(listener.facts())
        time.sleep(FRAME)
    return 0


def main() -> None:
    """Entry point of scripts/why.py."""
    about = "Why does the robot not move? Its state, causes with value and limit, what to do, and by whom."
    parser = argparse.ArgumentParser(prog="why.py", description=about, epilog="Another robot's: __ns:=robot2.")
    meaning = "one answer; exit code 1 if something prevents motion, else 0"
    parser.add_argument("--once", action="store_true", help=meaning)
    parser.add_argument("--lang", choices=LANGUAGES, default=LANGUAGES[0], help="language of the answer")
    given = parser.parse_args(rospy.myargv()[1:])
    screen = Screen(words_in(given.lang))
    try:
        sys.exit(answer_once(screen) if given.once else answer_live(screen))
    except KeyboardInterrupt:
        sys.exit(0)
