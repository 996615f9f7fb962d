"""A robot that follows its commands exactly along a path while its pose jumps: set_odometry, a localisation."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence

from robot_control.drive.path.follower import Follower, FollowParameters, Motion
from robot_control.drive.path.pieces import route
from robot_control.drive.path.shapes import SHAPES
from robot_control.drive.path.waypoints import Waypoint
from robot_control.robot.pose import Pose, turned

PERIOD = 0.02  # s, odometry
MAX_TIME = 60.0  # s, of every path here
MAX_EXCESS = 0.3  # m beyond the length of the path
STRAIGHT = [Waypoint(0.0, 0.0), Waypoint(2.0, 0.0)]
BENT = [Waypoint(0.0, 0.0), Waypoint(0.8, 0.0), Waypoint(0.8, 0.8)]
BACK = [Waypoint(0.0, 0.0, 0.0), Waypoint(0.8, 0.0, 0.0), Waypoint(0.0, 0.0, 0.0)]
CURVE = [Waypoint(0.02 * n, 0.3 * math.sin(0.06 * n)) for n in range(100)]
PATHS = [STRAIGHT, BENT, BACK, CURVE, SHAPES["circle"](0.8), SHAPES["square"](0.6)]


class Jumping:
    """A robot whose pose by odometry jumps; its driven distance does not."""

    def __init__(self, waypoints: Sequence[Waypoint]) -> None:
        self.route = route(waypoints)
        self.follower = Follower(self.route, FollowParameters(speed=0.5))
        self.pose, self.motion = Pose(0.0, 0.0, waypoints[0].yaw or self.route.pieces[0].first_heading), Motion()
        self.driven = self.turned = 0.0

    def jump(self, x: float, y: float, yaw: float) -> None:
        """Adds this to the pose."""
        self.pose = Pose(self.pose.x + x, self.pose.y + y, turned(self.pose.yaw + yaw))

    def step(self) -> None:
        """One message of odometry."""
        self.motion = self.follower.step(self.pose, self.motion, elapsed=PERIOD)
        yaw = self.pose.yaw + self.motion.angular * PERIOD / 2
        distance, angle = self.motion.linear * PERIOD, self.motion.angular * PERIOD
        self.driven, self.turned = self.driven + abs(distance), self.turned + abs(angle)
        self.pose = Pose(
            self.pose.x + distance * math.cos(yaw), self.pose.y + distance * math.sin(yaw), turned(yaw + angle / 2)
        )

    def drive(self, seconds: float) -> None:
        """Drives for `seconds`, or until the path has ended."""
        for _ in range(round(seconds / PERIOD)):
            if self.follower.over:
                return
            self.step()


def jumps(chance: random.Random) -> Callable[[float, Jumping], None]:
    """Jumps at random times: one, some, or small ones all the time."""
    size = chance.choice([0.01, 0.05, 0.1, 0.3, 1.0, 5.0])
    angle = chance.choice([0.01, 0.05, 0.2, 0.5, math.pi])
    what = chance.choice(["position", "heading", "both"])
    often = chance.choice([0.0, 0.02, 0.1, 1.0])
    direction = chance.uniform(-math.pi, math.pi)
    wander = chance.random() < 0.5
    begin = chance.uniform(0.0, 8.0)

    def jump(now: float, robot: Jumping) -> None:
        first = begin <= now < begin + PERIOD
        if not first and (now < begin or chance.random() >= often):
            return
        course = chance.uniform(-math.pi, math.pi) if wander else direction
        length = chance.uniform(0.5, 1.0) * size if what != "heading" else 0.0
        yaw = chance.uniform(-angle, angle) if what != "position" else 0.0
        robot.jump(length * math.cos(course), length * math.sin(course), yaw)

    return jump


def excess(seed: int) -> float:
    """m that the robot drives beyond the path's length; infinity if it still moves after the path has ended."""
    chance = random.Random(seed)  # noqa: S311 (a seeded sequence)
    robot = Jumping(chance.choice(PATHS))
    jump = jumps(chance)
    pause = chance.uniform(0.0, 6.0) if chance.random() < 0.2 else math.inf
    for number in range(round(MAX_TIME / PERIOD)):
        now = number * PERIOD
        jump(now, robot)
        if pause <= now < pause + PERIOD:
            robot.follower.pause()
        if pause + 1.0 <= now < pause + 1.0 + PERIOD:
            robot.follower.resume()
        robot.step()
        if robot.follower.over:
            break
    return math.inf if robot.follower.over and robot.motion != Motion() else robot.driven - robot.route.length
