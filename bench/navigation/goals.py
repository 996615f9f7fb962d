"""Random goals in the scenes, and drives with something wrong on purpose; all in virtual time."""

from __future__ import annotations

import heapq
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from robot_control.installed_files import share_file

from bench.navigation.scene_map import Map, Obstacle, read_scene, true_map
from bench.navigation.tour import DIFFBOT, LASER, QUADBOT, Machine, Place
from bench.navigation.virtual import Lies, Robot, Trip
from bench.rows import Row, Say, bounded
from bench.runs.runner import Processes

SCENES = {"diffbot": ("room", "crowd"), "quadbot": ("room",)}
MACHINES = {"diffbot": DIFFBOT, "quadbot": QUADBOT}
GOALS, FAULT_RUNS, PER_ROBOT = {"diffbot": 100, "quadbot": 30}, 50, 5
AT_GOAL, AT_HEADING = 0.05, math.radians(3)  # m, rad
PADDING = 0.07  # m of air; with less than this and a cell a goal or a way may be refused (docs/navigation.md)
WRONG = 0.1  # of the goals are anywhere in the scene
ASIDE = 0.8  # m: nearer to the way of a cart, which stops for nothing, no robot may stand
TURNED = math.radians(30)

NEIGHBOURS = [(a, b, math.hypot(a, b)) for a in range(-2, 3) for b in range(-2, 3) if math.gcd(a, b) == 1]


def scene_of(name: str) -> tuple[list[Obstacle], Map]:
    """The obstacles of a scene and its true map."""
    obstacles = read_scene(Path(share_file(f"urdf/scenes/{name}.xml")))
    return obstacles, true_map(obstacles)


def random_goal(random: np.random.Generator, known: Map) -> Place:
    """A place anywhere in the scene."""
    x0, y0, resolution, cells = known
    inside = np.argwhere(cells == 100)
    (low_row, low_column), (high_row, high_column) = inside.min(axis=0), inside.max(axis=0)
    x = x0 + random.uniform(low_column, high_column) * resolution
    y = y0 + random.uniform(low_row, high_row) * resolution
    return float(x), float(y), float(random.uniform(-math.pi, math.pi))


def shortest(known: Map, start: Place, goal: Place, radius: float) -> float:
    """m of the shortest way of a circle over every second cell of the map, in steps to 16 neighbours; infinite without
    one.
    """
    x0, y0, resolution, cells = known
    blocked = grown(cells == 100, radius / resolution)[::2, ::2]
    step = 2 * resolution
    begin, end = (((place[1] - y0) / step, (place[0] - x0) / step) for place in (start, goal))
    begin, end = (int(begin[0]), int(begin[1])), (int(end[0]), int(end[1]))
    blocked[begin] = blocked[end] = False
    best, queue = {begin: 0.0}, [(0.0, begin)]
    while queue:
        way, at = heapq.heappop(queue)
        if at == end:
            return way * step
        if way > best[at]:
            continue
        for down, right, length in NEIGHBOURS:
            to = at[0] + down, at[1] + right
            if not (0 <= to[0] < blocked.shape[0] and 0 <= to[1] < blocked.shape[1]) or blocked[to]:
                continue
            if way + length < best.get(to, math.inf):
                best[to] = way + length
                heapq.heappush(queue, (way + length, to))
    return math.inf


def grown(occupied: NDArray[np.bool_], radius: float) -> NDArray[np.bool_]:
    """Cells nearer than `radius` cells to an occupied one."""
    reach = int(radius)
    result = occupied.copy()
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            if math.hypot(down, right) < radius:
                result |= np.roll(occupied, (down, right), axis=(0, 1))
    return result


def drive_goals(task: tuple[str, int, Machine]) -> list[tuple[Trip, bool, float]]:
    """PER_ROBOT goals of one seed: the trip, whether a refusal is true, the shortest way [m]."""
    scene, seed, machine = task
    obstacles, known = scene_of(scene)
    random = np.random.default_rng(seed)
    robot = Robot(scene, obstacles, known, seed, machine)
    trips = []
    for _ in range(PER_ROBOT):
        start, goal = robot.place, random_goal(random, known)
        wrong = random.random() < WRONG
        while not (aside(obstacles, goal) and (wrong or feasible(robot, known, goal))):
            goal = random_goal(random, known)
        possible, way = feasible(robot, known, goal), shortest(known, start, goal, robot.half_width)
        trip = robot.drive(goal)
        trips.append((trip, not possible, way))
        if trip.hit:  # a cart pushes it anywhere, through walls, too
            robot = Robot(scene, obstacles, known, seed, machine)
    return trips


def aside(obstacles: list[Obstacle], place: Place) -> bool:
    """True if no cart passes there."""
    times = np.linspace(0, 120, 1200)
    return all(math.dist(cart.at(time), place[:2]) > ASIDE for cart in obstacles if cart.path for time in times)


def feasible(robot: Robot, known: Map, goal: Place) -> bool:
    """True if the outline has the air there that the product asks for, and a way leads to it."""
    air = PADDING + known[2]
    if robot.air_at(goal, moving=False) < air:
        return False
    return math.isfinite(shortest(known, robot.place, goal, robot.half_width + air))


