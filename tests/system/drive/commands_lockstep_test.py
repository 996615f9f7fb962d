"""Stamps in simulated time: the robot's clock is /clock, and stands still while the simulation is paused."""

import time

import rospy
from geometry_msgs.msg import TwistStamped
from robot_control.srv import Step
from std_srvs.srv import SetBool
from system.commands_support import StampedSender
from system.system_support import DRIVER, LIMIT, RobotTestCase, wait_for

rospy.set_param("/use_sim_time", True)  # before this process becomes a node, whose clock is then the robot's


class CommandsLockstepTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
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
        last = -1.0
        while rospy.get_time() != last:  # a stamp of now is the robot's now once this node's clock stands, too
            last = rospy.get_time()
            time.sleep(0.5)
        self.robot.reports.clear()

    def step(self, cycles: int) -> None:
        answer = rospy.ServiceProxy(f"{DRIVER}/step", Step)(cycles)
        self.assertTrue(answer.success, answer.message)

    def test_a_command_of_now_drives_however_long_the_pause_lasts(self) -> None:
        wait_for(
            "its sender",
            lambda: self.sender.report.values.get("senders") == rospy.get_name(),
            every=lambda: self.sender.send_aged(0.5, 0.0),
        )
        time.sleep(2.0)  # longer than cmd_vel_timeout, which counts cycles
        self.step(400)
        # After 0.4 s under 10 m/s³ and 1 m/s²: 0.35 m/s; published every 20 ms.
        wait_for("0.3 m/s on cmd_vel_out", lambda: self.fastest > 0.3)
