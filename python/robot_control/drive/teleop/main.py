"""teleop.py's ROS side: keys in, commands and heartbeat out, one screen."""

import argparse
import time

import rospy
from std_msgs.msg import Empty

from robot_control.drive.keys.dead_man import HoldParameters
from robot_control.drive.keys.key_map import KEY_MAPS
from robot_control.drive.keys.keyboard import REPORT_RELEASES, Decoder, Event
from robot_control.drive.keys.operator import Operator, Request
from robot_control.drive.speed_limits import SpeedLimits
from robot_control.drive.teleop.backlog import Backlog
from robot_control.drive.teleop.screen import View, render
from robot_control.drive.teleop.terminal import NoTerminalError, Terminal
from robot_control.files.files import one_message
from robot_control.robot.boundary import boundary
from robot_control.robot.command import Command, Pace
from robot_control.robot.command_topic import CommandTopic
from robot_control.robot.diagnosis.listener import Listener
from robot_control.robot.ros_master import require_master
from robot_control.robot.ros_node import begin_node
from robot_control.robot.safety_watch import SafetyWatch
from robot_control.robot.send_plan import positive
from robot_control.robot.services import Services, in_words
from robot_control.robot.topic_sender import Signals, ended_by_signals

SOURCE = "key_vel"
FIRST_HOLD = "s that the first byte of a key holds; more than the keyboard's delay until its first repeat"
POLL_PERIOD = 0.02
"""s between two looks at keys and holds; a key is read at once"""
HEARTBEAT_PERIOD = 0.1
"""s"""
FRAME = 0.1
"""s between two screens"""


class Teleop:
    """One loop: read keys, send, draw."""

    def __init__(self, given: argparse.Namespace, terminal: Terminal) -> None:
        self._terminal = terminal
        self._keys = KEY_MAPS[given.keys]
        hold = HoldParameters(first_hold=given.first_hold, max_hold=given.max_hold)
        self._limits = SpeedLimits()
        chosen = Command(given.linear, given.angular, given.lateral)
        self._operator = Operator(self._keys, chosen, self._limits.newest(), hold)
        self._decoder = Decoder()
        self._listener, self._watch = Listener(), SafetyWatch()
        self._services = Services(self._watch)
        self._topic = CommandTopic(SOURCE)
        self._heartbeat = rospy.Publisher("heartbeat", Empty, queue_size=1, tcp_nodelay=True)
        self._pace = Pace(self._topic.send)
        self._beat_at = self._drawn_at = float("-inf")
        self._answer = ""
        self._releases = False
        self._listener.follow_master()

    def run(self, signals: Signals) -> None:
        """Runs until Ctrl-C, a signal, or the end of the terminal (NoTerminalError)."""
        begin = time.monotonic()
        self._operator.start(begin)
        backlog = Backlog(begin)
        while signals.going_on():
            data = self._terminal.read(POLL_PERIOD)
            now = time.monotonic()
            if self._watch.interrupted():
                self._operator.interrupt(now)
            if self._take(data, now, late=backlog.late(data, now)):
                return
            self._operator.permit(self._watch.drivable(), now)
            self._operator.limit(self._limits.newest())
            self._pace.step(self._operator.command(now), now)
            with boundary.crossing("the robot's answers"):
                self._take_answers()
            if now - self._beat_at >= HEARTBEAT_PERIOD:
                self._beat_at = now
                self._heartbeat.publish(Empty())
            if now - self._drawn_at >= FRAME:
                self._drawn_at = now
                with boundary.crossing("the screen"):
                    self._draw(now)

    def _take(self, data: bytes, now: float, *, late: bool) -> bool:
        """True if the program shall end."""
        for key in [*self._decoder.feed(data, now), *self._decoder.flush(now)]:
            if key.event is Event.SPEAKS_KITTY:
                self._releases = True
                self._terminal.write(REPORT_RELEASES)
                continue
            request = self._operator.key(key, now, late=late)
            if request is Request.END:
                return True
            if request is Request.E_STOP:
                self._services.e_stop()
            elif request is Request.RESET:
                self._answer = "the reset was requested"
                self._services.reset()
        return False

    def _take_answers(self) -> None:
        for answer in self._services.poll():
            self._answer = in_words(answer, self._listener.facts())
            if answer.service == "e_stop_reset" and answer.accepted:
                self._operator.reset_accepted()

    def _draw(self, now: float) -> None:
        held = self._operator.held(now)
        view = View(
            keys=self._keys,
            topic=self._topic.name,
            own_name=rospy.get_name(),
            chosen=self._operator.chosen,
            requested=self._pace.last,
            held="" if held is None else f"key {held.key}" + (", slow until it repeats" if held.share < 1 else ""),
            sent_age=None if self._pace.sent_at is None else now - self._pace.sent_at,
            message=self._decoder.unfinished or self._operator.message(now),
            answer=self._answer,
            releases=self._releases,
        )
        _, height = self._terminal.size()
        self._terminal.draw(render(self._listener.facts(), view, height))


def arguments(given: list[str]) -> argparse.Namespace:
    """The command line, without the program's name; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="teleop.py",
        description="Drives the robot with the keyboard of this terminal. A key counts while it repeats: release it, "
        f"and the robot stops. Commands go to {SOURCE} where the robot has a list of command sources, else to "
        "cmd_vel_stamped; a heartbeat goes to heartbeat.",
        epilog="Another robot's: __ns:=robot2. Needs the wall clock: in lockstep every command times out.",
    )
    what = "arrows: arrow keys and w a s d; classic: u i o j k l m , . of teleop_twist_keyboard"
    parser.add_argument("--keys", choices=sorted(KEY_MAPS), default="arrows", help=f"{what} (default %(default)s)")
    for name, default, meaning in (
        ("--linear", 0.5, "m/s, chosen speed, at most the robot's max_linear_speed"),
        ("--angular", 1.0, "rad/s, chosen speed, at most max_angular_speed"),
        ("--lateral", 0.3, "m/s sideways, chosen speed of a robot on legs, at most max_lateral_speed"),
        ("--first-hold", HoldParameters.first_hold, FIRST_HOLD),
        ("--max-hold", HoldParameters.max_hold, "s after which a key that was never released stops the robot"),
    ):
        parser.add_argument(name, type=positive, default=default, help=f"{meaning} (default %(default)s)")
    return parser.parse_args(given)


def main() -> None:
    """Entry point of scripts/teleop.py."""
    given = arguments(rospy.myargv()[1:])
    require_master()
    with one_message("teleop.py", NoTerminalError), Terminal() as terminal:
        begin_node("teleop", anonymous=True)
        with ended_by_signals() as signals:
            Teleop(given, terminal).run(signals)