def drive_lies(task: tuple[str, int]) -> tuple[Trip, float]:
    """One drive of one seed with this lie, which begins while the robot drives; and the way after it, m."""
    lie, seed = task
    obstacles, known = scene_of("room")
    random = np.random.default_rng(seed)
    assumed = {"other map": scene_of("crowd")[1], "mirrored map": mirrored(known)}.get(lie, known)
    robot = Robot("room", obstacles, assumed, seed)
    angle, since = random.uniform(-math.pi, math.pi), robot.loop.time + float(random.uniform(2, 12))
    shift = (math.cos(angle), math.sin(angle))
    lies = {
        "frozen": Lies(since, scan=lambda _seen, before: before),
        "shifted": Lies(since, sensor=(LASER[0] + 0.5 * shift[0], 0.5 * shift[1], 0.0)),
        "other map": Lies(),
        "mirrored map": Lies(),
        "turned": Lies(since, place=lambda at: (at[0], at[1], at[2] + math.copysign(TURNED, angle))),
        "jump": Lies(since, place=lambda at: (at[0] + shift[0], at[1] + shift[1], at[2])),
    }
    robot.lies = lies[lie]
    while True:
        goal = random_goal(random, known)
        if feasible(robot, known, goal) and (lie != "mirrored map" or feasible(robot, assumed, goal)):
            return robot.drive(goal), since


def mirrored(house: Map) -> Map:
    """The map of a house that lies on the other side of the x axis."""
    x, y, resolution, cells = house
    return x, -y - len(cells) * resolution, resolution, cells[::-1].copy()


OTHER_MAPS = {"other map", "mirrored map"}
LIES = {
    "frozen": "scan is frozen",
    "shifted": "the scan contradicts the map",
    "other map": "the scan contradicts the map",
    "mirrored map": "the scan contradicts the map",
    "turned": "the scan contradicts the map",
    "jump": "the scan contradicts the map",
}


def goals(first: int, runs: int | None, say: Say, robot: str = "diffbot") -> list[Row]:
    """Rows of `goals`; `runs`: goals in each scene."""
    rows = []
    for scene in SCENES[robot]:
        count = math.ceil((runs or GOALS[robot]) / PER_ROBOT)
        tasks = [(scene, seed, MACHINES[robot]) for seed in range(first, first + count)]
        trips = [trip for found in Processes().outcomes(drive_goals, tasks, say) for trip in found]
        rows += _goal_rows(scene if robot == "diffbot" else f"{robot}, {scene}", trips, say)
    return rows


def _goal_rows(scene: str, trips: list[tuple[Trip, bool, float]], say: Say) -> list[Row]:
    reached = [(trip, way) for trip, _, way in trips if trip.state == "reached"]
    wrong = [trip for trip, infeasible, _ in trips if trip.state != "reached" and not infeasible]
    for trip in wrong:
        say(f"{scene}: {trip.state or 'no end'}: {trip.reason}")
    ways = [(trip.way, way) for trip, way in reached if math.isfinite(way) and way > 1]
    inexact = sum(trip.error > AT_GOAL or trip.turn_error > AT_HEADING for trip, _ in reached)
    return [
        bounded(f"{scene}: goals neither reached nor refused for a true reason", len(wrong), f"of {len(trips)}", 0),
        bounded(f"{scene}: goals refused for a true reason", len(trips) - len(reached) - len(wrong), "", len(trips)),
        bounded(f"{scene}: ends beyond 5 cm or 3°", inexact, f"of {len(reached)}", 0),
        bounded(f"{scene}: touches of what stands", sum(trip.air <= 0 for trip, _, _ in trips), f"of {len(trips)}", 0),
        bounded(
            f"{scene}: touches of carts, which stop for nothing",
            sum(trip.hit for trip, _, _ in trips),
            f"of {len(trips)}",
            0,
        ),
        bounded(
            f"{scene}: of these, touches to which the robot moved",
            sum(trip.drove_into for trip, _, _ in trips),
            f"of {len(trips)}",
            0,
        ),
        bounded(f"{scene}: way / shortest way", sum(a for a, _ in ways) / max(sum(b for _, b in ways), 1e-9), "", 1.15),
    ]


def faults(first: int, runs: int, say: Say) -> list[Row]:
    """Rows of `faults`; `runs`: drives with each lie."""
    rows = []
    for lie, cause in LIES.items():
        tasks = [(lie, seed) for seed in range(first, first + runs)]
        drives = list(Processes().outcomes(drive_lies, tasks, say))
        affected = [trip for trip, since in drives if trip.doubts or trip.state != "reached" or lie in OTHER_MAPS]
        unnamed = [trip for trip in affected if not any(cause in each for each in (*trip.doubts, trip.reason))]
        for trip in unnamed:
            say(f"{lie}: {trip.state}: {trip.reason}; {sorted(trip.doubts)}")
        touches = sum(trip.air <= 0 for trip, _ in drives)
        say(f"{lie}: {touches} touches of {len(drives)}, {len(unnamed)} of {len(affected)} affected without the cause")
        rows += [
            bounded(f"{lie}: touches", touches, f"of {len(drives)}", 0),
            bounded(f"{lie}: ends without the cause named", len(unnamed), f"of {len(affected)} affected", 0),
        ]
    return rows
