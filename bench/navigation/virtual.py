"""Navigation in virtual time: the classes of the node navigate, the law of follow_path, and ClosedLoop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from robot_control import ClosedLoop
from robot_control._navigation import Navigation
from robot_control.drive.path.follower import Follower, FollowParameters, Motion, State
from robot_control.drive.path.pieces import route
from robot_control.drive.path.waypoints import PathError, Waypoint, checked
from robot_control.installed_files import share_file
from robot_control.robot.pose import Pose

from bench.navigation.scene_map import Map, Obstacle
from bench.navigation.tour import LASER, new_loop

SPEED = 0.5  # m/s
STEP, SCAN = 0.02, 5  # s between two steps of the law; such steps between two scans
LONGEST = 240.0  # s for one goal
STANDING = 10  # scans before and after it
MOVING = 0.02  # m/s, rad/s
NEARER = 0.001  # m in one step: 0.05 m/s
REACH = 0.6  # m: farther points are not looked at

Place = tuple[float, float, float]


@dataclass
class Lies:
    """The errors that are made on purpose, from `since` s on; the defaults are true."""

    since: float = math.inf
    frozen: bool = False
    sensor: Place = LASER  # where the laser is taken to be on the robot
    place: Callable[[Place], Place] = lambda place: place


@dataclass
class Trip:
    """One goal and its end."""

    state: str = ""
    reason: str = ""
    way: float = 0.0  # m
    planned: float = 0.0  # m
    error: float = math.inf  # m from the goal, at the end
    turn_error: float = math.inf  # rad
    air: float = math.inf  # m between outline and what stands, the least
    hit: bool = False  # an obstacle that moves on, whatever it meets, touched the outline
    drove_into: bool = False  # in a touch of such an obstacle, the robot's own motion brought them nearer
    doubts: set[str] = field(default_factory=set)


class Robot:
    """One robot in a scene."""

    def __init__(self, scene: str, obstacles: list[Obstacle], known: Map, seed: int) -> None:
        self.loop: ClosedLoop = new_loop(scene, seed)
        self._obstacles = obstacles
        self._standing = np.concatenate([item.outline(0.0) for item in obstacles if not item.path])
        self.navigation = Navigation(known, Path(share_file("urdf/diffbot.urdf")).read_text())
        self.lies = Lies()
        self._scan: dict[str, Any] = {}
        self._moved = 0.0
        self._follower: Follower | None = None
        self._command = (0.0, 0.0)
        self._state = self._advance(self._command)
        self._problem = ""
        self._before = self.place

    @property
    def place(self) -> Place:
        """The true pose: x [m], y [m], yaw [rad]."""
        return (self._state["truth_x"], self._state["truth_y"], self._state["truth_yaw"])

    def _advance(self, command: tuple[float, float]) -> dict[str, float]:
        log = self.loop.run(STEP, command)
        state = {name: float(log[name][-1]) for name in log if name.startswith(("truth_", "estimate_"))}
        self._moved += (abs(state["estimate_linear"]) + abs(state["estimate_angular"])) * STEP
        return state

    def _assumed(self) -> Place:
        return self.lies.place(self.place) if self.loop.time >= self.lies.since else self.place

    def _see(self) -> str:
        lying = self.loop.time >= self.lies.since
        if not (lying and self.lies.frozen):
            self._scan = self.loop.scan()
        sensor = self.lies.sensor if lying else LASER
        odometry = (self._state["estimate_x"], self._state["estimate_y"], self._state["estimate_yaw"])
        problem: str = self.navigation.update(
            self._scan, sensor, self._assumed(), odometry, self.loop.time, self._moved
        )
        free = 0.0
        if not self.navigation.silent(self.loop.time):
            free = self.navigation.clearance_along(self._scan, sensor, *self._motion())
        self.loop.clearance(free)
        return problem

    def _motion(self) -> tuple[float, float]:
        """The motion that is measured, else intended."""
        linear, angular = self._state["estimate_linear"], self._state["estimate_angular"]
        if abs(linear) > MOVING or abs(angular) > 2 * MOVING:
            return linear, angular
        follower = self._follower
        if follower is None or follower.over:
            return 0.0, 0.0
        if follower.state is State.TURNING:
            return 0.0, -math.copysign(1.0, follower.heading_error)
        return self._command[0], 0.0

    def drive(self, goal: Place) -> Trip:
        """Begins the goal and returns at its end. A stop of before, by an obstacle that hit the robot, is reset."""
        trip = Trip()
        self.loop.e_stop_reset()
        self._stand(trip)
        begin, self._follower, self._command = self.loop.time, None, (0.0, 0.0)
        _, trip.planned, _ = self.navigation.plan(self.place, goal, self.loop.time)
        self.navigation.begin(goal, self.loop.time)
        path = "none"
        while self.loop.time - begin < LONGEST:
            path = self._report(path)
            state, reason, way, cancel = self.navigation.step(self.loop.time, self._problem, self._assumed(), path)
            if cancel:
                self._follower, path = None, "none"
            if way is not None:
                self._follower, path = self._new_follower(way), "active"
            if state in {"reached", "failed"}:
                trip.state, trip.reason = state, reason
                break
            self._until_next_scan(trip)
        self._stand(trip)
        x, y, yaw = self.place
        trip.error, trip.turn_error = (
            math.hypot(goal[0] - x, goal[1] - y),
            abs(math.remainder(goal[2] - yaw, 2 * math.pi)),
        )
        return trip

    def _stand(self, trip: Trip) -> None:
        self._follower = None
        for _ in range(STANDING):
            self._until_next_scan(trip)

    def _until_next_scan(self, trip: Trip) -> None:
        for _ in range(SCAN):
            self._follow()
            self._note(trip)
        self._problem = self._see()
        trip.doubts |= {self._problem.split(":")[0]} - {""}

    def _new_follower(self, way: list[Place]) -> Follower | None:
        try:
            points = checked([Waypoint(x, y, yaw) for x, y, yaw in way])
        except PathError:
            return None
        return Follower(route(points), FollowParameters(speed=SPEED, scale_error=0.05))

    def _report(self, path: str) -> str:
        follower = self._follower
        if path != "active" or follower is None or not follower.over:
            return path
        return "done" if follower.state is State.DONE else follower.reason

    def _follow(self) -> None:
        self._command = (0.0, 0.0)
        if self._follower is not None and not self._follower.over:
            measured = Motion(self._state["estimate_linear"], self._state["estimate_angular"])
            motion = self._follower.step(Pose(*self._assumed()), measured, elapsed=STEP)
            self._command = (motion.linear, motion.angular)
        self._before = self.place
        self._state = self._advance(self._command)

    def _note(self, trip: Trip) -> None:
        trip.way += abs(self._state["truth_linear"]) * STEP
        trip.air = min(trip.air, self.air_at(self.place, moving=False))
        air = self.air_at(self.place, moving=True)
        if air <= 0 and not trip.hit:
            trip.hit, trip.drove_into = True, self.air_at(self._before, moving=True) > air + NEARER

    def air_at(self, place: Place, *, moving: bool) -> float:
        """m between the outline at this place and the nearest obstacle of those that move, or of those that stand."""
        x, y, yaw = place
        points = self._standing
        if moving:
            carts = [item.outline(self.loop.time) for item in self._obstacles if item.path]
            points = np.concatenate([np.empty((0, 2)), *carts])
        near = points[np.hypot(points[:, 0] - x, points[:, 1] - y) < REACH] - (x, y)
        cosine, sine = math.cos(yaw), math.sin(yaw)
        return min(
            (self.navigation.distance(cosine * dx + sine * dy, cosine * dy - sine * dx) for dx, dy in near),
            default=math.inf,
        )
