"""navigate on a running robot in the scene `room`: goals of its clients reach follow_path and end with a reason."""

import math
import unittest
from collections.abc import Callable
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from robot_control.msg import (
    FollowPathAction,
    NavigateThroughAction,
    NavigateThroughGoal,
    NavigateToAction,
    NavigateToGoal,
)
from std_msgs.msg import Float64
from system.navigation.navigation_support import Localised, message_of, missing, share
from system.system_support import Program, RobotTestCase, again_after_a_stall, wait_for

from bench.navigation.scene_map import read_scene, true_map

SUCCEEDED, ABORTED, PREEMPTED = GoalStatus.SUCCEEDED, GoalStatus.ABORTED, GoalStatus.PREEMPTED
AT_GOAL = 0.15
"""m: 5 cm of the path, and what odometry errs on it"""


@unittest.skipIf(missing(), missing())
class NavigationTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        scene = share("urdf/scenes/room.xml")
        rospy.set_param("/mujoco_plant/scene", str(scene))
        rospy.set_param("/mujoco_plant/laser/rate", 10)
        super().setUpClass()
        cls.publisher = Program("state_publisher.py")
        cls.guard, cls.follower, cls.navigate = (Program(n) for n in ("collision_guard", "follow_path.py", "navigate"))
        actionlib.SimpleActionClient("follow_path", FollowPathAction).wait_for_server(rospy.Duration(30.0))
        cls.localised = Localised()
        cls.map = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        cls.map.publish(message_of(true_map(read_scene(scene))))
        cls.clearances: list[float] = []
        cls.subscriber = rospy.Subscriber("clearance", Float64, lambda message: cls.clearances.append(message.data))

    @classmethod
    def tearDownClass(cls) -> None:
        cls.localised.end()
        for program in (cls.navigate, cls.follower, cls.guard, cls.publisher):
            program.end()
        super().tearDownClass()

    @staticmethod
    def pose(x: float, y: float, yaw: float = 0.0, frame: str = "map") -> PoseStamped:
        target = PoseStamped()
        target.header.frame_id, target.header.stamp = frame, rospy.Time.now()
        target.pose.position.x, target.pose.position.y = x, y
        target.pose.orientation.z, target.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        return target

    def end_of(self, name: str, action: Any, goal: Any, limit: float = 60.0) -> actionlib.SimpleActionClient:
        client = actionlib.SimpleActionClient(name, action)
        self.assertTrue(client.wait_for_server(rospy.Duration(30.0)), self.navigate.output)
        client.send_goal(goal)
        self.assertTrue(client.wait_for_result(rospy.Duration(limit)), f"{self.navigate.output} {self.follower.output}")
        return client

    def await_motion(self, metres: float, every: Callable[[float], object] = lambda moved: None) -> None:
        """`every` is called in each pass with the way of the robot so far, in m."""
        x = self.robot.pose.x
        moved = lambda: abs(self.robot.pose.x - x)  # noqa: E731
        try:
            wait_for(f"a way of {metres:g} m", lambda: moved() > metres, every=lambda: every(moved()))
        except AssertionError as error:
            raise AssertionError(f"{error}: {self.navigate.output} {self.follower.output}") from error

    def assert_reached(self, x: float, y: float) -> None:
        self.robot.await_rest()
        self.assertLess(math.hypot(self.robot.pose.x - x, self.robot.pose.y - y), AT_GOAL)

    @again_after_a_stall
    def test_a_client_of_move_base_comes_to_its_goal_and_the_clearance_follows_the_laser(self) -> None:
        from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal

        self.clearances.clear()
        client = self.end_of("move_base", MoveBaseAction, MoveBaseGoal(self.pose(1.2, 0.1, 1.0)))
        self.assertEqual(
            (client.get_state(), client.get_goal_status_text()), (SUCCEEDED, "reached"), self.navigate.output
        )
        self.assert_reached(1.2, 0.1)
        self.assertGreater(len(self.clearances), 20)
        self.assertTrue(all(map(math.isfinite, self.clearances)))
        self.assertGreater(max(self.clearances) - min(self.clearances), 0.3)

    @again_after_a_stall
    def test_a_goal_of_rviz_is_driven_when_it_is_repeated_and_a_newer_one_of_navigate_to_takes_its_place(self) -> None:
        simple = rospy.Publisher("move_base_simple/goal", PoseStamped, queue_size=1)
        wait_for("navigate", lambda: simple.get_num_connections() > 0)
        first, second = (2.4, 0.2) if self.robot.pose.x < 1.3 else (0.2, 2.4)
        self.await_motion(0.6, lambda moved: moved < 0.3 and simple.publish(self.pose(first, 0.0)))
        client = self.end_of("navigate_to", NavigateToAction, NavigateToGoal(target=self.pose(second, 0.0, math.pi)))
        self.assertEqual((client.get_state(), client.get_result().reason), (SUCCEEDED, "reached"))
        self.assert_reached(second, 0.0)

    @again_after_a_stall
    def test_waypoints_in_any_frame_are_reached_one_after_the_other(self) -> None:
        seen: list[int] = []
        client = actionlib.SimpleActionClient("navigate_through", NavigateThroughAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30.0)), self.navigate.output)
        x = 1.2 if self.robot.pose.x < 0.6 else 0.0
        ahead = self.pose(0.3, 0.0, frame="base_link")  # where the base is when the goal arrives
        at = self.robot.pose
        waypoints = [ahead, self.pose(x, 0.1, frame="odom"), self.pose(0.6, 0.0, 1.0)]
        client.send_goal(
            NavigateThroughGoal(waypoints=waypoints), feedback_cb=lambda feedback: seen.append(feedback.index)
        )
        self.assertTrue(client.wait_for_result(rospy.Duration(90.0)), f"{self.navigate.output} {self.follower.output}")
        result = client.get_result()
        self.assertEqual((client.get_state(), result.reason), (SUCCEEDED, "reached"), self.navigate.output)
        wanted = [(at.x + 0.3 * math.cos(at.yaw), at.y + 0.3 * math.sin(at.yaw)), (x, 0.1), (0.6, 0.0)]
        self.assertEqual([reached.header.frame_id for reached in result.reached], ["map"] * 3)
        for reached, (to_x, to_y) in zip(result.reached, wanted, strict=True):
            away = math.hypot(reached.pose.position.x - to_x, reached.pose.position.y - to_y)
            self.assertLess(away, AT_GOAL)
        self.assertEqual(seen, sorted(seen))
        self.assertEqual(set(seen) & {0, 1, 2}, {0, 1, 2})

    @again_after_a_stall
    def test_a_newer_goal_ends_the_waypoints_and_their_poses_so_far_are_in_the_result(self) -> None:
        client = actionlib.SimpleActionClient("navigate_through", NavigateThroughAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30.0)), self.navigate.output)
        there, far = self.robot.pose, 6.8 if self.robot.pose.x < 4 else 0.0
        client.send_goal(
            NavigateThroughGoal(waypoints=[self.pose(there.x, there.y, there.yaw, "odom"), self.pose(far, 0.0)])
        )
        self.await_motion(0.3)
        x = 1.2 if self.robot.pose.x < 0.6 else 0.0
        self.end_of("navigate_to", NavigateToAction, NavigateToGoal(target=self.pose(x, 0.0)))
        self.assertTrue(client.wait_for_result(rospy.Duration(10.0)))
        self.assertEqual((client.get_state(), client.get_result().reason), (PREEMPTED, "replaced by a newer goal"))
        self.assertEqual(len(client.get_result().reached), 1)
        self.assert_reached(x, 0.0)

    @again_after_a_stall
    def test_a_goal_that_cannot_be_is_refused_with_its_reason_and_nothing_moves(self) -> None:
        wrong = {
            "is in an obstacle": self.pose(3.0, 2.0),
            "is outside the map": self.pose(1e6, 0.0),
            "too near to an obstacle": self.pose(0.0, 0.7),
            "not finite": self.pose(math.nan, 0.0),
            "tf does not connect": self.pose(1.0, 0.0, frame="moon"),
            "no frame": self.pose(1.0, 0.0, frame=""),
        }
        before = self.robot.pose
        for reason, target in wrong.items():
            client = self.end_of("navigate_to", NavigateToAction, NavigateToGoal(target=target))
            self.assertEqual(client.get_state(), ABORTED)
            self.assertIn(reason, client.get_result().reason)
        self.assertLess(math.hypot(self.robot.pose.x - before.x, self.robot.pose.y - before.y), 0.01)

    @again_after_a_stall
    def test_without_a_map_goals_lie_in_odom_or_in_the_axes_of_the_robot(self) -> None:
        self.navigate.end()
        rospy.set_param("/navigate/map_frame", "odom")
        NavigationTest.navigate = Program("navigate")
        try:
            x = 1.2 if self.robot.pose.x < 0.6 else 0.0
            for target in (self.pose(x, 0.1, frame="odom"), self.pose(0.0, 0.0, 1.0, frame="base_link")):
                client = self.end_of("navigate_to", NavigateToAction, NavigateToGoal(target=target))
                self.assertEqual((client.get_state(), client.get_result().reason), (SUCCEEDED, "reached"))
                self.assert_reached(x, 0.1)
            self.assertAlmostEqual(self.robot.pose.yaw, 1.0, delta=0.15)
        finally:
            self.navigate.end()
            rospy.delete_param("/navigate/map_frame")
            NavigationTest.navigate = Program("navigate")

    @again_after_a_stall
    def test_a_cancelled_goal_ends_with_zero(self) -> None:
        client = actionlib.SimpleActionClient("navigate_to", NavigateToAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30.0)))
        client.send_goal(NavigateToGoal(target=self.pose(6.8 if self.robot.pose.x < 4 else 0.0, 0.0)))
        self.await_motion(0.1)
        client.cancel_goal()
        self.assertTrue(client.wait_for_result(rospy.Duration(10.0)))
        self.assertEqual((client.get_state(), client.get_result().reason), (PREEMPTED, "cancelled"))
        self.robot.await_rest()

    @again_after_a_stall
    def test_a_stop_ends_the_goal_and_nothing_moves_after_its_reset(self) -> None:
        client = actionlib.SimpleActionClient("navigate_to", NavigateToAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30.0)))
        client.send_goal(NavigateToGoal(target=self.pose(6.8 if self.robot.pose.x < 4 else 0.0, 0.0)))
        self.await_motion(0.1)
        self.robot.call("e_stop_trigger")
        self.robot.release()
        before = self.robot.pose
        self.assertTrue(client.wait_for_result(rospy.Duration(20.0)), self.navigate.output)
        self.assertEqual(client.get_state(), ABORTED)
        self.assertIn("an earlier path does not start or continue by itself", client.get_result().reason)
        self.assertTrue(self.robot.rests())
        self.assertLess(math.hypot(self.robot.pose.x - before.x, self.robot.pose.y - before.y), 0.01)
