"""The topic `clearance`: the free way ahead caps the speed."""

import math

import rospy
from std_msgs.msg import Float64
from system.system_support import RobotTestCase, wait_for

DELAY, DECELERATION = 0.03, 0.5
"""s, m/s²: stop_delay and stop_deceleration of robot_params.yaml"""


def allowed_speed(clearance: float) -> float:
    """m/s: the root of v·t + v²/2a = clearance."""
    return DECELERATION * (math.sqrt(DELAY**2 + 2 * clearance / DECELERATION) - DELAY)


class ClearanceTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.clearance = rospy.Publisher("clearance", Float64, queue_size=1, latch=True)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.clearance.publish(math.inf)
        super().tearDownClass()

    def test_it_caps_the_speed_and_gives_it_free_again(self) -> None:
        self.robot.drive_until("0.5 m/s", self.robot.driving, angular=0.0)
        self.clearance.publish(0.05)
        limit = allowed_speed(0.05)
        wait_for("the limit in the status", lambda: abs(self.robot.status.speed_limit - limit) < 1e-6)
        # 2 %: the largest error of the estimated speed; the controller keeps the limit at the wheels.
        self.robot.drive_until("the allowed speed", lambda: self.robot.speed < 1.02 * limit, angular=0.0)
        self.robot.drive_until("that speed, and no standstill", lambda: self.robot.speed > 0.9 * limit, angular=0.0)
        self.clearance.publish(100.0)
        self.robot.drive_until("0.5 m/s again", self.robot.driving, angular=0.0)
        self.assertEqual(self.robot.causes, set())

    def test_a_sender_that_falls_silent_leaves_no_free_way(self) -> None:
        for _ in range(5):
            self.clearance.publish(100.0)
            rospy.sleep(0.1)
        wait_for("no free way", lambda: self.robot.status.speed_limit == 0)
        self.clearance.publish(math.inf)
        wait_for("the limit to end", lambda: self.robot.status.speed_limit > 0)
        self.assertEqual(self.robot.causes, set())
