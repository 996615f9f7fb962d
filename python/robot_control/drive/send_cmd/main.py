"""send_cmd.py's ROS side."""

import math
import sys
import time
from collections import deque

import rospy
from geometry_msgs.msg import Twist

from robot_control.drive.send_cmd.release import Line, Phase, Release
from robot_control.loop.roles import NO_LATERAL
from robot_control.msg import SafetyStatus
from robot_control.robot.boundary import boundary, subscribe
from robot_control.robot.interruptions import SURPRISE, Status
from robot_control.robot.live_parameters import LiveParameters
from robot_control.robot.process_start import process_began
from robot_control.robot.robot_kind import running_kind
from robot_control.robot.ros_node import begin_node
from robot_control.robot.safety_watch import status_of
from robot_control.robot.send_plan import SendPlan, parse_plan
from robot_control.robot.topic_sender import Sender, Signals, ended_by_signals

TIMEOUT = 10.0
"""s to wait for a subscriber; then it is sent all the same"""
SILENT_WAIT = 2.0
"""s of these in which nothing is said about it"""
POLL_PERIOD = 0.02
"""s between two looks"""


def _twist(plan: SendPlan) -> Twist:
    message = Twist()
    message.linear.x, message.linear.y = plan.linear, plan.lateral
    message.angular.z = plan.angular
    return message


def _wait_for_subscriber(publisher: rospy.Publisher, signals: Signals) -> None:
    """Waits for a subscriber, so that the first message is not lost."""
    begin = time.monotonic()
    warned = False
    while publisher.get_num_connections() == 0 and signals.going_on() and time.monotonic() < begin + TIMEOUT:
        if not warned and time.monotonic() > begin + SILENT_WAIT:
            warned = True
            rospy.logwarn(f"no node subscribes to {publisher.resolved_name} yet: waiting for {TIMEOUT:g} s at most")
        time.sleep(POLL_PERIOD)


def _say_last(missed: int) -> None:
    """Prints on stdout, because rospy's logging may be closed already."""
    print("cmd_vel: zero" + (f", which {missed} of the subscribers did not take" if missed else ""))


class Statuses:
    """Every message of safety_status: a stop that is followed by a release at once is a stop, too."""

    def __init__(self) -> None:
        self._received: deque[Status] = deque()
        self._parameters = LiveParameters()
        self._subscriber = subscribe("safety_status", SafetyStatus, self._receive, tcp_nodelay=True)

    def update(self, release: Release) -> list[Line]:
        """Hands the messages since the last look to `release`, or how long there were none."""
        newest = [self._received.popleft() for _ in range(len(self._received))]
        release.command_timeout = self._parameters.command_timeout
        return release.step(time.monotonic(), newest, connected=self._subscriber.get_num_connections() > 0)

    def _receive(self, message: SafetyStatus) -> None:
        self._received.append(status_of(message))


def send(plan: SendPlan, signals: Signals) -> int:
    """Sends until the plan ends or the node shall; the last message is always a zero.

    The pace is wall-clock time: with simulated time a sleeping sender would depend on the publisher of /clock.

    Returns:
        The exit code: 1 when a stop ended the command.
    """
    publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
    sender = Sender(publisher, Twist(), _say_last)
    watch = Statuses()
    _wait_for_subscriber(publisher, signals)
    release = Release(time.monotonic(), process_began())
    boundary.stops(lambda: release.interrupt(time.monotonic(), SURPRISE))
    phase = Phase.WAITING
    sent, end = 0, math.inf
    deadline = time.monotonic()
    while plan.sends_left(sent) and signals.going_on() and phase is not Phase.RELEASED and time.monotonic() < end:
        for line in watch.update(release):
            (rospy.logwarn if line.warning else rospy.loginfo)(line.text)
        if release.phase is not phase:
            phase, deadline = release.phase, time.monotonic()  # the other message goes out at once
            if phase is Phase.STOPPED and plan.count is not None:
                end = deadline + (plan.count - sent) * plan.period
        if time.monotonic() < deadline:
            time.sleep(min(POLL_PERIOD, max(0.0, deadline - time.monotonic())))
        elif phase is Phase.SENDING:
            sender.send(_twist(plan))
            sent += 1
            if sent == 1 and plan.lateral and running_kind().wheeled:
                rospy.logwarn(f"--lateral {plan.lateral:g}: {NO_LATERAL}")
            rospy.loginfo(plan.describe(sent))
            deadline += plan.period
        else:
            sender.send(Twist())
            deadline += plan.zero_period
    return 0 if phase in {Phase.WAITING, Phase.SENDING} else 1


def main() -> None:
    """Entry point of scripts/send_cmd.py."""
    plan = parse_plan(rospy.myargv()[1:])
    begin_node("send_cmd")
    with ended_by_signals() as signals:
        code = send(plan, signals)
    sys.exit(code)
