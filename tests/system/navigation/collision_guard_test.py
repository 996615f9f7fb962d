"""The node collision_guard: its clearance for every request, several lasers, hostile scans and the mode off."""

import math
import time
import unittest

import numpy as np
import rospy
from geometry_msgs.msg import TwistStamped
from robot_control.msg import GuardState
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64
from system.navigation.navigation_support import Localised, World, scan_of, share, transform
from system.system_support import Latest, Program, truncated_messages, wait_for
from tf2_msgs.msg import TFMessage

AHEAD, BEHIND = 2.0, -0.8
"""m from the laser to the walls before and behind the robot"""
FRONT, REAR = 0.12, 0.28
"""m that the robot reaches ahead of its base, and behind"""


def wall_scan() -> LaserScan:
    return scan_of((BEHIND, AHEAD, -1.5, 1.5))


class CollisionGuardTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.set_param("/robot_description", share("urdf/diffbot.urdf").read_text())
        rospy.set_param("/collision_guard", {"scans": ["scan", "scan_rear"]})
        cls.static = rospy.Publisher("tf_static", TFMessage, queue_size=1, latch=True)
        cls.static.publish(TFMessage([transform("base_link", "laser_link")]))
        cls.localised, cls.world = Localised(place=0.0), World()
        cls.rear = rospy.Publisher("scan_rear", LaserScan, queue_size=1)
        cls.rear_change = staticmethod(lambda scan: scan)
        cls.timer = rospy.Timer(rospy.Duration(0.1), cls.publish_rear)
        cls.request = rospy.Publisher("cmd_vel_requested", TwistStamped, queue_size=1)
        cls.requested = TwistStamped()
        cls.requests = rospy.Timer(rospy.Duration(0.05), lambda _event: cls.request.publish(cls.requested))
        cls.clearance, cls.state = Latest("clearance", Float64), Latest("guard_state", GuardState)
        cls.guard = Program("collision_guard")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.requests.shutdown()
        cls.timer.shutdown()
        cls.localised.end()
        cls.guard.end()

    @classmethod
    def publish_rear(cls, _event: object) -> None:
        if (scan := cls.rear_change(wall_scan())) is not None:
            cls.rear.publish(scan)

    def setUp(self) -> None:
        self.world.change = lambda _scan: wall_scan()
        self.drive(0.5)
        wait_for("a free way", lambda: self.free > 1.5)

    @property
    def free(self) -> float:
        return self.clearance.message.data if self.clearance.message else -1.0

    def drive(self, linear: float) -> None:
        self.requested.twist.linear.x = linear

    def test_the_request_says_which_way_counts(self) -> None:
        self.assertAlmostEqual(self.free, AHEAD - FRONT, delta=0.1)
        self.drive(-0.5)
        wait_for("the way back", lambda: abs(self.free - (-BEHIND - REAR)) < 0.1)
        self.assertEqual(self.state.message.header.frame_id, "base_link")
        self.assertTrue(self.state.message.trusted)

    def test_a_silent_laser_leaves_no_way_whichever_it_is(self) -> None:
        self.world.change = lambda _scan: None
        wait_for("no way", lambda: self.free == 0.0)
        wait_for("the reason", lambda: "no scan" in self.state.message.reason)  # it is another message
        self.world.change = lambda _scan: wall_scan()
        wait_for("a free way", lambda: self.free > 1.5)
        type(self).rear_change = staticmethod(lambda _scan: None)
        wait_for("no way again", lambda: self.free == 0.0)
        type(self).rear_change = staticmethod(lambda scan: scan)

    def test_a_front_without_echo_is_named_and_leaves_no_way(self) -> None:
        def blind(_scan: LaserScan) -> LaserScan:
            scan = wall_scan()
            ranges = np.array(scan.ranges)
            ranges[120:240] = math.inf
            scan.ranges = ranges.tolist()
            return scan

        self.world.change = blind
        wait_for("no way", lambda: self.free == 0.0)
        wait_for("the reason", lambda: "scan is blind in part" in self.state.message.reason)
        self.assertFalse(self.state.message.trusted)

    def test_hostile_messages_end_nothing_and_release_nothing(self) -> None:
        def late(seconds: float) -> LaserScan:
            scan = wall_scan()
            scan.header.stamp -= rospy.Duration(seconds)
            return scan

        def huge(_scan: LaserScan) -> LaserScan:
            scan = wall_scan()
            scan.angle_increment, scan.ranges = 1e-5, [5.0] * 30_000
            return scan

        for wrong in (huge, lambda _scan: late(5.0), lambda _scan: late(-5.0)):
            self.world.change = wrong
            wait_for("no way", lambda: self.free == 0.0)
            self.world.change = lambda _scan: wall_scan()
            wait_for("a free way", lambda: self.free > 1.5)
        with truncated_messages({"scan": LaserScan, "cmd_vel_requested": TwistStamped}):
            pass
        self.drive(math.nan)
        time.sleep(0.5)
        self.assertLess(self.free, AHEAD)
        self.assertTrue(self.guard.running, self.guard.output)

    def test_the_mode_off_ends_the_limit(self) -> None:
        rospy.set_param("/guard_off", {"guard": "off"})
        off = Program("collision_guard", "__name:=guard_off", "clearance:=other_clearance")
        other = Latest("other_clearance", Float64)
        wait_for("no limit", lambda: other.message is not None and math.isinf(other.message.data))
        off.end()
