#!/usr/bin/python3
"""Stamps in simulated time: the robot's clock is /clock, and stands still while the simulation is paused."""

import time

import rospy
import rostest
from geometry_msgs.msg import TwistStamped
from robot_control.srv import Step
from std_srvs.srv import SetBool
from system.commands_support import StampedSender
from system.system_support import CONTROLLER, DRIVER, LIMIT, RobotTestCase, wait_for


class CommandsLockstepTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.set_param("/use_sim_time", True)
        rospy.set_param("/robot/clock", "lockstep")
        super().setUpClass()
        cls.sender = StampedSender(cls.robot)
        cls.fastest = 0.0
        rospy.Subscriber("cmd_vel_out", TwistStamped, cls.receive)
        rospy.wait_for_service(f"{DRIVER}/step", LIMIT)

    @classmethod
    def receive(cls, message: TwistStamped) -> None:
        cls.fastest = max(cls.fastest, message.twist.linear.x)

    def setUp(self) -> None:
        self.robot.await_ready()
        wait_for("a subscriber", self.sender.connected)
        rospy.ServiceProxy(f"{DRIVER}/set_pause", SetBool)(True)
        self.step(3000)  # all commands have timed out, and the robot stands
        self.await_clock()
        type(self).fastest = 0.0

    def await_clock(self) -> None:
        """Waits until this node's clock stands, too: a stamp of now is then the robot's now."""
        last = -1.0
        while rospy.get_time() != last:
            last = rospy.get_time()
            time.sleep(0.5)

    def step(self, cycles: int) -> None:
        answer = rospy.ServiceProxy(f"{DRIVER}/step", Step)(cycles)
        self.assertTrue(answer.success, answer.message)

    def send(self, age: float, expected: str) -> None:
        """Sends one command, stamped `age` s of simulated time ago; waits for the text in log or diagnostics."""
        self.robot.reports.clear()  # values and log may hold the sender of an earlier command
        logged = len(self.robot.nodes[CONTROLLER].output)
        stamp = rospy.Time.from_sec(rospy.get_time() - age)

        def reported() -> bool:
            log = self.robot.nodes[CONTROLLER].output[logged:]
            return expected in log or expected == self.sender.report.values.get("senders")

        wait_for(expected, reported, every=lambda: self.sender.send(0.5, 0.0, stamp))

    def test_a_command_of_now_drives_however_long_the_pause_lasts(self) -> None:
        self.send(0.0, rospy.get_name())
        time.sleep(2.0)  # longer than cmd_vel_timeout, which counts cycles
        self.step(400)
        # After 0.4 s under 10 m/s³ and 1 m/s²: 0.35 m/s; published every 20 ms.
        wait_for("0.3 m/s on cmd_vel_out", lambda: self.fastest > 0.3)

    def test_a_command_of_two_seconds_ago_does_not(self) -> None:
        self.send(2.0, "s old by its stamp")
        self.step(400)
        wait_for("the reason", lambda: "stale" in self.sender.reasons)
        self.assertEqual(self.fastest, 0.0)

    def test_a_stamp_of_the_wall_clock_is_reported(self) -> None:
        self.send(rospy.get_time() - time.time(), "is not the robot's /clock")
        self.step(400)
        self.assertEqual(self.fastest, 0.0)


if __name__ == "__main__":
    rostest.rosrun("robot_control", "commands_lockstep", CommandsLockstepTest)
