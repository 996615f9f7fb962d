#!/usr/bin/python3
"""Publishers whose messages are not of the length that their type has."""

import time
from io import BytesIO

import rospy
import rostest
from geometry_msgs.msg import Twist, TwistStamped
from std_msgs.msg import Bool
from system_support import CONTROLLER, MONITOR, RobotTestCase, wait_for

COMPLAINT = "a message of the wrong length was refused"


class LongTwist(Twist):
    """A megabyte of ones, which read as tiny speeds."""

    def serialize(self, buff: BytesIO) -> None:
        buff.write(b"\x01" * 1_000_000)


class ShortTwist(Twist):
    """Half a message."""

    def serialize(self, buff: BytesIO) -> None:
        buff.write(b"\x00" * 24)


class LongName(TwistStamped):
    """Zero speed in a frame whose name has a million letters."""

    def __init__(self) -> None:
        super().__init__()
        self.header.frame_id = "a" * 1_000_000


class NoBool(Bool):
    """Nothing at all."""

    def serialize(self, buff: BytesIO) -> None:
        buff.write(b"")


class MalformedTest(RobotTestCase):
    def test_what_is_no_command_is_not_taken_for_one(self) -> None:
        self.robot.await_ready()
        self.robot.drive_until("0.5 m/s", self.robot.driving)
        publishers = [
            (rospy.Publisher("cmd_vel", LongTwist, queue_size=1), LongTwist()),
            (rospy.Publisher("cmd_vel", ShortTwist, queue_size=1), ShortTwist()),
            (rospy.Publisher("cmd_vel_stamped", LongName, queue_size=1), LongName()),
        ]
        for publisher, _ in publishers:
            wait_for("a subscriber", lambda p=publisher: p.get_num_connections() > 0, every=self.drive)
        end = time.monotonic() + 2.0
        while time.monotonic() < end:
            for publisher, message in publishers:
                publisher.publish(message)
            self.drive()
            self.assertTrue(self.robot.driving())
            time.sleep(0.02)
        log = self.robot.nodes[CONTROLLER].output
        self.assertEqual(log.count(f"cmd_vel: {COMPLAINT}"), 1, log)
        self.assertEqual(log.count(f"cmd_vel_stamped: {COMPLAINT}"), 1, log)
        self.assertNotIn("deserializing", log)  # roscpp's own line, once per message

    def test_what_is_no_bool_on_e_stop_stops(self) -> None:
        self.robot.await_ready()
        e_stop = rospy.Publisher("e_stop", NoBool, queue_size=1)
        wait_for("a subscriber", lambda: e_stop.get_num_connections() > 0)
        e_stop.publish(NoBool())
        wait_for("the stop", lambda: "e_stop_topic" in self.robot.causes)
        self.assertIn(f"e_stop: {COMPLAINT}", self.robot.nodes[MONITOR].output)
        self.robot.send_e_stop(False)
        self.robot.release()

    def drive(self) -> None:
        self.robot.send(0.5, 0.2)


if __name__ == "__main__":
    rostest.rosrun("robot_control", "malformed", MalformedTest)
