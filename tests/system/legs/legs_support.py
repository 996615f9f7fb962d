"""sim.launch robot:=quadbot for the tests of robots on legs. A case begins when no stall stops the robot any more."""

import os
import time
import unittest
from pathlib import Path

import rospy
from nav_msgs.msg import Odometry
from robot_control.msg import LegState, SafetyStatus
from std_srvs.srv import Trigger
from system.launch_support import Launch
from system.system_support import LIMIT, LOOP_WITNESS, STALL_CAUSES, wait_for

BUS = f"legs{os.getpid()}.{time.monotonic_ns()}"


class LegsTestCase(unittest.TestCase):
    """The robot is launched once for all cases; where it is `shared`, once for all classes of this process."""

    launch: Launch | None = None
    shared = False
    legs: LegState | None = None
    safety: SafetyStatus | None = None
    truth: Odometry | None = None
    stopped_at = 0.0

    @classmethod
    def launch_quadbot(cls) -> None:
        rospy.Subscriber("leg_state", LegState, lambda message: setattr(cls, "legs", message))
        rospy.Subscriber("safety_status", SafetyStatus, cls.receive_safety)
        rospy.Subscriber("ground_truth/odom", Odometry, cls.receive_truth)
        if LegsTestCase.launch is None:
            LegsTestCase.launch = Launch("robot:=quadbot", "black_box:=false", f"bus:={BUS}")
        if not cls.shared:
            cls.addClassCleanup(cls.end_launch)

    @staticmethod
    def end_launch() -> None:
        if LegsTestCase.launch is not None:
            LegsTestCase.launch.end()
            for path in Path("/dev/shm").glob(f"robot_control.*.{BUS}.*"):
                path.unlink(missing_ok=True)

    @classmethod
    def receive_safety(cls, message: SafetyStatus) -> None:
        if message.causes and not (cls.safety and cls.safety.causes):
            cls.stopped_at = time.monotonic()
        cls.safety = message

    @classmethod
    def receive_truth(cls, message: Odometry) -> None:
        cls.truth = message

    @property
    def robot(self) -> "LegsTestCase":
        """This case: again_after_a_stall reads whether its robot is `stalled`."""
        return self

    @property
    def stalled(self) -> bool:
        """True if only causes of a stall stopped the robot, within a second of a stall that the witness measured."""
        near = (self.stopped_at - 1.0, self.stopped_at + 1.0)
        causes = set(self.safety.causes) if self.safety else set()
        return bool(causes) and causes <= STALL_CAUSES and LOOP_WITNESS.saw(*near)

    def setUp(self) -> None:
        if self.stalled:
            reset = rospy.ServiceProxy("e_stop_reset", Trigger)
            wait_for("an accepted reset", lambda: reset().success, every=lambda: time.sleep(0.2))
        wait_for("permission", lambda: self.safety and self.safety.permit_name == "drive", 2 * LIMIT)
