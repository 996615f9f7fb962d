"""Poses that jump while a path is driven: set_odometry, a localisation. The robot is one that does as commanded."""

import math
import random

import pytest
from robot_control.path.follower import Follower, FollowParameters, Motion, Pose, State
from robot_control.path.pieces import route, turned
from robot_control.path.shapes import SHAPES
from robot_control.path.waypoints import Waypoint

PERIOD = 0.02  # s, odometry
LONGEST = 60.0  # s, of every path here
FARTHEST = 0.3  # m beyond what the path is long
STRAIGHT = [Waypoint(0.0, 0.0), Waypoint(2.0, 0.0)]
BENT = [Waypoint(0.0, 0.0), Waypoint(0.8, 0.0), Waypoint(0.8, 0.8)]
BACK = [Waypoint(0.0, 0.0, 0.0), Waypoint(0.8, 0.0, 0.0), Waypoint(0.0, 0.0, 0.0)]
CURVE = [Waypoint(0.02 * n, 0.3 * math.sin(0.06 * n)) for n in range(100)]
PATHS = [STRAIGHT, BENT, BACK, CURVE, SHAPES["circle"](0.8), SHAPES["square"](0.6)]


class Jumping:
    """Its pose by odometry jumps; how far it has driven does not."""

    def __init__(self, waypoints):
        self.route = route(waypoints)
        self.follower = Follower(self.route, FollowParameters(speed=0.5))
        self.pose, self.motion = Pose(0.0, 0.0, waypoints[0].yaw or self.route.pieces[0].first_heading), Motion()
        self.driven = self.turned = 0.0

    def jump(self, x, y, yaw):
        self.pose = Pose(self.pose.x + x, self.pose.y + y, turned(self.pose.yaw + yaw))

    def step(self):
        self.motion = self.follower.step(self.pose, self.motion, elapsed=PERIOD)
        yaw = self.pose.yaw + self.motion.angular * PERIOD / 2
        distance, angle = self.motion.linear * PERIOD, self.motion.angular * PERIOD
        self.driven, self.turned = self.driven + abs(distance), self.turned + abs(angle)
        self.pose = Pose(
            self.pose.x + distance * math.cos(yaw), self.pose.y + distance * math.sin(yaw), turned(yaw + angle / 2)
        )

    def drive(self, seconds):
        for _ in range(round(seconds / PERIOD)):
            if self.follower.over:
                return
            self.step()


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
    robot.drive(LONGEST)
    assert robot.follower.state is State.DONE


def test_progress_that_falls_back_for_ever_ends_the_path():
    robot = Jumping(STRAIGHT)
    while not robot.follower.over and robot.driven < 10.0:
        robot.drive(0.2)
        robot.jump(-0.08, 0.0, 0.0)
    assert robot.driven < 2.0 + FARTHEST
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
    """The tangent of the first piece goes on for ever, and a robot that was carried back stood on it."""
    robot = Jumping(STRAIGHT)
    robot.drive(3.0)
    for _ in range(40):
        robot.pose = Pose(robot.pose.x - 0.02, robot.pose.y, 0.0)
        robot.follower.step(robot.pose, Motion(), elapsed=PERIOD)
    assert "off the path, more than 0.3 m" in robot.follower.reason


def test_a_path_that_begins_before_the_robot_is_driven_to():
    robot = Jumping(STRAIGHT)
    robot.pose = Pose(-0.45, 0.1, 0.0)
    robot.drive(LONGEST)
    assert robot.follower.state is State.DONE


def jumps(chance):
    """At random times: once, some, or small ones all the time."""
    size = chance.choice([0.01, 0.05, 0.1, 0.3, 1.0, 5.0])
    angle = chance.choice([0.01, 0.05, 0.2, 0.5, math.pi])
    what = chance.choice(["position", "heading", "both"])
    often = chance.choice([0.0, 0.02, 0.1, 1.0])
    direction = chance.uniform(-math.pi, math.pi)
    wander = chance.random() < 0.5
    begin = chance.uniform(0.0, 8.0)

    def jump(now, robot):
        first = begin <= now < begin + PERIOD
        if not first and (now < begin or chance.random() >= often):
            return
        way = chance.uniform(-math.pi, math.pi) if wander else direction
        length = chance.uniform(0.5, 1.0) * size if what != "heading" else 0.0
        yaw = chance.uniform(-angle, angle) if what != "position" else 0.0
        robot.jump(length * math.cos(way), length * math.sin(way), yaw)

    return jump


def excess(seed):
    """m that the robot drives beyond the path's length."""
    chance = random.Random(seed)
    robot = Jumping(chance.choice(PATHS))
    jump = jumps(chance)
    pause = chance.uniform(0.0, 6.0) if chance.random() < 0.2 else math.inf
    for number in range(round(LONGEST / PERIOD)):
        now = number * PERIOD
        jump(now, robot)
        if pause <= now < pause + PERIOD:
            robot.follower.pause()
        if pause + 1.0 <= now < pause + 1.0 + PERIOD:
            robot.follower.resume()
        robot.step()
        if robot.follower.over:
            break
    assert robot.motion == Motion() or not robot.follower.over
    return robot.driven - robot.route.length


def assert_none_drives_farther(seeds):
    worst, seed = max((excess(seed), seed) for seed in seeds)
    assert worst < FARTHEST, f"seed {seed} drives {worst:.2f} m farther"


def test_four_hundred_random_jumps_drive_none_farther():
    assert_none_drives_farther(range(400))


@pytest.mark.nightly
@pytest.mark.parametrize("first", range(0, 10_000, 1000))
def test_ten_thousand_random_jumps_drive_none_farther(first):
    assert_none_drives_farther(range(first, first + 1000))
