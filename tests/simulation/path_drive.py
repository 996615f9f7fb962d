"""Drives a path with the closed loop, in virtual time."""

import math

from robot_control import ClosedLoop
from robot_control.drive.path.follower import Follower, Motion, State
from robot_control.drive.path.pieces import route, turned
from robot_control.robot.pose import Pose

ODOM = 20
"""cycles between two odometry messages; a command acts before the next message"""
MAX_TIME = 120.0
"""s"""


def driven(waypoints, **loop):
    """Follows the path by odometry; returns the follower, the last pose by odometry and by truth, and the errors on the
    way.
    """
    robot = ClosedLoop(**loop)
    follower = Follower(route(waypoints))
    log = robot.step(1000)
    true_route = route(waypoints)  # this route has its own feet
    true_errors = []
    while not follower.over and robot.time < MAX_TIME:
        pose = Pose(*(log[f"estimate_{axis}"][-1] for axis in ("x", "y", "yaw")))
        command = follower.step(pose, Motion(log["estimate_linear"][-1], log["estimate_angular"][-1]))
        robot.command(command.linear, command.angular)
        log = robot.step(ODOM)
        number = min(follower._number, len(true_route.pieces) - 1)
        foot = true_route.pieces[number].foot(log["truth_x"][-1], log["truth_y"][-1], 1.0)
        true_errors.append(abs(foot.aside))
    log = robot.run(1.0, lambda time: (0.0, 0.0))
    assert follower.state is State.DONE, follower.reason
    return (
        follower,
        {who: Pose(*(log[f"{who}_{axis}"][-1] for axis in ("x", "y", "yaw"))) for who in ("estimate", "truth")},
        max(true_errors),
    )


def assert_ends_at(pose, x, y, yaw):
    assert math.hypot(pose.x - x, pose.y - y) <= 0.02
    assert abs(turned(pose.yaw - yaw)) <= math.radians(2.0)
