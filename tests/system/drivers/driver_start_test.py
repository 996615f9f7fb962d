"""A machine that starts slowly, never, or not at all: what it waits for is said everywhere, and nothing moves."""

import math
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from robot_control.msg import RobotStatus, SafetyStatus
from system.drivers.driver_support import LEFT, STANDING, DriverTestCase
from system.system_support import MONITOR, Program, again_after_a_stall

SLOW = 10.0
"""s"""


class DriverStartTest(DriverTestCase):
    def setUp(self) -> None:
        super().setUp()
        self.diagnostics = ""
        self.robot_status: RobotStatus | None = None
        for topic, kind, receive in (
            ("/diagnostics", DiagnosticArray, self.receive_diagnostics),
            ("robot_status", RobotStatus, self.receive_status),
        ):
            subscriber = rospy.Subscriber(topic, kind, receive)
            self.addCleanup(subscriber.unregister)

    def receive_diagnostics(self, message: DiagnosticArray) -> None:
        values = [value.value for status in message.status for value in status.values]
        self.diagnostics = " ".join([self.diagnostics[-10_000:], *values])

    def receive_status(self, message: RobotStatus) -> None:
        self.robot_status = message

    def why(self) -> str:
        program = Program("why.py", "--once")
        program.wait()
        return program.output

    @again_after_a_stall
    def test_a_machine_that_needs_ten_seconds_is_awaited_without_motion_and_drives_then(self) -> None:
        status = Program("robot_status.py")
        self.addCleanup(status.end)
        began = time.monotonic()
        self.wait_for("safety_status", lambda: "hardware is starting" in " ".join(self.missing()))
        self.wait_for("/diagnostics", lambda: LEFT in self.diagnostics)
        self.wait_for("robot_status", lambda: self.robot_status is not None and self.robot_status.mode == "starting")
        self.assertIn(LEFT, self.robot.nodes["driver"].output)
        self.assertIn(LEFT, self.why())
        while time.monotonic() < began + SLOW:
            self.robot.send(0.5, 0.2)
            time.sleep(0.05)
        self.assertTrue(self.robot.state == SafetyStatus.INIT or self.robot.stalled, str(self.robot.status))
        self.start_devices()
        self.wait_for(
            "the end of INIT", lambda: self.robot.state != SafetyStatus.INIT, every=lambda: self.robot.send(0.5, 0.2)
        )
        self.wait_for("the truth", lambda: not math.isnan(self.true_speed), every=lambda: self.robot.send(0.5, 0.2))
        time.sleep(0.5)
        self.assertLess(abs(self.true_speed), STANDING)  # zero first
        self.robot.await_ready()
        self.drive()

    @again_after_a_stall
    def test_a_machine_that_never_gets_ready_is_a_fault_until_it_is_and_is_reset(self) -> None:
        self.robot.nodes[MONITOR].end()
        rospy.set_param(f"{MONITOR}/start_timeout", 2.0)
        self.addCleanup(rospy.delete_param, f"{MONITOR}/start_timeout")
        self.robot.start(MONITOR)
        self.wait_for("the fault", lambda: "machine_not_ready" in self.robot.causes)
        self.assertIn("machine", self.why())
        self.start_devices()
        self.release()
        self.drive()

    def test_a_driver_that_cannot_start_says_why_and_ends(self) -> None:
        self.robot.nodes["driver"].end()
        rospy.set_param("robot/drives", "/nowhere/drives.yaml")
        self.addCleanup(rospy.set_param, "robot/drives", str(self.drives))
        program = Program("driver")
        self.assertNotEqual(program.wait(), 0)
        self.assertIn("/nowhere/drives.yaml", program.output)
