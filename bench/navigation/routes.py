"""Routes of waypoints in `room`, half of them with keep-out and speed zones; in virtual time."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bench.navigation.goals import AT_GOAL, AT_HEADING, PADDING, feasible, random_goal, scene_of
from bench.navigation.scene_map import Map
from bench.navigation.tour import Place
from bench.navigation.virtual import REACH, Robot, Trip
from bench.rows import Row, Say, bounded
from bench.runs.runner import Processes

SCENE = "room"
ROUTES, WAYPOINTS = 20, 5
KEEP_OUTS, SLOW = 4, 3
"""zones of a scene"""
SIZE = (0.4, 1.5)
"""m, of their sides"""
SHARE = (20, 80)
"""%, of the mask in a speed zone"""
CLEAR = 1.0
"""m about the start without a zone"""
FASTER = 0.05
"""m/s above the limit of a zone, which odometry and drive may err"""


@dataclass
class Route:
    """One route and its end."""

    trips: list[Trip] = field(default_factory=list)
    entered: int = 0  # cells of a keep-out zone that the outline covered
    faster: float = 0.0  # m/s above the limit of a zone, the largest


class Patrol(Robot):
    """A robot that notes what it does in zones."""

    zones: Map | None = None
    route = Route()
    _keep_out: NDArray[np.float64] = np.empty((0, 2))

    def set_zones(self, zones: Map) -> None:
        """The navigation and the judgement know them from now on."""
        self.zones = zones
        self.navigation.set_zones(zones)
        x0, y0, resolution, cells = zones
        rows, columns = np.nonzero(cells == 100)
        self._keep_out = np.column_stack([x0 + (columns + 0.5) * resolution, y0 + (rows + 0.5) * resolution])

    def away(self, place: Place) -> float:
        """m between the outline at this place and the nearest cell of a keep-out zone."""
        near = self._keep_out - place[:2]
        return self.distance_to(near[np.hypot(*near.T) < REACH], place[2], self._outline)

    def _note(self, trip: Trip) -> None:
        super()._note(trip)
        if self.zones is None:
            return
        self.route.entered += self.away(self.place) <= 0
        x, y, _ = self.place
        x0, y0, resolution, cells = self.zones
        value = int(cells[math.floor((y - y0) / resolution), math.floor((x - x0) / resolution)])
        if 0 < value < 100:
            speed = math.hypot(self._state["truth_linear"], self._state["truth_lateral"])
            self.route.faster = max(self.route.faster, speed - self.navigation.speed_limit(x, y))


def random_zones(random: np.random.Generator, known: Map, start: Place) -> Map:
    """A mask with the cells of the map: keep-out zones and speed zones, none near the start."""
    x0, y0, resolution, cells = known
    mask = np.zeros_like(cells)
    x = x0 + (np.arange(cells.shape[1]) + 0.5) * resolution
    y = y0 + (np.arange(cells.shape[0]) + 0.5) * resolution
    far = np.hypot(x[None, :] - start[0], y[:, None] - start[1]) > CLEAR
    for value in [int(random.integers(*SHARE)) for _ in range(SLOW)] + [100] * KEEP_OUTS:
        at, half = random_goal(random, known), random.uniform(*SIZE, 2) / 2
        inside = np.ix_(abs(y - at[1]) < half[1], abs(x - at[0]) < half[0])
        mask[inside] = np.where(far[inside], value, mask[inside])
    return x0, y0, resolution, mask


def drive_route(task: tuple[bool, int]) -> Route:
    """One route of one seed; `zones`: with zones."""
    zones, seed = task
    obstacles, known = scene_of(SCENE)
    random = np.random.default_rng((seed, zones))
    robot = Patrol(SCENE, obstacles, known, seed)
    robot.route = route = Route()
    allowed = known
    if zones:
        robot.set_zones(mask := random_zones(random, known, robot.place))
        allowed = (*known[:3], np.where(mask[3] == 100, np.int8(100), known[3]))
    waypoints: list[Place] = []
    while len(waypoints) < WAYPOINTS:
        goal = random_goal(random, known)
        if robot.away(goal) > PADDING + known[2] and feasible(robot, allowed, goal):
            waypoints.append(goal)
    for waypoint in waypoints:
        route.trips.append(robot.drive(waypoint))
        if route.trips[-1].state != "reached":
            break
    return route


def routes(first: int, runs: int, say: Say) -> list[Row]:
    """Rows of `routes`; `runs`: routes of each kind."""
    rows = []
    for zones, name in ((False, "routes"), (True, "routes with zones")):
        driven = list(Processes().outcomes(drive_route, [(zones, seed) for seed in range(first, first + runs)], say))
        trips = [trip for route in driven for trip in route.trips]
        ends = [trip for trip in trips if trip.state == "reached"]
        for trip in trips:
            if trip.state != "reached":
                say(f"{name}: {trip.state or 'no end'}: {trip.reason}")
        exact = sum(trip.error <= AT_GOAL and trip.turn_error <= AT_HEADING for trip in ends)
        count = f"of {runs * WAYPOINTS}"
        rows += [
            bounded(f"{name}: waypoints not reached", runs * WAYPOINTS - len(ends), count, 0),
            bounded(f"{name}: reached beyond 5 cm or 3°", len(ends) - exact, count, 0),
            bounded(f"{name}: touches", sum(trip.air <= 0 for trip in trips), count, 0),
        ]
        if zones:
            faster = max(route.faster for route in driven)
            rows += [
                bounded(f"{name}: steps of 20 ms in a keep-out zone", sum(r.entered for r in driven), "", 0),
                bounded(f"{name}: speed above a zone's", faster, "m/s", FASTER),
            ]
    return rows
