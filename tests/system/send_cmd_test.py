#!/usr/bin/python3
"""send_cmd.py repeats its command and takes it back on Ctrl-C: proven at the receiver."""

import os
import signal
import time
import unittest

import rosgraph
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

    def started(self, *arguments: str) -> Program:
        """With nothing received yet."""
        self.received.clear()
        sender = Program("send_cmd.py", *arguments)
        self.addCleanup(sender.end)
        return sender

    def zero_came(self) -> bool:
        return bool(self.received) and self.received[-1][1:] == (0.0, 0.0)

    def test_sends_zero_last_when_interrupted(self) -> None:
        for number in (signal.SIGINT, signal.SIGTERM):
            sender = self.started()
            wait_for("three commands", lambda: len(self.received) >= 3)
            sender.send_signal(number)
            sender.wait()
            wait_for(f"the zero after {number}", self.zero_came)
            times = [at for at, linear, angular in self.received if (linear, angular) == (0.5, 0.2)]
            self.assertGreaterEqual(len(times), 3, self.received)
            self.assertAlmostEqual((times[-1] - times[0]) / (len(times) - 1), 0.5, delta=0.25)
            self.assertIn("0.5 m/s, 0.2 rad/s", sender.output)

    def test_ends_while_the_master_does_not_answer(self) -> None:
        sender = self.started("--period=0.1")
        wait_for("a command", lambda: bool(self.received))
        master = rosgraph.Master(rospy.get_name()).getPid()
        os.kill(master, signal.SIGSTOP)
        try:
            time.sleep(0.5)  # so that it waits for the master: every line of its log asks there
            sender.send_signal(signal.SIGINT)
            time.sleep(0.5)
        finally:
            os.kill(master, signal.SIGCONT)
        sender.wait()
        wait_for("the zero", self.zero_came)

    def test_sends_what_it_is_told_and_ends(self) -> None:
        sender = self.started("--linear", "-0.3", "--angular", "0", "--period", "0.1", "--count", "4")
        self.assertEqual(sender.wait(), 0, sender.output)
        wait_for("the zero", self.zero_came)
        sent = [linear for _, linear, _ in self.received if linear != 0.0]
        self.assertEqual(set(sent), {-0.3}, self.received)
        self.assertLessEqual(len(sent), 4, "one that a stalling machine holds back is replaced by the next")
        self.assertIn("cmd_vel 4:", sender.output)
        self.assertNotIn("cmd_vel 5:", sender.output)

    def test_waits_for_somebody_who_listens(self) -> None:
        self.subscriber.unregister()
        sender = self.started("--period=0.1", "--count=1")
        wait_for("that nobody does", lambda: "nobody listens on /cmd_vel" in sender.output)
        self.assertNotIn("cmd_vel 1:", sender.output)
        self.subscriber = rospy.Subscriber("cmd_vel", Twist, self.hear, tcp_nodelay=True)
        self.assertEqual(sender.wait(), 0, sender.output)
        wait_for("the zero", self.zero_came)
        self.assertEqual(self.received[0][1:], (0.5, 0.2))


if __name__ == "__main__":
    init_test_node("send_cmd_test")
    rostest.rosrun("robot_control", "send_cmd", SendCmdTest)
