#!/usr/bin/python3
"""send_cmd.py repeats its command and takes it back on Ctrl-C: proven at the receiver."""

import signal
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from system_support import Program, init_test_node, wait_for


class SendCmdTest(unittest.TestCase):
    def setUp(self) -> None:
        self.received: list[tuple[float, float, float]] = []
        self.subscriber = rospy.Subscriber("cmd_vel", Twist, self.hear, tcp_nodelay=True)

    def tearDown(self) -> None:
        self.subscriber.unregister()

    def hear(self, message: Twist) -> None:
        self.received.append((time.monotonic(), message.linear.x, message.angular.z))

    def test_sends_zero_last_when_interrupted(self) -> None:
        for number in (signal.SIGINT, signal.SIGTERM):
            self.received.clear()
            sender = Program("send_cmd.py")
            wait_for("three commands", lambda: len(self.received) >= 3)
            sender.send_signal(number)
            sender.wait()
            wait_for("the zero", lambda: self.received[-1][1:] == (0.0, 0.0))
            times = [at for at, linear, angular in self.received if (linear, angular) == (0.5, 0.2)]
            self.assertGreaterEqual(len(times), 3, self.received)
            self.assertAlmostEqual((times[-1] - times[0]) / (len(times) - 1), 0.5, delta=0.25)
            self.assertIn("0.5 m/s, 0.2 rad/s", sender.output)

    def test_sends_what_it_is_told_and_ends(self) -> None:
        sender = Program("send_cmd.py", "--linear", "-0.3", "--angular", "0", "--period", "0.1", "--count", "4")
        self.assertEqual(sender.wait(), 0, sender.output)
        wait_for("the zero", lambda: bool(self.received) and self.received[-1][1:] == (0.0, 0.0))
        self.assertEqual([linear for _, linear, _ in self.received], [-0.3] * 4 + [0.0])


if __name__ == "__main__":
    init_test_node("send_cmd_test")
    rostest.rosrun("robot_control", "send_cmd", SendCmdTest)
