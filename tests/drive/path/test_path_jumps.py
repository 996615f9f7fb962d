"""The pose jumps while a path is driven, by set_odometry or a localisation. The robot follows its commands exactly."""

import math

import pytest
from robot_control.drive.path.follower import Motion, State
from robot_control.drive.path.shapes import SHAPES
from robot_control.drive.path.waypoints import Waypoint
from robot_control.robot.pose import Pose

from bench.release.path_jumps import MAX_EXCESS, MAX_TIME, PERIOD, STRAIGHT, Jumping, excess


@pytest.mark.parametrize("jump", [(-5.0, 0.0, 0.0), (0.0, 0.0, math.pi), (1.0, 0.0, 0.0), (0.0, 0.2, 0.0)])
def test_a_jump_beyond_what_speed_and_time_allow_ends_the_path_at_once_with_its_reason(jump):
    robot = Jumping([Waypoint(0.0, 0.0), Waypoint(4.0, 0.0)])
    robot.drive(2.0)
    robot.jump(*jump)
    before = robot.driven
    robot.drive(30.0)
    assert robot.driven == before
    assert robot.follower.state is State.FAILED
    assert "the pose jumped by " in robot.follower.reason


def test_a_jump_while_it_is_paused_or_turns_ends_the_path_too():
    paused = Jumping(STRAIGHT)
    paused.drive(1.0)
    paused.follower.pause()
    paused.step()
    paused.jump(0.5, 0.0, 0.0)
    paused.step()
    assert "jumped by 0.50 m" in paused.follower.reason
    turning = Jumping([Waypoint(0.0, 0.0), Waypoint(0.0, 1.0)])
    turning.pose = Pose(0.0, 0.0, 0.0)
    turning.drive(0.4)
    assert turning.follower.state is State.TURNING
    turning.jump(0.0, 0.0, -1.0)
    turning.step()
    assert "jumped by 56 deg" in turning.follower.reason


def test_odometry_that_was_late_is_no_jump():
    robot = Jumping(STRAIGHT)
    robot.drive(1.0)
    for _ in range(20):
        robot.pose = Pose(robot.pose.x + 0.5 * PERIOD, robot.pose.y, robot.pose.yaw)
    robot.follower.step(robot.pose, robot.motion, elapsed=20 * PERIOD)
    assert not robot.follower.over


def test_a_correction_of_a_localisation_is_driven_out():
    robot = Jumping(STRAIGHT)
    robot.drive(1.0)
    robot.jump(-0.03, 0.05, 0.05)
    robot.drive(MAX_TIME)
    assert robot.follower.state is State.DONE


def test_progress_that_falls_back_for_ever_ends_the_path():
    robot = Jumping(STRAIGHT)
    while not robot.follower.over and robot.driven < 10.0:
        robot.drive(0.2)
        robot.jump(-0.08, 0.0, 0.0)
    assert robot.driven < 2.0 + MAX_EXCESS
    assert "without coming nearer to its end" in robot.follower.reason


def test_what_is_lost_in_the_turns_of_a_path_counts():
    """At each corner the pose falls back along the next piece, which must not begin its count there."""
    robot = Jumping(SHAPES["square"](0.6))
    while not robot.follower.over:
        drives = robot.follower.state is State.DRIVING
        robot.step()
        if drives and robot.follower.state is State.TURNING:
            back = 0.09 * math.sin(robot.pose.yaw), -0.09 * math.cos(robot.pose.yaw), 0.0
            robot.jump(*back)
            robot.step()
            robot.jump(*back)
    assert robot.driven < robot.route.length + MAX_EXCESS
    assert "without coming nearer to its end" in robot.follower.reason


def test_a_turn_that_falls_back_for_ever_ends_the_path():
    robot = Jumping([Waypoint(0.0, 0.0), Waypoint(0.0, 1.0)])
    robot.pose = Pose(0.0, 0.0, 0.0)
    while not robot.follower.over and robot.turned < 20.0:
        robot.step()
        robot.jump(0.0, 0.0, -0.019)
    assert robot.turned < math.pi / 2 + 1.0
    assert "without coming nearer to its heading" in robot.follower.reason


def test_what_lies_behind_the_farthest_point_reached_is_off_the_path():
    """The tangent of the first piece is infinite, and a robot that was carried back stood on it."""
    robot = Jumping(STRAIGHT)
    robot.drive(3.0)
    for _ in range(40):
        robot.pose = Pose(robot.pose.x - 0.02, robot.pose.y, 0.0)
        robot.follower.step(robot.pose, Motion(), elapsed=PERIOD)
    assert "off the path, more than 0.3 m" in robot.follower.reason


def test_a_path_that_begins_before_the_robot_is_driven_to():
    robot = Jumping(STRAIGHT)
    robot.pose = Pose(-0.45, 0.1, 0.0)
    robot.drive(MAX_TIME)
    assert robot.follower.state is State.DONE


def assert_none_drives_farther(seeds):
    worst, seed = max((excess(seed), seed) for seed in seeds)
    assert worst < MAX_EXCESS, f"seed {seed} drives {worst:.2f} m farther"


def test_four_hundred_random_jumps_drive_none_farther():
    assert_none_drives_farther(range(400))


@pytest.mark.nightly
@pytest.mark.parametrize("first", range(0, 10_000, 1000))
def test_ten_thousand_random_jumps_drive_none_farther(first):
    assert_none_drives_farther(range(first, first + 1000))
