#!/usr/bin/python3
"""The programs that drive a robot on wheels drive the quadbot: drive_path.py, follow_path.py, send_cmd.py; why.py."""

import math
import os
import time
import unittest
from pathlib import Path

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, TwistStamped
from launch_support import Launch
from nav_msgs.msg import Odometry
from robot_control.msg import FollowPathAction, FollowPathGoal, LegState, SafetyStatus
from system_support import LIMIT, Program, init_test_node, wait_for

CROSS_TRACK = 0.1
"""m, admitted on legs"""
SIDE = 0.5
"""m, of the square"""


def beside_square(x: float, y: float) -> float:
    """m from the square that begins at 0, 0 and turns left."""
    edges = (abs(x), abs(x - SIDE), abs(y), abs(y - SIDE))
    outside = math.hypot(max(0.0, -x, x - SIDE), max(0.0, -y, y - SIDE))
    return outside or min(edges)


class LegsToolsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        init_test_node("legs_tools_test")
        cls.bus = f"legs_tools{os.getpid()}.{time.monotonic_ns()}"
        cls.launch = Launch("robot:=quadbot", "black_box:=false", f"bus:={cls.bus}")
        cls.addClassCleanup(cls.remove_what_stays)
        cls.addClassCleanup(cls.launch.end)
        cls.legs: LegState | None = None
        cls.safety: SafetyStatus | None = None
        cls.limited: TwistStamped | None = None
        cls.places: list[tuple[float, float]] = []
        for topic, kind, name in (
            ("leg_state", LegState, "legs"),
            ("safety_status", SafetyStatus, "safety"),
            ("cmd_vel_out", TwistStamped, "limited"),
        ):
            rospy.Subscriber(topic, kind, lambda message, name=name: setattr(cls, name, message))
        rospy.Subscriber("ground_truth/odom", Odometry, cls.receive_truth)
        wait_for(
            "permission", lambda: cls.safety is not None and cls.safety.permit_name == "drive" and cls.places, 2 * LIMIT
        )

    @classmethod
    def remove_what_stays(cls) -> None:
        for path in Path("/dev/shm").glob(f"robot_control.*.{cls.bus}.*"):
            path.unlink(missing_ok=True)

    @classmethod
    def receive_truth(cls, message: Odometry) -> None:
        cls.places.append((message.pose.pose.position.x, message.pose.pose.position.y))

    def test_a_square_a_goal_and_a_way_sideways_are_walked(self) -> None:
        square = Program("drive_path.py", "square", "--size", str(SIDE))
        self.assertEqual(square.wait(2 * LIMIT), 0, square.output)
        self.assertIn("done; at most", square.output)
        self.assertLess(max(beside_square(x, y) for x, y in self.places), CROSS_TRACK)

        server = Program("follow_path.py")
        self.addCleanup(server.end)
        client = actionlib.SimpleActionClient("follow_path", FollowPathAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30.0)))
        goal = FollowPathGoal(speed=0.4)
        goal.path.header.frame_id = "base_link"
        goal.path.poses = [PoseStamped(), PoseStamped()]
        goal.path.poses[1].pose.position.x = SIDE
        self.assertEqual(client.send_goal_and_wait(goal, rospy.Duration(60.0)), GoalStatus.SUCCEEDED, server.output)
        self.assertLess(client.get_result().worst_cross_track_error, CROSS_TRACK)

        begin = self.places[-1]
        sender = Program("send_cmd.py", "--linear", "0", "--angular", "0", "--lateral", "0.3")
        self.addCleanup(sender.end)
        wait_for("a way sideways", lambda: math.dist(begin, self.places[-1]) > 0.3)
        self.assertEqual(self.legs.posture, "walking")
        self.assertAlmostEqual(self.limited.twist.linear.y, 0.3, delta=0.01)
        why = Program("why.py", "--once")
        self.assertEqual(why.wait(), 0, why.output)
        self.assertIn("It walks: ", why.output)
        self.assertIn("m/s to the left", why.output)
        sender.end()
        wait_for("standing", lambda: self.legs.posture == "standing")


if __name__ == "__main__":
    rostest.rosrun("robot_control", "legs_tools_test", LegsToolsTest)
