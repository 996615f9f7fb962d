"""pad.py's ROS side: a device or the topic joy in, commands out."""

import argparse
import math
import sys
import time
from collections import deque
from importlib.util import find_spec

import rospy
from sensor_msgs.msg import Joy

from robot_control.drive.pad.device import PACKAGE, Device, open_device
from robot_control.drive.pad_law import Pad, PadParameters
from robot_control.files.files import one_message, printable
from robot_control.robot.boundary import boundary, subscribe
from robot_control.robot.command import SEND_PERIOD, Pace
from robot_control.robot.command_topic import CommandTopic
from robot_control.robot.robot_kind import running_kind
from robot_control.robot.ros_node import running_node
from robot_control.robot.safety_watch import SafetyWatch
from robot_control.robot.server_values import ServerValueError, server_tree
from robot_control.robot.topic_sender import Signals
from robot_control.robot.view import View
from robot_control.settings.files import NUMBER, Rule, SettingsError, in_range, rules_of, wrong_values

SOURCE = "joy_vel"
PERIOD = 0.02
"""s between two looks at the device"""
SEARCH_PERIOD = 1.0
"""s between two looks for a device"""
MESSAGES = 100
"""on joy, kept between two looks"""
REFUSED = "the controller refuses what was requested before a stop: zero; release the enable button once"


ABOVE_ZERO: Rule = ("a number above zero", lambda value: NUMBER[1](value) and value > 0)
SHARE: Rule = ("a number of 0 to below 1", lambda value: in_range(0, 1)(value) and value < 1)
RULES = rules_of(PadParameters, deadzone=SHARE, max_hold=ABOVE_ZERO, joy_timeout=ABOVE_ZERO)


def parameters() -> PadParameters:
    """The private ROS parameters of this node over the defaults. Raises SettingsError, ServerValueError."""
    given = server_tree("~")
    if problems := "; ".join(wrong_values(given, RULES, "~")):
        raise SettingsError(problems)
    return PadParameters(**given)


class Source:
    """The source of axes and buttons."""

    def __init__(self, pad: Pad, path: str | None, *, topic: bool) -> None:
        self._pad, self._path = pad, path
        self._device: Device | None = None
        self._searched_at = self._published_at = -math.inf
        self._publisher = None if topic else rospy.Publisher("joy", Joy, queue_size=1)
        self._received: deque[Joy] = deque(maxlen=MESSAGES)
        if topic:
            subscribe("joy", Joy, self._received.append, queue_size=MESSAGES, tcp_nodelay=True)

    def poll(self, now: float) -> None:
        """Hands new messages or the device's state to the pad."""
        if self._publisher is None:
            while self._received:
                message = self._received.popleft()
                sender = message._connection_header.get("callerid", "")  # noqa: SLF001 (where rospy keeps it)
                self._pad.receive(message.axes, message.buttons, now, printable(sender))
            return
        if self._device is None and now - self._searched_at >= SEARCH_PERIOD:
            self._searched_at = now
            self._device = open_device(self._path)
            if self._device is not None:
                rospy.loginfo(f"pad: {self._device.name}")
        if self._device is None:
            return
        try:
            axes, buttons = self._device.read()
        except OSError:
            rospy.logwarn(f"{self._device.name} is gone: zero")
            self._device = None
            self._pad.lose()
            return
        self._pad.receive(axes, buttons, now)
        if now - self._published_at >= SEND_PERIOD:
            self._published_at = now
            message = Joy(axes=list(axes), buttons=list(buttons))
            message.header.stamp = rospy.Time.now()
            self._publisher.publish(message)


def drive(given: argparse.Namespace, signals: Signals) -> None:
    """Drives until a signal comes."""
    pad, topic = Pad(parameters()), CommandTopic(SOURCE)
    source = Source(pad, given.device, topic=given.joy)
    pad.start(time.monotonic())
    pace, said = Pace(topic.send), ""
    watch, view, refused = SafetyWatch(), View("drive_state", "leg_state"), False
    while signals.going_on():
        now = time.monotonic()
        with boundary.crossing("the pad"):
            source.poll(now)
        if why := watch.interrupted():
            pad.interrupt(now)
            rospy.logwarn(f"{why}: release the enable button once")
        before, refused = refused, view.refused
        if refused:
            pad.refuse(now)
            if not before:
                rospy.logwarn(REFUSED)
        pad.legged = running_kind().legged
        pad.permit(watch.drivable())
        pace.step(pad.command(now), now)
        if pad.state(now) != said:
            said = pad.state(now)
            rospy.loginfo(said)
        time.sleep(PERIOD)


def arguments(given: list[str]) -> argparse.Namespace:
    """The command line, without the program's name; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="pad.py",
        description="Drives the robot with a game pad while its enable button is held. Commands go to joy_vel where "
        "the robot has a list of command sources, else to cmd_vel_stamped; axes and buttons go to joy.",
        epilog="Parameters as in teleop_twist_joy: _axis_linear:=1 _scale_linear:=0.5 _enable_button:=4 …",
    )
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--device", help="for instance /dev/input/event5; left out: the first pad there is")
    where.add_argument("--joy", action="store_true", help="take the messages on joy of a pad on another machine")
    return parser.parse_args(given)


@one_message("pad.py", SettingsError, ServerValueError)
def main() -> None:
    """Entry point of scripts/pad.py."""
    given = arguments(rospy.myargv()[1:])
    if not given.joy and find_spec("evdev") is None:
        sys.exit(f"pad.py: needs the package {PACKAGE} (apt install {PACKAGE}); or --joy and a pad on another machine")
    with running_node("pad") as signals:
        drive(given, signals)
