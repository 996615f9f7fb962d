"""ROS time jumps while the robot drives in `clock: wall`: the loop counts cycles, and paces them by a clock that does
not jump."""

import itertools
import os
import random
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from system.losses_support import FAST, FULL_SPEED, KEPT, JumpingClock
from system.system_support import RobotTestCase, wait_for

SPELL = 0.4
"""s between two jumps."""
JUMPS = (3600.0, -3600.0, 0.0, 86400.0, 0.5, -0.5, 1e8)
"""s from the true time."""


class LossesTimeTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.clock = JumpingClock(os.environ["JUMPING_CLOCK_LIBRARY"], Path(tempfile.mkdtemp()) / "offset")
        with cls.clock.worn():
            super().setUpClass()

    def setUp(self) -> None:
        self.robot.await_ready()
        self.robot.drive_until("1 m/s", lambda: self.robot.speed > FAST, FULL_SPEED, 0.0)

    def tearDown(self) -> None:
        self.clock.jump(0.0)

    def slowest_during(self, jump: Callable[[float], None]) -> float:
        """Smallest speed over all jumps, m/s. Stops that a stalling machine latches meanwhile are released, and that
        spell is repeated.
        """
        slowest = FULL_SPEED
        for seconds in JUMPS:
            jump(seconds)
            end = time.monotonic() + SPELL
            while time.monotonic() < end:
                self.robot.send(FULL_SPEED, 0.0)
                slowest = min(slowest, self.robot.speed)
                time.sleep(0.01)
        return slowest

    def expect_no_change(self, jump: Callable[[float], None]) -> None:
        stamps: list[float] = []
        subscriber = rospy.Subscriber("odom", Odometry, lambda m: stamps.append(m.header.stamp.to_sec()))
        slowest = self.slowest_during(jump)
        if self.robot.stalled:
            self.robot.drive_until("1 m/s again", lambda: self.robot.speed > FAST, FULL_SPEED, 0.0)
            slowest = self.slowest_during(jump)
        subscriber.unregister()
        print(f"  slowest: {slowest:.3f} m/s")
        self.assertEqual(self.robot.causes, set())
        self.assertGreater(slowest, KEPT)
        self.assertGreater(min(b - a for a, b in itertools.pairwise(stamps)), 0, "stamps grow")

    def test_jumps_of_the_wall_clock_change_no_motion(self) -> None:
        self.expect_no_change(self.clock.jump)
        self.clock.jump(3600.0)
        stamps: list[float] = []
        rospy.Subscriber("/diagnostics", DiagnosticArray, lambda m: stamps.append(m.header.stamp.to_sec()))
        wait_for("nodes that live in an hour", lambda: any(stamp > time.time() + 3000.0 for stamp in stamps))

    def test_a_clock_topic_with_wild_times_changes_no_motion(self) -> None:
        rospy.set_param("/use_sim_time", True)  # the running nodes must ignore it
        publisher = rospy.Publisher("/clock", Clock, queue_size=1)
        lots = random.Random(0)
        try:
            self.expect_no_change(lambda _: publisher.publish(Clock(rospy.Time.from_sec(lots.uniform(0, 4e9)))))
        finally:
            rospy.set_param("/use_sim_time", False)
            publisher.unregister()
