"""The action follow_path on a running robot with a list of command sources."""

import math
import signal
import time
from collections.abc import Callable, Sequence

import actionlib
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus
from geometry_msgs.msg import PoseStamped, TransformStamped, TwistStamped
from robot_control.msg import (
    FollowPathAction,
    FollowPathActionGoal,
    FollowPathActionResult,
    FollowPathFeedback,
    FollowPathGoal,
    FollowPathResult,
)
from std_srvs.srv import Trigger, TriggerResponse
from system.system_support import LISTED_SOURCES, Program, RobotTestCase, again_after_a_stall, wait_for
from tf2_msgs.msg import TFMessage

SUCCEEDED, ABORTED, PREEMPTED = GoalStatus.SUCCEEDED, GoalStatus.ABORTED, GoalStatus.PREEMPTED

Points = Sequence[tuple[float, float]]


class Client:
    """One goal: its feedback, state and result."""

    def __init__(self, goal: FollowPathGoal) -> None:
        self.feedback: list[FollowPathFeedback] = []
        self._client = actionlib.SimpleActionClient("follow_path", FollowPathAction)
        if not self._client.wait_for_server(rospy.Duration(30.0)):
            raise AssertionError("no action server")
        self._client.send_goal(goal, feedback_cb=self.feedback.append)

    def cancel(self) -> None:
        self._client.cancel_goal()

    def says(self, state: str, reason: str = "") -> bool:
        """True if the last feedback has this state and reason."""
        return bool(self.feedback) and self.feedback[-1].state == state and reason in self.feedback[-1].reason

    def end(self) -> tuple[int, FollowPathResult]:
        if not self._client.wait_for_result(rospy.Duration(60.0)):
            raise AssertionError(f"no end; {self.feedback[-1:]}")
        return self._client.get_state(), self._client.get_result()


