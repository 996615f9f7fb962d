"""send_cmd.py repeats its command while it may, and takes it back on Ctrl-C, as the receiver shows."""

import math
import os
import signal
import time
import unittest

import rosgraph
import rospy
from geometry_msgs.msg import Twist
from robot_control.msg import SafetyStatus
from system.system_support import Program, wait_for


class SendCmdTest(unittest.TestCase):
    def setUp(self) -> None:
        self.received: list[tuple[float, float, float]] = []
        self.subscriber = rospy.Subscriber("cmd_vel", Twist, self.receive, tcp_nodelay=True)
        self.monitor = rospy.Publisher("safety_status", SafetyStatus, queue_size=10, latch=True)
        self.monitor.publish(SafetyStatus(state=SafetyStatus.READY, state_name="READY", speed_limit=math.inf))

    def tearDown(self) -> None:
        self.subscriber.unregister()
        self.monitor.unregister()

    def commands(self) -> list[tuple[float, float]]:
        """Received commands in their order, without the zeros."""
        return [twist for _, *twist in self.received if twist != [0.0, 0.0]]

    def receive(self, message: Twist) -> None:
        self.received.append((time.monotonic(), message.linear.x, message.angular.z))

    def started(self, *arguments: str) -> Program:
        """Starts it with no command received yet."""
        self.received.clear()
        sender = Program("send_cmd.py", *arguments)
        self.addCleanup(sender.end)
        return sender

    def zero_came(self) -> bool:
        return bool(self.received) and self.received[-1][1:] == (0.0, 0.0)

    def test_sends_zero_last_when_interrupted(self) -> None:
        for number in (signal.SIGINT, signal.SIGTERM):
            sender = self.started()
            wait_for("three commands", lambda: len(self.commands()) >= 3)
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
            time.sleep(0.5)  # so that it waits for the master, which every line of its log calls
            sender.send_signal(signal.SIGINT)
            time.sleep(0.5)
        finally:
            os.kill(master, signal.SIGCONT)
        sender.wait()
        wait_for("the zero", self.zero_came)

    def test_sends_what_the_arguments_say_and_ends(self) -> None:
        sender = self.started("--linear", "-0.3", "--angular", "0", "--period", "0.1", "--count", "4")
        self.assertEqual(sender.wait(), 0, sender.output)
        wait_for("the zero", self.zero_came)
        sent = [linear for _, linear, _ in self.received if linear != 0.0]
        self.assertEqual(set(sent), {-0.3}, self.received)
        self.assertLessEqual(len(sent), 4, "one that a stalling machine holds back is replaced by the next")
        self.assertIn("cmd_vel 4:", sender.output)
        self.assertNotIn("cmd_vel 5:", sender.output)

    def test_waits_for_a_subscriber(self) -> None:
        self.subscriber.unregister()
        sender = self.started("--period=0.1", "--count=20")
        wait_for("the missing subscriber", lambda: "no node subscribes to /cmd_vel" in sender.output)
        self.assertNotIn("cmd_vel 1:", sender.output)
        self.subscriber = rospy.Subscriber("cmd_vel", Twist, self.receive, tcp_nodelay=True)
        self.assertEqual(sender.wait(), 0, sender.output)
        wait_for("the zero", self.zero_came)
        self.assertIn([0.5, 0.2], self.commands(), "of 20: one that a stalling machine holds back is replaced")
