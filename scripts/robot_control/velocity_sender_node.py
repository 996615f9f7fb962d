"""send_cmd.py's ROS side."""

import sys
import time

import rospy
from geometry_msgs.msg import Twist

from robot_control.velocity_sender import SendPlan, parse_plan


def _twist(linear: float, angular: float) -> Twist:
    message = Twist()
    message.linear.x = linear
    message.angular.z = angular
    return message


def _wait_for_subscriber(publisher: rospy.Publisher, limit: float) -> None:
    """Waits up to `limit` seconds, so that the first send is not lost."""
    end = time.monotonic() + limit
    while publisher.get_num_connections() == 0 and not rospy.is_shutdown() and time.monotonic() < end:
        time.sleep(0.02)


def send(plan: SendPlan) -> None:
    """Sends until the plan ends or the node is shut down; the last message is always a zero.

    The zero leaves from `rospy.on_shutdown`: there the connections are still open, in a `finally` they are not.
    The pace is wall-clock time: with simulated time a sleeping sender would depend on who publishes /clock.
    """
    publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)

    def send_zero() -> None:
        publisher.publish(Twist())
        print("cmd_vel: zero", flush=True)  # rospy's logging is already closed here
        time.sleep(0.1)  # lets the socket's thread send it

    rospy.on_shutdown(send_zero)
    _wait_for_subscriber(publisher, 2.0)
    sent = 0
    deadline = time.monotonic()
    while plan.sends_left(sent) and not rospy.is_shutdown():
        publisher.publish(_twist(plan.linear, plan.angular))
        sent += 1
        rospy.loginfo(plan.describe(sent))
        deadline += plan.period
        while not rospy.is_shutdown() and time.monotonic() < deadline:
            time.sleep(min(0.05, max(0.0, deadline - time.monotonic())))


def main() -> None:
    """Entry point of scripts/send_cmd.py."""
    plan = parse_plan(rospy.myargv(sys.argv)[1:])
    rospy.init_node("send_cmd")
    send(plan)