class FollowPathTest(RobotTestCase):
    parameters = (LISTED_SOURCES,)

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.server = Program("follow_path.py")
        cls.cancel = rospy.Publisher("follow_path/cancel", GoalID, queue_size=1, tcp_nodelay=True)
        cls.key = rospy.Publisher("key_vel", TwistStamped, queue_size=1, tcp_nodelay=True)
        cls.tf = rospy.Publisher("tf", TFMessage, queue_size=1)
        cls.sent: list[float] = []
        cls.subscriber = rospy.Subscriber("path_vel", TwistStamped, lambda m: cls.sent.append(m.twist.linear.x))

    @classmethod
    def tearDownClass(cls) -> None:
        cls.server.end()
        super().tearDownClass()

    def setUp(self) -> None:
        # All goals until now, which an attempt leaves that a stall ended. A later one is not meant, if this is late.
        self.cancel.publish(GoalID(stamp=rospy.Time.now()))
        self.robot.await_ready()
        self.robot.await_rest()

    def goal(self, points: Points, frame: str = "odom", **fields: float) -> FollowPathGoal:
        """A goal with points ahead of the robot, x forward."""
        goal = FollowPathGoal(**fields)
        goal.path.header.frame_id = frame
        here = self.robot.pose
        x0, y0, yaw = (here.x, here.y, here.yaw) if frame in {"odom", "map"} else (0.0, 0.0, 0.0)
        for x, y in points:
            pose = PoseStamped()
            pose.pose.position.x = x0 + x * math.cos(yaw) - y * math.sin(yaw)
            pose.pose.position.y = y0 + x * math.sin(yaw) + y * math.cos(yaw)
            goal.path.poses.append(pose)
        return goal

    def straight(self, length: float, frame: str = "odom", **fields: float) -> FollowPathGoal:
        return self.goal([(0.0, 0.0), (length, 0.0)], frame, **fields)

    def await_motion(self, client: Client, speed: float = 0.3) -> None:
        try:
            wait_for(f"{speed} m/s", lambda: abs(self.robot.speed) > speed)
        except AssertionError as error:
            raise AssertionError(f"{error}; {client.feedback[-1:]}; {self.server.output}") from None
        wait_for("feedback", lambda: client.says("driving"))

    def await_rest(self) -> None:
        wait_for("standstill", self.robot.rests)

    @staticmethod
    def service(name: str) -> TriggerResponse:
        return rospy.ServiceProxy(f"/follow_path/{name}", Trigger)()

    @again_after_a_stall
    def test_a_path_is_driven_to_its_end_with_feedback(self) -> None:
        client = Client(self.straight(1.0, speed=0.4))
        state, result = client.end()
        self.assertEqual((state, result.reason), (SUCCEEDED, "done"), self.server.output)
        self.assertAlmostEqual(result.distance, 1.0, delta=0.01)
        self.assertLess(result.worst_cross_track_error, 0.03)
        driven = [feedback for feedback in client.feedback if feedback.state == "driving"]
        self.assertGreater(len(driven), 5)
        for feedback in driven:
            self.assertAlmostEqual(feedback.distance + feedback.remaining_distance, 1.0, delta=1e-6)
            self.assertAlmostEqual(feedback.progress, feedback.distance, delta=1e-6)
            self.assertLess(abs(feedback.cross_track_error), 0.03)
            self.assertLess(abs(feedback.heading_error), 0.1)
        self.await_rest()

    @again_after_a_stall
    def test_a_goal_that_is_cancelled_ends_with_zero(self) -> None:
        client = Client(self.straight(4.0))
        self.await_motion(client)
        client.cancel()
        state, result = client.end()
        self.assertEqual((state, result.reason), (PREEMPTED, "cancelled"))
        self.assertGreater(result.distance, 0.02)
        self.await_rest()
        self.assertEqual(self.sent[-1], 0.0)

    @again_after_a_stall
    def test_a_newer_goal_replaces_the_present_one_without_a_stop(self) -> None:
        first = Client(self.straight(4.0))
        self.await_motion(first, 0.4)
        before = len(self.sent)
        second = Client(self.straight(2.0))
        self.assertEqual(first.end()[1].reason, "replaced by a newer goal")
        wait_for("feedback of the second", lambda: second.says("driving") and second.feedback[-1].distance > 0.2)
        self.assertGreater(min(self.sent[before:]), 0.3)
        state, result = second.end()
        self.assertEqual((state, result.reason), (SUCCEEDED, "done"))

    @again_after_a_stall
    def test_a_newer_goal_that_cannot_be_driven_stops_the_robot(self) -> None:
        first = Client(self.straight(4.0))
        self.await_motion(first)
        state, result = Client(self.straight(1.0, "mars")).end()
        self.assertEqual(state, ABORTED)
        self.assertIn("tf does not connect", result.reason)
        self.await_rest()

    @again_after_a_stall
    def test_a_paused_goal_stands_until_it_is_resumed(self) -> None:
        client = Client(self.straight(1.2))
        self.await_motion(client)
        self.assertTrue(self.service("pause").success)
        self.await_rest()
        wait_for("paused in the feedback", lambda: client.says("paused", "~pause was called"))
        time.sleep(1.0)
        self.assertTrue(self.robot.rests())
        self.assertTrue(self.service("resume").success)
        self.assertEqual(client.end()[0], SUCCEEDED)
        self.assertEqual(self.service("resume").message, "no path is driven")

    @again_after_a_stall
    def test_a_masked_goal_pauses_and_goes_on_when_it_is_told_to(self) -> None:
        client = Client(self.straight(1.2))
        self.await_motion(client)
        mask = rospy.Timer(rospy.Duration(0.1), lambda _: self.key.publish(TwistStamped()))
        wait_for("paused in the feedback", lambda: client.says("paused", "masked by key_vel"))
        self.assertEqual(self.service("resume").message, "path_vel is masked by key_vel")
        mask.shutdown()
        self.await_rest()
        wait_for("resume taken", lambda: bool(self.service("resume").success))
        self.assertEqual(client.end()[0], SUCCEEDED)

    @again_after_a_stall
    def test_an_e_stop_ends_a_goal_and_it_goes_on_after_a_reset_when_it_is_told_to(self) -> None:
        goal = self.straight(1.5)
        client = Client(goal)
        self.await_motion(client)
        self.robot.call("e_stop_trigger")
        state, result = client.end()
        self.assertEqual(state, ABORTED)
        self.assertIn("an emergency stop was requested", result.reason)
        refused = Client(goal)
        self.assertIn("an emergency stop was requested", refused.end()[1].reason)
        self.robot.release()
        time.sleep(1.0)
        self.assertTrue(self.robot.rests())
        goal.begin_at = result.distance
        state, result = Client(goal).end()
        self.assertEqual((state, result.reason), (SUCCEEDED, "done"), self.server.output)
        self.assertAlmostEqual(result.distance, 1.5, delta=0.01)

    def stop_and_release(self) -> None:
        self.robot.call("e_stop_trigger")
        self.robot.release()

    def assert_does_not_begin(self, client: Client) -> None:
        state, result = client.end()
        self.assertEqual(state, ABORTED, result.reason)
        self.assertIn("tart the path again", result.reason)
        moved_at = self.robot.distance
        time.sleep(1.5)
        self.assertAlmostEqual(self.robot.distance, moved_at, delta=0.01)

    def test_a_goal_that_is_planned_during_a_stop_and_its_reset_does_not_begin(self) -> None:
        for number in (20_000, 100_000):
            client = Client(self.goal([(2.0 * n / number, 0.0) for n in range(number)]))
            self.stop_and_release()
            self.assert_does_not_begin(client)

    def send_unstamped(self, name: str, length: float, *, latch: bool = False) -> Callable[[], tuple[int, str]]:
        """Sends a goal without a time, whose id is new in each attempt; returns a function that waits for its end."""
        name = f"{name} {time.monotonic_ns()}"
        ends: dict[str, tuple[int, str]] = {}
        results = rospy.Subscriber(
            "follow_path/result",
            FollowPathActionResult,
            lambda m: ends.update({m.status.goal_id.id: (m.status.status, m.result.reason)}),
        )
        goals = rospy.Publisher("follow_path/goal", FollowPathActionGoal, queue_size=1, latch=latch)
        self.addCleanup(results.unregister)
        self.addCleanup(goals.unregister)
        wait_for("the server", lambda: min(goals.get_num_connections(), results.get_num_connections()) > 0)
        message = FollowPathActionGoal(goal=self.straight(length))
        message.goal_id.id = name
        self.server.send_signal(signal.SIGSTOP)
        goals.publish(message)

        def end() -> tuple[int, str]:
            wait_for(f"the end of {name}", lambda: name in ends)
            return ends[name]

        return end

    @again_after_a_stall
    def test_a_goal_without_a_time_that_a_suspended_server_finds_after_a_stop_does_not_begin(self) -> None:
        for name in ("first", "second"):
            before = self.robot.distance
            end = self.send_unstamped(name, 2.0)
            try:
                self.stop_and_release()
                time.sleep(0.5)
            finally:
                self.server.send_signal(signal.SIGCONT)
            state, reason = end()
            self.assertEqual(state, ABORTED, reason)
            self.assertIn("Start the path again", reason)
            self.assertAlmostEqual(self.robot.distance, before, delta=0.01)
        self.assertEqual(Client(self.straight(0.3)).end()[0], SUCCEEDED, self.server.output)

    def test_a_latched_goal_does_not_begin_with_a_server_that_is_started_after_it(self) -> None:
        before = self.robot.distance
        self.send_unstamped("latched", 2.0, latch=True)
        self.server.kill()
        type(self).server = Program("follow_path.py")
        wait_for("its words", lambda: "it was requested before follow_path began" in self.server.output)
        time.sleep(1.0)
        self.assertAlmostEqual(self.robot.distance, before, delta=0.01)

    @again_after_a_stall
    def test_a_path_on_a_map_is_driven_through_tf_and_its_silence_ends_it(self) -> None:
        timer = rospy.Timer(rospy.Duration(0.05), self.place_map)
        try:  # a repetition after a stall begins without this timer
            time.sleep(0.5)
            state, result = Client(self.straight(0.5, "map")).end()
            self.assertEqual((state, result.reason), (SUCCEEDED, "done"))
            client = Client(self.straight(4.0, "map"))
            self.await_motion(client)
        finally:
            timer.shutdown()
        state, result = client.end()
        self.assertEqual((state, result.reason), (ABORTED, "tf from 'odom' to 'map' is silent for 1 s"))
        self.await_rest()

    def place_map(self, _event: object) -> None:
        """Publishes odometry's origin as that of the map."""
        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = "map", "odom"
        transform.header.stamp = rospy.Time.now()
        transform.transform.rotation.w = 1.0
        self.tf.publish(TFMessage([transform]))
