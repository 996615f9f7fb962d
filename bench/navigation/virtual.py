"""Navigation in virtual time: the classes of the node navigate, the law of follow_path, and ClosedLoop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from robot_control import ClosedLoop
from robot_control._navigation import Guard, Navigation
from robot_control.drive.path.follower import Follower, FollowParameters, Motion, State
from robot_control.drive.path.pieces import route
from robot_control.drive.path.waypoints import PathError, Waypoint, checked
from robot_control.robot.pose import Pose

from bench.navigation.scene_map import Map, Obstacle
from bench.navigation.tour import DIFFBOT, LASER, Machine, Place, Scan, new_loop

SPEED = 0.5  # m/s
STEP, SCAN = 0.02, 5  # s between two steps of the law; such steps between two scans
LONGEST = 240.0  # s for one goal
STANDING = 10  # scans before and after it
HELD = 1.0  # s without a free way after which its obstacle is marked in the costmap: kReplanPeriod
NEARER = 0.001  # m in one step: 0.05 m/s
REACH = 0.8  # m: farther points are not looked at
RISE = 4.0  # s
Command = tuple[float, float, float]
"""linear, lateral [m/s], angular [rad/s]"""
STAND: Command = (0.0, 0.0, 0.0)


@dataclass
class Lies:
    """The errors that are made on purpose, from `since` s on; the defaults are true."""

    since: float = math.inf
    scan: Callable[[Scan, Scan], Scan] = lambda seen, _before: seen  # `before`: the first one after `since`
    late: float = 0.0  # s from the scan to its arrival
    sensor: Place = LASER  # where the laser is taken to be on diffbot
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
    seconds: float = 0.0  # from its begin to its end
    hit: bool = False  # an obstacle that moves on, whatever it meets, touched the outline
    drove_into: bool = False  # in a touch of such an obstacle, the robot's own motion brought them nearer
    doubts: set[str] = field(default_factory=set)


class Robot:
    """One robot in a scene; without a known map it has a window of cells around it."""

    def __init__(
        self,
        scene: str | Path,
        obstacles: list[Obstacle],
        known: Map | None,
        seed: int,
        machine: Machine = DIFFBOT,
    ) -> None:
        self.machine, self.speed = machine, SPEED
        self.loop: ClosedLoop = new_loop(scene, seed, machine=machine)
        if machine.legs:
            self.loop.set_posture("standing")
            self.loop.run(RISE)
        self._obstacles = obstacles
        self._standing = np.concatenate([item.outline(0.0) for item in obstacles if not item.path])
        urdf = Path(machine.urdf).read_text()
        self.navigation, self.guard, self._present = Navigation(known, urdf), Guard(urdf), Guard(urdf)
        self.half_width = 10 - self.navigation.distance(0.0, 10.0)  # m
        self.lies = Lies()
        self._first_lie: Scan = {}
        self._arriving: list[tuple[float, float, Scan, Place, Place]] = []
        self._seen = self._doubt = ""
        self._held_since = 0.0
        self._moved = 0.0
        self._follower: Follower | None = None
        self._request = self._command = STAND
        self._state = self._advance(self._command)
        self._problem = ""
        self._before = self.place

    @property
    def place(self) -> Place:
        """The true pose: x [m], y [m], yaw [rad]."""
        return (self._state["truth_x"], self._state["truth_y"], self._state["truth_yaw"])

    def _advance(self, command: Command) -> dict[str, float]:
        log = self.loop.run(STEP, command if self.machine.legs else (command[0], command[2]))
        state = {name: float(log[name][-1]) for name in log if name.startswith(("truth_", "estimate_"))}
        if self.machine.legs:
            joints = {name.removesuffix("_position"): log[name][-1] for name in log if name.endswith("joint_position")}
            self.guard.move_joints(joints, self.loop.time)
            self._present.move_joints(joints, 100 * self.loop.time)  # no earlier outline counts
        self._moved += sum(abs(state[f"estimate_{name}"]) for name in ("linear", "lateral", "angular")) * STEP
        return state

    def _assumed(self) -> Place:
        return self.lies.place(self.place) if self.loop.time >= self.lies.since else self.place

    @property
    def _motion(self) -> Command:
        """As measured."""
        state = self._state
        return state["estimate_linear"], state["estimate_lateral"], state["estimate_angular"]

    @property
    def _odometry(self) -> Place:
        return (self._state["estimate_x"], self._state["estimate_y"], self._state["estimate_yaw"])

    def _see(self) -> str:
        """Takes a scan, receives those that have arrived, and returns why the robot may not be driven."""
        lies, now, seen = self.lies, self.loop.time, self.loop.scan()
        lost = self._locate(seen)
        lying = now >= lies.since
        if lying:
            self._first_lie = self._first_lie or seen
            seen = lies.scan(seen, self._first_lie)
        self._arriving.append((now, now + lies.late * lying, seen, self._odometry, self._assumed()))
        while self._arriving and self._arriving[0][1] <= now + STEP / 2:
            stamp, _, scan, odometry, place = self._arriving.pop(0)
            sensor = lies.sensor if lying else self.machine.laser
            self._seen = self.navigation.update(scan, sensor, place, odometry, now, self._moved)
            self.guard.insert("scan", scan, sensor, odometry, stamp, now, self._moved)
        return self._seen or self._doubt or lost

    def _locate(self, scan: Scan) -> str:  # noqa: ARG002 (the place is the true one)
        """Finds the place by this scan; returns why it does not."""
        return ""

    def _be_guarded(self) -> None:
        """Acts as the guard does at each message of odometry, and as navigate then does."""
        now = self.loop.time
        free, self._doubt, obstacle = self.guard.check(self._odometry, self._motion, self._command, now)
        self.loop.clearance(free)
        if free > 0:
            self._held_since = now
        elif obstacle is not None and now - self._held_since > HELD:
            self.navigation.block(self._assumed(), obstacle, now)

    def _arrived(self) -> bool:
        """True where the goal counts as reached before navigate says so."""
        return False

    def drive(self, goal: Place, limit: float = LONGEST) -> Trip:
        """Begins the goal and returns at its end, or after `limit` s. A stop of before, by an obstacle that hit the
        robot, is reset.
        """
        trip = Trip()
        self.loop.e_stop_reset()
        self._stand(trip)
        begin, self._follower, self._command = self.loop.time, None, STAND
        _, trip.planned, _ = self.navigation.plan(self.place, goal, self.loop.time)
        self.navigation.begin(goal, self.loop.time)
        path = "none"
        while self.loop.time - begin < limit and not self._arrived():
            path = self._report(path)
            state, reason, way, cancel, request, speed = self.navigation.step(
                self.loop.time, self._problem, self._assumed(), self._motion, path, self.speed
            )
            if cancel or way is not None:
                self._follower, path = None, "none"
            if way is not None and request is None:
                self._follower, path = self._new_follower(way, speed), "active"
            self._request = request or STAND
            if state in {"reached", "failed"}:
                trip.state, trip.reason = state, reason
                break
            self._until_next_scan(trip)
        trip.seconds = self.loop.time - begin
        self._stand(trip)
        x, y, yaw = self.place
        trip.error, trip.turn_error = (
            math.hypot(goal[0] - x, goal[1] - y),
            abs(math.remainder(goal[2] - yaw, 2 * math.pi)),
        )
        return trip

    def _stand(self, trip: Trip) -> None:
        self._follower, self._request = None, STAND
        for _ in range(STANDING):
            self._until_next_scan(trip)

    def _until_next_scan(self, trip: Trip) -> None:
        for _ in range(SCAN):
            self._follow()
            self._note(trip)
        self._problem = self._see()
        trip.doubts |= {self._problem} - {""}

    @staticmethod
    def _new_follower(way: list[Place], speed: float) -> Follower | None:
        try:
            points = checked([Waypoint(x, y, yaw) for x, y, yaw in way])
        except PathError:
            return None
        return Follower(route(points), FollowParameters(speed=speed, scale_error=0.05))

    def _report(self, path: str) -> str:
        follower = self._follower
        if path != "active" or follower is None or not follower.over:
            return path
        return "done" if follower.state is State.DONE else follower.reason

    def _follow(self) -> None:
        self._command = self._request
        if self._follower is not None and not self._follower.over:
            linear, _, angular = self._motion
            motion = self._follower.step(Pose(*self._assumed()), Motion(linear, angular), elapsed=STEP)
            self._command = (motion.linear, 0.0, motion.angular)
        self._before = self.place
        self._be_guarded()
        self._state = self._advance(self._command)

    def _note(self, trip: Trip) -> None:
        trip.way += math.dist(self.place[:2], self._before[:2])
        if not trip.hit:  # what moves on pushes it anywhere
            trip.air = min(trip.air, self.air_at(self.place, moving=False, outline=self._outline))
        air = self.air_at(self.place, moving=True, outline=self._outline)
        if air <= 0 and not trip.hit:
            trip.hit, trip.drove_into = (
                True,
                self.air_at(self._before, moving=True, outline=self._outline) > air + NEARER,
            )

    @property
    def _outline(self) -> Navigation | Guard:
        """The one that has the outline of this moment: legs move it."""
        return self._present if self.machine.legs else self.navigation

    def air_at(self, place: Place, *, moving: bool, outline: Navigation | Guard | None = None) -> float:
        """m between the outline at this place and the nearest obstacle of those that move, or of those that stand.
        Without `outline`, the one with which it plans.
        """
        x, y, yaw = place
        points = self._standing
        if moving:
            carts = [item.outline(self.loop.time) for item in self._obstacles if item.path]
            points = np.concatenate([np.empty((0, 2)), *carts])
        near = points[np.hypot(points[:, 0] - x, points[:, 1] - y) < REACH] - (x, y)
        return self.distance_to(near, yaw, outline or self.navigation)

    @staticmethod
    def distance_to(points: NDArray[np.float64], yaw: float, outline: Navigation | Guard) -> float:
        """m between the outline, turned by `yaw`, and the nearest of the points (n, 2) from its base; infinite
        without one.
        """
        cosine, sine = math.cos(yaw), math.sin(yaw)
        return min(
            (outline.distance(cosine * dx + sine * dy, cosine * dy - sine * dx) for dx, dy in points),
            default=math.inf,
        )
