"""slam and localization on a running robot in the scene `room`: a map grows, is saved, and the robot is found in it."""

import math
import tempfile
import unittest
from pathlib import Path

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from nav_msgs.msg import OccupancyGrid
from robot_control.msg import LocalizationState
from robot_control.srv import MapFile
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty
from system.navigation.navigation_support import missing_mrpt, share
from system.system_support import Latest, Program, RobotTestCase, again_after_a_stall, wait_for
from tf2_msgs.msg import TFMessage


@unittest.skipIf(missing_mrpt(), missing_mrpt())
class MappingTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.set_param("/mujoco_plant/scene", str(share("urdf/scenes/room.xml")))
        rospy.set_param("/mujoco_plant/laser/rate", 10)
        super().setUpClass()
        cls.publisher = Program("state_publisher.py")
        cls.state = Latest("localization_state", LocalizationState)
        cls.map = Latest("map", OccupancyGrid)
        cls.corrections: list[tuple[float, float]] = []
        cls.tf = rospy.Subscriber("tf", TFMessage, cls.receive_tf)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.publisher.end()
        super().tearDownClass()

    @classmethod
    def receive_tf(cls, message: TFMessage) -> None:
        places = [each.transform.translation for each in message.transforms if each.header.frame_id == "map"]
        cls.corrections += [(place.x, place.y) for place in places]

    def await_state(self, state: str) -> None:
        wait_for(f"the state {state}", lambda: self.state.message is not None and self.state.message.state == state)

    def turn(self, seconds: float) -> None:
        commands = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        twist = Twist()
        twist.angular.z = 0.8
        for _ in range(round(seconds * 10)):
            commands.publish(twist)
            rospy.sleep(0.1)
        commands.publish(Twist())

    @again_after_a_stall
    def test_a_map_is_saved_and_the_robot_is_found_in_it(self) -> None:
        self.corrections.clear()
        start = self.robot.pose
        path = Path(tempfile.mkdtemp()) / "room"
        slam = Program("slam")
        try:
            self.await_state("localized")
            wait_for("a map", lambda: self.map.message is not None)
            self.turn(4.0)
            saved = rospy.ServiceProxy("save_map", MapFile)(str(path))
            self.assertTrue(saved.success, saved.message)
            refused = rospy.ServiceProxy("load_map", MapFile)(f"{path}_of_another.yaml")
            self.assertFalse(refused.success)
            self.assertIn(f"{path}_of_another.yaml", refused.message)
        finally:
            slam.end()
        begin = self.corrections[0]  # the map's origin is where the robot was
        self.assertLess(max(math.dist(begin, correction) for correction in self.corrections), 0.1)
        rospy.set_param("/localization/map", f"{path}.yaml")
        localization = Program("localization")
        try:
            self.await_state("no pose")
            self.assertIn("initialpose", self.state.message.reason)
            poses = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1, latch=True)
            given = PoseWithCovarianceStamped()
            turned = self.robot.pose.yaw - start.yaw
            given.pose.pose.orientation.z, given.pose.pose.orientation.w = math.sin(turned / 2), math.cos(turned / 2)
            poses.publish(given)
            wait_for("the refusal of a pose in no frame", lambda: "its frame is ''" in localization.output)
            given.header.frame_id = "map"
            given.pose.covariance[0] = given.pose.covariance[7] = given.pose.covariance[35] = 0.2
            poses.publish(given)
            self.await_state("localized")
            found = Latest("amcl_pose", PoseWithCovarianceStamped)
            self.turn(3.0)
            wait_for("a pose", lambda: found.message is not None)
            place = found.message.pose.pose.position
            self.assertLess(math.hypot(place.x, place.y), 0.15, localization.output)  # it turned on the spot
            rospy.ServiceProxy("global_localization", Empty)()
            self.await_state("searching")
            self.assertIn("drive on", self.state.message.reason)
            self.turn(8.0)
            self.await_state("localized")
        finally:
            localization.end()

    @again_after_a_stall
    def test_a_scan_that_cannot_be_is_refused_in_one_sentence(self) -> None:
        slam = Program("slam")
        other = rospy.Publisher("scan", LaserScan, queue_size=1)
        try:
            self.await_state("localized")
            wait_for("a subscriber", lambda: other.get_num_connections() > 0)
            bad = LaserScan(angle_min=-1.0, angle_increment=0.01, range_max=5.0, ranges=[1.0] * 100_000)
            bad.header.frame_id, bad.header.stamp = "laser_link", rospy.Time.now()
            other.publish(bad)
            wait_for("the refusal", lambda: "scan has 100000 rays: allowed are 2 to 20000" in slam.output)
            self.assertTrue(slam.running)
        finally:
            other.unregister()
            slam.end()
