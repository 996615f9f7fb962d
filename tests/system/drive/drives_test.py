"""The loop drives, stops without commands, with too many or with invalid ones, and reports why."""

import itertools
import os
import subprocess
from pathlib import Path

import rospy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from robot_control.msg import SafetyStatus
from sensor_msgs.msg import Imu, JointState
from system.system_support import CONTROLLER, LOOP, MONITOR, RobotTestCase, schedule_of, wait_for
from tf2_msgs.msg import TFMessage


def publish(value: str) -> None:
    """Publishes on e_stop from a node of its own, which has left on return."""
    subprocess.run(["rostopic", "pub", "-1", "e_stop", "std_msgs/Bool", value], check=True, capture_output=True)


class DrivesTest(RobotTestCase):
    def setUp(self) -> None:
        self.robot.send_e_stop(False)
        self.robot.await_ready()
        self.robot.await_rest()

    def test_moves_the_robot_as_commanded(self) -> None:
        start = self.robot.distance
        self.robot.drive_until("0.5 m/s", self.robot.driving)
        self.robot.drive_until("half a metre", lambda: self.robot.distance - start > 0.5)
        line = "left 0.45 m/s, right 0.55 m/s"
        wait_for(line, lambda: line in self.robot.nodes[CONTROLLER].output)

    def test_publishes_joint_states_at_100_hz_and_odom_at_50(self) -> None:
        # The stamps are judged, since they do not stall with the machine: one sample every 10 ms, one odometry every
        # 20.
        robot = self.robot
        stamps: dict[str, list[float]] = {"joints": [], "odom": []}
        subscribers = [
            rospy.Subscriber("joint_states", JointState, lambda m: stamps["joints"].append(m.header.stamp.to_sec())),
            rospy.Subscriber("odom", Odometry, lambda m: stamps["odom"].append(m.header.stamp.to_sec())),
        ]
        wait_for("100 samples", lambda: len(stamps["joints"]) > 100 and len(stamps["odom"]) > 50)
        for subscriber in subscribers:
            subscriber.unregister()
        for name, period in (("joints", 0.010), ("odom", 0.020)):
            intervals = sorted(b - a for a, b in itertools.pairwise(stamps[name]))
            self.assertAlmostEqual(intervals[len(intervals) // 2], period, delta=0.1 * period, msg=name)
            self.assertGreater(intervals[0], 0, "stamps grow")
        self.assertEqual(robot.joints.name, ["left_wheel_joint", "right_wheel_joint"])

    def test_publishes_every_other_topic_of_the_interface(self) -> None:
        imu = rospy.wait_for_message("imu/data_raw", Imu, 30)
        self.assertEqual(imu.orientation_covariance[0], -1)  # REP 145: not measured
        self.assertAlmostEqual(imu.linear_acceleration.z, 9.81, delta=0.5)
        truth = rospy.wait_for_message("ground_truth/odom", Odometry, 30)
        self.assertEqual((truth.header.frame_id, truth.child_frame_id), ("odom", "base_link"))
        transform = rospy.wait_for_message("/tf", TFMessage, 30).transforms[0]
        self.assertEqual((transform.header.frame_id, transform.child_frame_id), ("odom", "base_link"))
        targets = rospy.wait_for_message("joint_targets", JointState, 30)
        self.assertEqual(targets.name, ["left_wheel_joint", "right_wheel_joint"])
        limited = rospy.wait_for_message("cmd_vel_out", TwistStamped, 30)
        self.assertEqual(limited.header.frame_id, "base_link")
        self.assertGreater(self.robot.odom.pose.covariance[0], 0)
        self.assertIn("<robot", rospy.get_param("robot_description"))

    def test_ramps_down_when_cmd_vel_falls_silent(self) -> None:
        self.robot.drive_until("0.5 m/s", self.robot.driving)
        wait_for("standstill without any message", lambda: abs(self.robot.speed) < 0.01)
        wait_for("the warning", lambda: "no cmd_vel for 1.25 s" in self.robot.nodes[CONTROLLER].output)
        self.robot.drive_until("0.5 m/s again, with no reset", self.robot.driving)

    def test_latches_e_stop_until_a_reset_that_says_why_not(self) -> None:
        robot = self.robot
        robot.drive_until("0.5 m/s", robot.driving)
        said = {name: len(robot.nodes[name].output) for name in (MONITOR, CONTROLLER)}
        robot.send_e_stop(True)
        wait_for("STOPPED", lambda: robot.state == SafetyStatus.STOPPED and "e_stop_topic" in robot.causes)
        wait_for("standstill", lambda: abs(robot.speed) < 0.01, every=lambda: robot.send(0.5, 0.2))
        refused = robot.call("e_stop_reset")
        self.assertFalse(refused.success)
        self.assertIn("e_stop", refused.message, "the topic still says true")

        robot.send_e_stop(False)
        wait_for("the release of the topic", lambda: not robot.status.active, every=lambda: robot.send(0.5, 0.2))
        self.assertEqual(robot.state, SafetyStatus.STOPPED, "false alone does not reset")
        robot.send(0.5, 0.2)
        self.assertIn("STOPPED: e_stop_topic: ", robot.nodes[MONITOR].output[said[MONITOR] :])
        wait_for(
            "what is done with the command",
            lambda: f"motion of {rospy.get_name()} is refused" in robot.nodes[CONTROLLER].output[said[CONTROLLER] :],
            every=lambda: robot.send(0.5, 0.2),
        )
        self.assertNotIn("left 0.45 m/s", robot.nodes[CONTROLLER].output[said[CONTROLLER] :])
        refused = robot.call("e_stop_reset")
        self.assertFalse(refused.success)
        self.assertIn(rospy.get_name(), refused.message, "the answer names who still sends")

        robot.release()
        wait_for("a line about it", lambda: "released: " in robot.nodes[MONITOR].output[said[MONITOR] :])
        robot.drive_until("0.5 m/s again", robot.driving)

    def test_the_level_of_a_publisher_that_has_left_ends_at_a_reset_after_the_false_of_another_one(self) -> None:
        publish("true")
        wait_for("the stop", lambda: "e_stop_topic" in self.robot.causes)
        self.robot.send_e_stop(False)  # a publisher that sent before
        refused = self.robot.call("e_stop_reset")
        self.assertIn("true on e_stop: /rostopic_", refused.message)
        self.assertIn("rostopic pub -1 e_stop std_msgs/Bool false", refused.message)
        publish("false")
        self.assertIn("e_stop_topic", self.robot.causes, "false alone does not reset")
        self.robot.release()

    def test_keeps_real_time_to_one_thread_per_node(self) -> None:
        # Real-time attributes are inherited by threads made later; ROS has a dozen of them.
        cores = os.sched_getaffinity(0)
        for name in LOOP:
            tasks = [schedule_of(task) for task in Path(f"/proc/{self.robot.nodes[name].pid}/task").iterdir()]
            fifo = [affinity for policy, affinity, _ in tasks if policy == os.SCHED_FIFO]
            others = [policy for policy, _, _ in tasks if policy not in (os.SCHED_FIFO, os.SCHED_OTHER)]
            granted = "SCHED_FIFO" not in self.robot.nodes[name].output  # the refusal names it
            self.assertEqual(len(fifo), 1 if granted else 0, f"{name}: {tasks}")
            self.assertEqual(others, [], f"{name}: {tasks}")
            if len(cores) > 1 and 0 in cores:
                pinned = [affinity for _, affinity, _ in tasks if affinity == {0}]
                self.assertEqual(len(pinned), 1, f"{name}: {tasks}")
                self.assertTrue(all(affinity == {0} for affinity in fifo), f"{name}: {tasks}")
