"""send_cmd.py's ROS side."""

import sys
import time

import rospy
from geometry_msgs.msg import Twist

from robot_control.topic_sender import Sender, Signals, ended_by_signals
from robot_control.velocity_sender import SendPlan, parse_plan

PATIENCE = 10.0
"""s to wait for somebody who listens; then it is sent all the same"""
PATIENCE_UNTOLD = 2.0
"""s of these in which nothing is said about it"""
LOOK = 0.02
"""s between two looks"""


def _twist(linear: float, angular: float) -> Twist:
    message = Twist()
    message.linear.x = linear
    message.angular.z = angular
    return message


def _wait_for_subscriber(publisher: rospy.Publisher, signals: Signals) -> None:
    """So that the first send is not lost."""
    begin = time.monotonic()
    told = False
    while publisher.get_num_connections() == 0 and signals.going_on() and time.monotonic() < begin + PATIENCE:
        if not told and time.monotonic() > begin + PATIENCE_UNTOLD:
            told = True
            rospy.logwarn(f"nobody listens on {publisher.resolved_name} yet: waiting for {PATIENCE:g} s at most")
        time.sleep(LOOK)


def _say_last(missed: int) -> None:
    """On stdout: rospy's logging may be closed already."""
    print("cmd_vel: zero" + (f", which {missed} of those who listen did not take" if missed else ""), flush=True)


def send(plan: SendPlan, signals: Signals) -> None:
    """Sends until the plan ends or the node shall; the last message is always a zero.

    The pace is wall-clock time: with simulated time a sleeping sender would depend on who publishes /clock.
    """
    publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
    sender = Sender(publisher, Twist(), _say_last)
    _wait_for_subscriber(publisher, signals)
    sent = 0
    deadline = time.monotonic()
    while plan.sends_left(sent) and signals.going_on():
        sender.send(_twist(plan.linear, plan.angular))
        sent += 1
        rospy.loginfo(plan.describe(sent))
        deadline += plan.period
        while signals.going_on() and time.monotonic() < deadline:
            time.sleep(min(0.05, max(0.0, deadline - time.monotonic())))


def main() -> None:
    """Entry point of scripts/send_cmd.py."""
    plan = parse_plan(rospy.myargv(sys.argv)[1:])
    rospy.init_node("send_cmd")
    with ended_by_signals() as signals:
        send(plan, signals)
