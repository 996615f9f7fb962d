"""robot_status reports a robot from its absence to its stop."""

import time
import unittest

import rospy
from robot_control.msg import LegState, RobotKind, RobotStatus, SafetyStatus
from system.system_support import (
    CONTROLLER,
    ESTIMATOR,
    STALL_CAUSES,
    Program,
    Robot,
    truncated_messages,
    wait_for,
)

WHEELED = ("differential_drive", CONTROLLER)


class RobotStatusTest(unittest.TestCase):
    def setUp(self) -> None:
        self.reports: list[RobotStatus] = []
        self.robot = Robot()
        self.addCleanup(self.robot.end)
        self.status = Program("robot_status.py")
        self.addCleanup(self.status.end)
        rospy.Subscriber("robot_status", RobotStatus, self.reports.append)

    def await_mode(self, mode: str) -> RobotStatus:
        wait_for(f"mode {mode}; {self.status.output}", lambda: bool(self.reports) and self.reports[-1].mode == mode)
        return self.reports[-1]

    def test_from_offline_to_driving_to_stopped_to_a_lost_node(self) -> None:
        offline = self.await_mode("offline")
        self.assertEqual(offline.health, RobotStatus.ERROR)
        self.assertIn("safety_monitor is silent", offline.problems)
        self.assertRegex(offline.software_version, r"^\d+\.\d+\.\d+$")

        self.robot.start()
        self.robot.await_ready()
        wait_for("health", lambda: self.reports[-1].mode == "idle" and self.reports[-1].health == RobotStatus.OK)
        self.assertGreater(self.reports[-1].odometry_confidence, 0.5)
        began, count = time.monotonic(), len(self.reports)
        wait_for("five messages of an unchanged robot", lambda: len(self.reports) >= count + 5)
        self.assertGreater(time.monotonic() - began, 3.0)

        kinds: list[RobotKind] = []
        rospy.Subscriber("robot_kind", RobotKind, kinds.append)
        wait_for("the kind of the robot", lambda: bool(kinds))
        self.assertEqual((kinds[0].kind, dict(zip(kinds[0].roles, kinds[0].nodes, strict=True))["controller"]), WHEELED)
        self.assertIn("left_encoder", kinds[0].fault_components)

        with truncated_messages({"leg_state": LegState, "robot_kind": RobotKind}):
            count = len(self.reports)
            wait_for("messages after truncated ones", lambda: len(self.reports) >= count + 2)
            self.assertEqual(self.reports[-1].mode, "idle")

        self.robot.drive_until("0.5 m/s", self.robot.driving)
        self.robot.drive_until("who commands", lambda: self.reports[-1].mode == "automatic")
        self.assertEqual(self.reports[-1].senders, [rospy.get_name()])

        self.robot.call("e_stop_trigger")
        wait_for("the stop", lambda: self.robot.state == SafetyStatus.STOPPED)
        stopped = self.await_mode("stopped")
        self.assertTrue(set(stopped.causes) - STALL_CAUSES, stopped.causes)
        self.assertEqual(len(stopped.causes), len(stopped.remedies))

        late: list[RobotStatus] = []
        rospy.Subscriber("robot_status", RobotStatus, late.append)
        wait_for("the latched message", lambda: bool(late))

        self.robot.nodes[ESTIMATOR].kill()
        wait_for("the loss", lambda: "state_estimator is silent" in self.reports[-1].problems)
        self.assertTrue(self.status.running)
