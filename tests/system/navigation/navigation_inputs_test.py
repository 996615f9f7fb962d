"""navigate with wrong maps, scans and transforms: each goal is refused with the cause, and the node goes on."""

import math
import tempfile
import time
import unittest
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import actionlib
import numpy as np
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import OccupancyGrid, Odometry
from robot_control.msg import (
    FollowPathActionGoal,
    GuardState,
    NavigateThroughAction,
    NavigateThroughGoal,
    NavigateToAction,
    NavigateToGoal,
)
from sensor_msgs.msg import LaserScan
from system.navigation.navigation_support import RAYS, Localised, World, message_of, missing, scan_of, share, transform
from system.system_support import Latest, Process, Program, refusal, truncated_messages, wait_for
from tf2_msgs.msg import TFMessage

HALL = np.zeros((80, 120), dtype=np.int8)
HALL[[0, -1], :] = HALL[:, [0, -1]] = 100
MAP = (-2.0, -2.0, 0.05, HALL)
"""a hall of 6 m by 4 m, with the robot at x = y = 0"""
SECOND = "{header: {frame_id: laser_link}, angle_increment: 0.1, range_max: 9.0, ranges: [1.0, 1.0]}"
"""a scan of another laser"""


@unittest.skipIf(missing(), missing())
class NavigationInputsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.set_param("/robot_description", share("urdf/diffbot.urdf").read_text())
        cls.map = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        cls.static = rospy.Publisher("tf_static", TFMessage, queue_size=1, latch=True)
        cls.static.publish(TFMessage([transform("base_link", "laser_link")]))
        cls.localised, cls.world = Localised(place=0.0), World()
        cls.paths: list[FollowPathActionGoal] = []
        cls.follower = rospy.Subscriber("follow_path/goal", FollowPathActionGoal, cls.paths.append)
        cls.navigate = Program("navigate")
        cls.client = actionlib.SimpleActionClient("navigate_to", NavigateToAction)
        assert cls.client.wait_for_server(rospy.Duration(30.0)), cls.navigate.output

    @classmethod
    def tearDownClass(cls) -> None:
        cls.localised.end()
        cls.navigate.end()

    def goal(self) -> NavigateToGoal:
        goal = NavigateToGoal()
        goal.target.header.frame_id, goal.target.pose.position.x = "map", 2.0
        goal.target.pose.orientation.w = 1.0
        return goal

    def answer(self) -> str:
        """Sends a goal that is right, and returns why it is refused; "driven" if a path is sent."""
        self.paths.clear()
        self.client.send_goal(self.goal())
        end = time.monotonic() + 6.0
        while time.monotonic() < end and not self.paths:
            if self.client.get_state() == GoalStatus.ABORTED:  # its status; the result is another message
                self.assertTrue(self.client.wait_for_result(rospy.Duration(5.0)))
                return str(self.client.get_result().reason)
            time.sleep(0.02)
        self.client.cancel_goal()
        self.client.wait_for_result(rospy.Duration(5.0))
        return "driven" if self.paths else f"no end: {self.navigate.output}"

    @contextmanager
    def broken(self, change: Callable[[LaserScan], LaserScan | None]) -> Iterator[None]:
        self.world.change = change
        try:
            yield
        finally:
            self.world.change = lambda scan: scan
            self.await_answer("driven")

    def await_answer(self, expected: str) -> None:
        """Sends a goal until it is answered so: navigate judges by some scans, or by their absence for a while."""
        answers: list[str] = []

        def found() -> bool:
            answers.append(self.answer())
            return expected in answers[-1]

        try:
            wait_for(expected, found)
        except AssertionError as error:
            raise AssertionError(f"{error}; the answers: {answers}") from None

    def await_refusal(self, expected: str) -> None:
        """Once the reason is there, the next goal has it, too, and moves nothing."""
        self.await_answer(expected)
        self.assertIn(expected, self.answer())
        self.assertEqual(self.paths, [])

    def assert_driven(self) -> None:
        self.assertEqual(self.answer(), "driven")

    def test_1_without_a_map_a_goal_is_refused(self) -> None:
        self.assertIn("no map received", self.answer())

    def test_2_each_wrong_map_is_refused_and_the_right_one_taken(self) -> None:
        def negative(message: OccupancyGrid) -> None:
            message.info.resolution = -0.05

        def turned(message: OccupancyGrid) -> None:
            message.info.origin.orientation.z, message.info.origin.orientation.w = math.sin(0.2), math.cos(0.2)

        def short(message: OccupancyGrid) -> None:
            message.data = message.data[:-1]

        def huge(message: OccupancyGrid) -> None:
            message.info.width = message.info.height = 10_000

        def other_frame(message: OccupancyGrid) -> None:
            message.header.frame_id = "house"

        wrong = {
            "resolution is -0.05": negative,
            "origin is turned by 0.4 rad": turned,
            "9599 cells": short,
            "10000 x 10000 cells": huge,
            "in the frame 'house'": other_frame,
        }
        for reason, spoil in wrong.items():
            message = message_of(MAP)
            spoil(message)
            self.map.publish(message)
            wait_for(reason, lambda reason=reason: reason in self.navigate.output)
        self.assertIn("map is refused: the map is in the frame 'house'", self.answer())
        large = np.full((1100, 1100), -1, dtype=np.int8)  # longer than the 1 MB that other nodes take
        large[:80, :120] = HALL
        for hall in (large, HALL):
            self.map.publish(message_of((*MAP[:3], hall)))
            time.sleep(1.0)
            self.assert_driven()

    def test_3_each_wrong_scan_is_named_and_the_laser_is_trusted_again(self) -> None:
        def ranging(scan: LaserScan, ranges: list[float]) -> LaserScan:
            scan.ranges = ranges
            return scan

        def foreign(scan: LaserScan) -> LaserScan:
            scan.header.frame_id = "moon"
            return scan

        wrong = {
            "no scan": lambda _scan: None,
            "has 0 rays": lambda scan: ranging(scan, []),
            "tf has no transform from the laser": foreign,
            "contradicts the map": lambda _scan: scan_of((-3.0, 5.0, -3.0, 3.0)),
        }
        for reason, change in wrong.items():
            with self.subTest(reason), self.broken(change):
                self.await_refusal(reason)
        with self.broken(lambda scan: ranging(scan, [math.inf] * RAYS)):
            time.sleep(1.0)
            self.assert_driven()  # nothing is near

    def test_4_two_lasers_and_a_silent_localisation_are_named(self) -> None:
        second = Process("rostopic", ["rostopic", "pub", "-r", "10", "scan", "sensor_msgs/LaserScan", SECOND])
        wait_for("both", lambda: "two publishers" in self.navigate.output)
        second.end()
        self.localised.silent = True
        try:
            self.await_refusal("not localised")
        finally:
            self.localised.silent = False  # the tests after this one need the pose
        self.await_answer("driven")

    def test_4_the_pose_follows_odom_while_the_localisation_computes(self) -> None:
        self.localised.silent, self.localised.place = True, 0.05
        time.sleep(0.3)
        self.assert_driven()
        self.localised.silent, self.localised.place = False, 0.0
        self.assertAlmostEqual(self.paths[0].goal.path.poses[0].pose.position.x, 0.05, 6)
        time.sleep(0.5)

    def test_5_a_laser_that_the_guard_doubts_holds_the_goal_and_an_obstacle_before_it_blocks_its_place(self) -> None:
        guard = rospy.Publisher("guard_state", GuardState, queue_size=1)
        costmap = Latest("costmap", OccupancyGrid)
        wait_for("navigate", lambda: guard.get_num_connections() > 0)
        state = GuardState(reason="scan is blind in part", trusted=False)
        state.obstacle.x = math.nan
        timer = rospy.Timer(rospy.Duration(0.1), lambda _event: guard.publish(state))
        self.await_refusal("scan is blind in part")
        state.reason, state.trusted, state.obstacle.x = "an obstacle", True, 1.02
        state.obstacle.y = 0.02
        self.await_answer("driven")
        self.client.send_goal(self.goal())
        row, column = 40, 60  # of the place 1 m ahead, in MAP
        cell = row * HALL.shape[1] + column
        wait_for("the obstacle in the costmap", lambda: costmap.message and costmap.message.data[cell] == 100)
        self.client.cancel_goal()
        timer.shutdown()
        self.await_answer("driven")

    def test_6_all_wrong_parameters_refuse_the_start_at_once(self) -> None:
        rospy.set_param("/wrong", {"speed": "fast", "unknown_is_free": 1, "map_frame": [1], "sped": 0.4})
        refused = refusal("navigate", "__name:=wrong")
        for problem in ("navigate.speed", "must be true or false", "navigate.map_frame", "navigate.sped"):
            self.assertIn(problem, refused)

    def test_6_a_damaged_file_of_zones_refuses_the_start_in_one_message(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            zones = Path(folder) / "zones.yaml"
            zones.write_text("image: zones.pgm\nresolution: -1\norigin: [0, 0, 0]\nnegate: 0\n")
            rospy.set_param("/wrong", {"zones": str(zones)})
            refused = refusal("navigate", "__name:=wrong")
            self.assertIn("zones.yaml: the key occupied_thresh is missing", refused)
            self.assertEqual(refused.count("zones.yaml"), 1, refused)
        rospy.delete_param("/wrong")

    def test_6_waypoints_that_cannot_be_are_refused_with_their_number(self) -> None:
        client = actionlib.SimpleActionClient("navigate_through", NavigateThroughAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30.0)))
        good, lost = self.goal().target, self.goal().target
        lost.header.frame_id = "moon"
        for waypoints, reason in (
            ([], "the goal has 0 waypoints: send 1 to 1000"),
            ([good] * 1001, "the goal has 1001 waypoints"),
            ([good, lost], "waypoint 2 of 2: tf does not connect the goal's frame"),
        ):
            client.send_goal(NavigateThroughGoal(waypoints=waypoints))
            self.assertTrue(client.wait_for_result(rospy.Duration(10.0)), self.navigate.output)
            self.assertEqual((client.get_state(), client.get_result().reached), (GoalStatus.ABORTED, []))
            self.assertIn(reason, client.get_result().reason)

    def test_6_bad_messages_are_refused_and_the_node_goes_on(self) -> None:
        topics = {"scan": LaserScan, "odom": Odometry, "map": OccupancyGrid, "tf": TFMessage}
        with truncated_messages(topics):
            pass
        for topic in topics:
            wait_for(
                topic, lambda topic=topic: f"{topic}: a message of the wrong length was refused" in self.navigate.output
            )
        bad = transform("map", "odom")
        bad.transform.translation.x = math.nan
        publisher = rospy.Publisher("tf", TFMessage, queue_size=1, latch=True)
        publisher.publish(TFMessage([bad]))
        wait_for("the refusal", lambda: "a transform to odom is refused: it is not finite" in self.navigate.output)
        publisher.unregister()
        self.await_answer("driven")

    def test_6_the_state_is_on_diagnostics(self) -> None:
        found = Latest("/diagnostics", DiagnosticArray)
        wait_for("a report", lambda: found.message is not None and found.message.status[0].name == "navigate")
        self.assertIn("goal", {value.key for value in found.message.status[0].values})

    def test_7_one_that_is_started_again_ends_the_path_of_the_one_before(self) -> None:
        cancelled: list[GoalID] = []
        self.assert_driven()
        self.navigate.kill()
        subscriber = rospy.Subscriber("follow_path/cancel", GoalID, cancelled.append)
        self.__class__.navigate = Program("navigate")
        wait_for("the end of all paths before", lambda: bool(cancelled))
        self.assertGreater(cancelled[0].stamp, self.paths[-1].goal_id.stamp)
        self.assertEqual(cancelled[0].id, "")
        subscriber.unregister()
