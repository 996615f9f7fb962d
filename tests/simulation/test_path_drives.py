"""Paths driven by the closed loop, in virtual time: the distances from the path and from its end."""

import math

import pytest
from robot_control import ClosedLoop
from robot_control.common.pose import Pose
from robot_control.installed_files import share_file
from robot_control.path.follower import Follower, Motion, State
from robot_control.path.pieces import route, turned
from robot_control.path.shapes import SHAPES
from robot_control.path.waypoints import Waypoint

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


@pytest.mark.parametrize(("shape", "size"), [("square", 4.0), ("circle", 3.0), ("eight", 5.0)])
def test_a_shape_at_half_a_metre_per_second(shape, size):
    follower, ends, true_error = driven(SHAPES[shape](size))
    end = ends["estimate"]
    true_end = ends["truth"]
    print(
        f"{shape} {size:g} m: cross-track {1000 * follower.worst_cross_track_error:.1f} mm "
        f"(true {1000 * true_error:.1f}), end {1000 * math.hypot(end.x, end.y):.1f} mm, "
        f"{math.degrees(end.yaw):.2f} deg; true end {1000 * math.hypot(true_end.x, true_end.y):.1f} mm, "
        f"{math.degrees(true_end.yaw):.2f} deg"
    )
    assert follower.worst_cross_track_error <= 0.03
    assert_ends_at(end, 0.0, 0.0, 0.0)


def test_backwards_where_the_poses_point_against_the_path():
    points = [Waypoint(0.0, 0.0, 0.0), Waypoint(1.0, 0.0, 0.0), Waypoint(0.0, 0.0, 0.0)]
    follower, ends, _ = driven(points)
    assert follower.worst_cross_track_error <= 0.03
    assert_ends_at(ends["estimate"], 0.0, 0.0, 0.0)


def test_a_path_of_ten_thousand_points():
    points = [Waypoint(4.0 * n / 10_000, 0.3 * math.sin(2 * math.pi * n / 10_000)) for n in range(10_001)]
    follower, ends, _ = driven(points)
    assert follower.worst_cross_track_error <= 0.03
    end = ends["estimate"]
    assert math.hypot(end.x - 4.0, end.y) <= 0.02


@pytest.mark.nightly
@pytest.mark.parametrize(
    "world",
    [
        {"scene": share_file("urdf/scenes/slope_5deg.xml")},
        {"scene": share_file("urdf/scenes/low_friction_patch.xml")},
        {"params": {"mujoco_plant": {"payload": 6.0, "payload_x": 0.1}}},
    ],
    ids=["slope", "low_friction_patch", "payload"],
)
def test_a_square_elsewhere(world):
    follower, ends, true_error = driven(SHAPES["square"](2.0), **world)
    end = ends["estimate"]
    print(
        f"{world}: cross-track {1000 * follower.worst_cross_track_error:.1f} mm "
        f"(true {1000 * true_error:.1f}), end {1000 * math.hypot(end.x, end.y):.1f} mm, "
        f"true {1000 * math.hypot(ends['truth'].x, ends['truth'].y):.1f} mm"
    )
    assert follower.worst_cross_track_error <= 0.1
