"""A robot in virtual time that drives its legs by the law of follow_path, and a master beside it."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

from robot_control.drive.path.follower import Follower, FollowParameters, Motion, State
from robot_control.drive.path.pieces import route
from robot_control.drive.path.waypoints import Waypoint, limited, shortened
from robot_control.fleet.client import DONE, DRIVING, ENDED, Client, Progress
from robot_control.fleet.settings import Settings
from robot_control.fleet.v2.capability import EDGE, INSTANT, NODE, STANDARD, ActionKind
from robot_control.fleet.v2.leg import PathPoint
from robot_control.fleet.v2.order import Action
from robot_control.fleet.v2.state import Facts, Machine
from robot_control.fleet.v2.vehicle import FINISHED, Vehicle
from robot_control.robot.pose import Pose

PERIOD = 0.02
"""s of one pass"""
FEEDBACK = 10
"""passes between two reports of the distance"""
ACCELERATION = 0.5
"""m/s²; with it the robot reaches what follow_path commands"""
KINDS = {**STANDARD, "horn": ActionKind((INSTANT, NODE, EDGE))}
MACHINE = Machine(length=0.6, width=0.5, height=0.3, actions=KINDS)


class VirtualRobot:
    """Follows its commands with a bounded acceleration."""

    def __init__(self, x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> None:
        self.pose, self.motion = Pose(x, y, yaw), Motion()
        self.progress = Progress()
        self.given = Facts(map_id="hall")
        self.follower: Follower | None = None
        self.points: list[PathPoint] = []
        self.goals = 0
        self.begun: list[Action] = []
        self.ended: list[tuple[str, str, str]] = []
        self._begin_at, self._passes, self._stopping = 0.0, 0, False

    def facts(self) -> Facts:
        x, y, theta = self.pose.x, self.pose.y, self.pose.yaw
        return replace(self.given, x=x, y=y, theta=theta, linear=self.motion.linear, angular=self.motion.angular)

    def drive(self, points: list[PathPoint], begin_at: float) -> None:
        self.points, self._begin_at, self._stopping = points, begin_at, False
        self.goals += 1
        poses = [Waypoint(point.x, point.y, point.yaw) for point in points]
        way = limited(poses, [point.speed for point in points], [point.turn_speed for point in points])
        self.follower = Follower(route(shortened(way, begin_at)), FollowParameters())
        self.progress = Progress(DRIVING, begin_at)

    def stop(self) -> None:
        self._stopping = True

    def set_position(self, x: float, y: float, theta: float, map_id: str) -> str:
        self.pose, self.given = Pose(x, y, theta), replace(self.given, map_id=map_id)
        return ""

    def begin(self, action: Action) -> None:
        if action.kind == "stopPause":
            self.given = replace(self.given, held_by="")
            self.ended.append((action.id, FINISHED, ""))
        else:
            self.begun.append(action)

    def end(self, action_id: str) -> bool:
        del action_id
        return True

    def results(self) -> list[tuple[str, str, str]]:
        ended, self.ended = self.ended, []
        return ended

    def step(self) -> None:
        """One pass of the law and of the wheels."""
        follower, wanted = self.follower, Motion()
        self._passes += 1
        if follower is not None and not self.given.may_drive:
            follower.fail("the safety monitor stopped the robot")
        if follower is not None:
            wanted = Motion() if self._stopping else follower.step(self.pose, self.motion)
            wanted = Motion() if self.given.blocked_by else wanted  # the controller limits it
            distance = self._begin_at + follower.distance
            if self._stopping or follower.over:
                reason = "" if self._stopping else follower.reason
                self.progress = Progress(DONE if follower.state is State.DONE else ENDED, distance, reason)
                self.follower = None
            elif self._passes % FEEDBACK == 0:
                self.progress = Progress(DRIVING, distance)
        change = ACCELERATION * PERIOD
        linear = self.motion.linear + min(change, max(-change, wanted.linear - self.motion.linear))
        self.motion = Motion(linear, wanted.angular)
        yaw = self.pose.yaw + wanted.angular * PERIOD / 2
        x, y = self.pose.x + linear * math.cos(yaw) * PERIOD, self.pose.y + linear * math.sin(yaw) * PERIOD
        self.pose = Pose(x, y, self.pose.yaw + wanted.angular * PERIOD)


class Run:
    """A client with such a robot; the messages that it sent."""

    def __init__(self, robot: VirtualRobot | None = None, **settings: Any) -> None:
        self.robot = robot or VirtualRobot()
        self.now = 0.0
        self.settings = Settings(visualization_rate=0.0, **settings)
        self.client = Client(self.robot, self.settings, MACHINE, Vehicle())
        self.states: list[dict[str, Any]] = []
        self.sent: list[tuple[str, dict[str, Any]]] = []
        self.speeds: list[float] = []
        self.step(0.1)

    @property
    def state(self) -> dict[str, Any]:
        """The last one."""
        return self.states[-1]

    def send(self, message: dict[str, Any], *, retained: bool = False) -> dict[str, Any]:
        """The state after the message."""
        topic = "order" if "nodes" in message else "instantActions"
        self.client.receive(topic, json.dumps(message).encode(), self.now, retained=retained)
        self.step(PERIOD)
        return self.state

    def step(self, seconds: float) -> None:
        for _ in range(round(seconds / PERIOD)):
            sent = self.client.step(self.now)
            self.sent += sent
            self.states += [message for topic, message in sent if topic == "state"]
            self.robot.step()
            self.speeds.append(self.robot.motion.linear)
            self.now += PERIOD

    def restart(self) -> None:
        """The program ends and begins again, with what its file holds."""
        vehicle = Vehicle()
        vehicle.load(json.loads(json.dumps(self.client.vehicle.dump())))
        self.robot.stop()
        self.client = Client(self.robot, self.settings, MACHINE, vehicle)

    def until_over(self, limit: float = 120.0) -> None:
        """Until the order is completed; raises AssertionError."""
        end = self.now + limit
        while self.client.vehicle.executing:
            assert self.now < end, f"not completed: {self.state}"
            self.step(PERIOD)
        self.step(PERIOD)


def ordered(message: dict[str, Any], seconds: float = 0.0) -> Run:
    """A run that has this order since so many seconds."""
    run = Run()
    run.send(message)
    run.step(seconds)
    return run
