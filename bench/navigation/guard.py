"""The collision guard: walls and boxes that appear before every sender, and lasers that lie; all in virtual time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from robot_control import ClosedLoop
from robot_control._navigation import Guard
from robot_control.drive.path.follower import Follower, FollowParameters, Motion
from robot_control.drive.path.pieces import route
from robot_control.drive.path.waypoints import Waypoint
from robot_control.fleet.v2.leg import Leg, leg_of
from robot_control.fleet.v2.order import order_of
from robot_control.installed_files import share_file
from robot_control.robot.pose import Pose

from bench.fleet.messages import order
from bench.navigation.goals import feasible, random_goal, scene_of
from bench.navigation.tour import LASER, SCAN_PERIOD, Scan
from bench.navigation.virtual import STEP, Lies, Robot, Trip
from bench.rows import Row, Say, bounded
from bench.runs.runner import Processes

TRIALS, LIE_RUNS = 200, 50
SENDERS = ("path", "fleet", "teleop", "console")
VIEWS = (180, 270, 360)  # degrees
LEGS = "legs"
WALK, SIDEWAYS, WALK_TURN, RISE = 0.3, 0.15, 0.5, 4.0  # m/s, m/s, rad/s, s
NEAREST, FARTHEST = 0.3, 2.0  # m from the outline when it appears
NOISE, RANGE, RAYS_PER_DEGREE = 0.01, 12.0, 1  # m, m
APPEARS, ENDS = (1.5, 4.0), 6.0  # s
SPEED, TURN = 0.5, 1.0  # m/s, rad/s

Segments = NDArray[np.float64]
"""(n, 4): x, y [m] of both ends"""
Command = tuple[float, float, float]
"""linear, lateral [m/s], angular [rad/s]"""
Sender = Callable[[Pose, Motion, float], Command]
"""the command for pose, measured motion and the limit of the speed, m/s"""


def sender_of(kind: str, random: np.random.Generator) -> Sender:
    """A path with bends, an order of three edges, or the speeds of a key that is held; on legs, also to the side."""
    if kind == "path":
        return _follower(_wave(random))
    if kind == "fleet":
        places = [(3.0 * number, float(random.uniform(-0.7, 0.7)) * bool(number)) for number in range(4)]
        ordered = order_of(order(places))
        leg: Leg = leg_of(ordered.nodes[0], [*_in_turn(ordered.edges, ordered.nodes[1:])], 0.05)
        return _follower([Waypoint(each.x, each.y, each.yaw) for each in leg.path(SPEED)])
    if kind == LEGS:
        ahead, aside = random.choice([(WALK, 0.0), (WALK, 0.0), (-WALK, 0.0), (0.0, SIDEWAYS), (0.0, -SIDEWAYS)])
        walk = float(ahead), float(aside), float(random.uniform(-WALK_TURN, WALK_TURN)) * (random.random() < 0.5)
        return lambda _pose, _measured, _limit: walk
    linear = float(random.choice([SPEED, SPEED, SPEED, -SPEED]))
    turn = float(random.uniform(-TURN, TURN)) * (kind == "console" or random.random() < 0.5)
    return lambda _pose, _measured, _limit: (linear, 0.0, turn)


def _in_turn(edges: Any, nodes: Any) -> Iterator[Any]:  # noqa: ANN401 (of an order)
    for pair in zip(edges, nodes, strict=True):
        yield from pair


def _wave(random: np.random.Generator) -> list[Waypoint]:
    """A curve of random bends, driven forwards or backwards."""
    sign, bend = float(random.choice([1, 1, 1, -1])), float(random.uniform(0, 0.6))
    xs = np.linspace(0, 9, 91)
    points = [(sign * float(x), bend * (1 - math.cos(float(x)))) for x in xs]
    yaws = [math.atan2(sign * (b[1] - a[1]), sign * (b[0] - a[0])) for a, b in pairwise(points)]
    return [Waypoint(x, y, yaw) for (x, y), yaw in zip(points, [*yaws, yaws[-1]], strict=True)]


def _follower(path: list[Waypoint]) -> Sender:
    follower = Follower(route(path), FollowParameters(speed=SPEED, scale_error=0.05))

    def command(pose: Pose, measured: Motion, limit: float) -> Command:
        motion = follower.step(pose, measured, limit, STEP)
        return motion.linear, 0.0, motion.angular

    return command


def scan_of(segments: Segments, place: tuple[float, float, float], view: int, random: np.random.Generator) -> Scan:
    """A scan of the segments by a laser of this field of view, in degrees; +inf where there is none."""
    count = view * RAYS_PER_DEGREE + (view < 360)
    angles = math.radians(1 / RAYS_PER_DEGREE) * (np.arange(count) - (count - 1) / 2)
    x, y, yaw = place
    dx, dy = np.cos(angles + yaw)[:, None], np.sin(angles + yaw)[:, None]
    ax, ay, bx, by = segments.T
    ex, ey = bx - ax, by - ay
    cross = dx * ey - dy * ex
    with np.errstate(divide="ignore", invalid="ignore"):
        along = ((ax - x) * ey - (ay - y) * ex) / cross
        share = ((ax - x) * dy - (ay - y) * dx) / cross
    along = np.where((along > 0) & (share >= 0) & (share <= 1), along, np.inf).min(axis=1, initial=np.inf)
    ranges = np.where(along < RANGE, along + random.normal(0, NOISE, count), np.inf).astype(np.float32)
    return {
        "angle_min": float(angles[0]),
        "angle_increment": math.radians(1 / RAYS_PER_DEGREE),
        "range_min": 0.05,
        "range_max": RANGE,
        "ranges": ranges,
    }


def eye_at(pose: tuple[float, float, float]) -> tuple[float, float, float]:
    """The place of the laser on the robot that is here."""
    x, y, yaw = pose
    return x + math.cos(yaw) * LASER[0], y + math.sin(yaw) * LASER[0], yaw


def in_view(segments: Segments, pose: tuple[float, float, float], view: int) -> bool:
    """True if two points lie well within the view of the laser of the robot that is here.

    They are the middle of the first segment, towards the robot, and the point that is nearest to the base. A robot that
    drives backwards does not see what is behind it.
    """
    a, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    shares = np.clip(((pose[:2] - a) * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
    points = a + shares[:, None] * along
    nearest = points[np.hypot(*(points - pose[:2]).T).argmin()]
    eye = eye_at(pose)
    bearings = [math.atan2(y - eye[1], x - eye[0]) - eye[2] for x, y in (nearest, a[0] + along[0] / 2)]
    widest = max(abs(math.remainder(bearing, 2 * math.pi)) for bearing in bearings)
    return widest < math.radians(view / 2 - 10) or view == VIEWS[-1]


def obstacle(pose: tuple[float, float, float], motion: Command, away: float, random: np.random.Generator) -> Segments:
    """A wall of 4 m or a box of 0.4 m so far before the base on its arc, turned by up to 60 degrees."""
    x, y, yaw = pose
    linear, lateral, angular = motion
    course = yaw + math.atan2(lateral, linear) + angular * away / max(math.hypot(linear, lateral), 1e-6) / 2
    cx, cy = x + away * math.cos(course), y + away * math.sin(course)
    normal = course + float(random.uniform(-math.pi / 3, math.pi / 3))
    half = 2.0 if random.random() < 0.5 else 0.2
    ax, ay = -math.sin(normal) * half, math.cos(normal) * half
    bx, by = math.cos(normal) * 0.4, math.sin(normal) * 0.4
    corners = [(cx - ax, cy - ay), (cx + ax, cy + ay), (cx + ax + bx, cy + ay + by), (cx - ax + bx, cy - ay + by)]
    return np.array([(*a, *b) for a, b in pairwise([*corners, corners[0]])])


def air(guard: Guard, segments: Segments, pose: tuple[float, float, float]) -> float:
    """m between the outline at this pose and the nearest segment."""
    shares = np.linspace(0, 1, 201)[:, None]
    points = np.concatenate([a + shares * (b - a) for a, b in zip(segments[:, :2], segments[:, 2:], strict=True)])
    x, y, yaw = pose
    c, s = math.cos(yaw), math.sin(yaw)
    near = points - (x, y)
    near = near[np.hypot(near[:, 0], near[:, 1]) < 1.0]
    return min((guard.distance(c * dx + s * dy, c * dy - s * dx) for dx, dy in near), default=math.inf)


@dataclass
class Meeting:
    """One trial."""

    least: float  # m of air
    driven: float  # m before the obstacle appeared


def meet(task: tuple[str, int, int, bool]) -> Meeting | None:
    """One obstacle before one sender; None where it appears nearer than NEAREST or beside the field of view."""
    kind, view, seed, guarded = task
    random = np.random.default_rng((seed, view, *kind.encode()))
    sender = sender_of(kind, random)
    urdf = share_file("urdf/quadbot.urdf" if kind == LEGS else "urdf/diffbot.urdf")
    loop = ClosedLoop(seed=seed, urdf=urdf)
    if kind == LEGS:
        loop.set_posture("standing")
        loop.run(RISE)
    guard, begins = Guard(Path(urdf).read_text()), loop.time
    appears, away = float(random.uniform(*APPEARS)), float(random.uniform(NEAREST, FARTHEST))
    segments, moved, least, limit = np.empty((0, 4)), 0.0, math.inf, math.inf
    command: Command = (0.0, 0.0, 0.0)
    for step in range(round((appears + ENDS) / STEP)):
        log = loop.run(STEP, command if kind == LEGS else (command[0], command[2]))
        last = {name: float(values[-1]) for name, values in log.items()}
        pose = (last["estimate_x"], last["estimate_y"], last["estimate_yaw"])
        true = (last["truth_x"], last["truth_y"], last["truth_yaw"])
        linear, lateral, angular = (last[f"estimate_{name}"] for name in ("linear", "lateral", "angular"))
        moved += (abs(linear) + abs(lateral) + abs(angular)) * STEP
        if kind == LEGS:
            joints = {
                name.removesuffix("_position"): at for name, at in last.items() if name.endswith("joint_position")
            }
            guard.move_joints(joints, loop.time)
        if not len(segments) and loop.time >= begins + appears:
            segments = obstacle(true, command, away + 0.28, random)
            if air(guard, segments, true) < NEAREST or not in_view(segments, true, view):
                return None
        if step % round(SCAN_PERIOD / STEP) == 0:
            guard.insert(
                "scan", scan_of(segments, eye_at(true), view, random), LASER, pose, loop.time, loop.time, moved
            )
        command = sender(Pose(*pose), Motion(linear, angular), limit)
        if guarded:
            free, _, _ = guard.check(pose, (linear, lateral, angular), command, loop.time)
            loop.clearance(free)
            limit = last.get("speed_limit", math.inf)
            limit = math.inf if math.isnan(limit) else limit
        if len(segments):
            least = min(least, air(guard, segments, true))
    return Meeting(least, moved)


def meetings(first: int, trials: int, say: Say) -> list[Row]:
    """Rows of the obstacles that appear."""
    rows = []
    for kind in (*SENDERS, LEGS):
        for view in VIEWS:
            name = f"{kind}, laser of {view} degrees"
            met = _met(kind, view, range(first, first + trials), say, guarded=True)
            touches = sum(each.least <= 0 for each in met)
            say(f"{name}: {touches} touches of {len(met)}, least air {min(each.least for each in met):.3f} m")
            rows.append(bounded(f"{name}: touches", touches, f"of {len(met)}", 0))
        blind = _met(kind, VIEWS[-1], range(first, first + max(1, trials // 10)), say, guarded=False)
        share = sum(each.least <= 0 for each in blind) / len(blind)
        rows.append(bounded(f"lowest share of touches without the guard: {kind}", share, f"of {len(blind)}", 0.5))
    return rows


def _met(kind: str, view: int, seeds: range, say: Say, *, guarded: bool) -> list[Meeting]:
    tasks = [(kind, view, seed, guarded) for seed in seeds]
    return [each for each in Processes().outcomes(meet, tasks, say) if each is not None]


def _front(value: float) -> Callable[[Scan, Scan], Scan]:
    """The front 120 degrees of the scan report this."""

    def changed(seen: Scan, _before: Scan) -> Scan:
        return _sector(seen, np.float32(value))

    return changed


def _sector(seen: Scan, values: Any) -> Scan:  # noqa: ANN401 (a number or an array)
    angles = seen["angle_min"] + seen["angle_increment"] * np.arange(len(seen["ranges"]))
    front = np.abs(angles) < math.radians(60)
    return {**seen, "ranges": np.where(front, values, seen["ranges"]).astype(np.float32)}


LYING: dict[str, tuple[Lies, str]] = {
    "front +inf": (Lies(scan=_front(math.inf)), "scan is blind in part"),
    "front 0": (Lies(scan=_front(0.0)), "scan is blind in part"),
    "front range_max": (
        Lies(scan=lambda seen, _before: _sector(seen, np.float32(seen["range_max"]))),
        "scan is blind in part",
    ),
    "front frozen": (Lies(scan=lambda seen, before: _sector(seen, before["ranges"])), "scan is frozen"),
    "late 0.4 s": (Lies(late=0.4), ""),
}


def lie(task: tuple[str, str, int]) -> Trip:
    """A goal in this scene while the laser lies from the third second on."""
    scene, what, seed = task
    obstacles, known = scene_of(scene)
    random = np.random.default_rng(seed)
    robot = Robot(scene, obstacles, known, seed)
    robot.lies = replace(LYING[what][0], since=3.0)
    while True:
        goal = random_goal(random, known)
        if math.dist(goal[:2], robot.place[:2]) > 3 and feasible(robot, known, goal):
            return robot.drive(goal)


def lies(first: int, runs: int, say: Say) -> list[Row]:
    """Rows of the lasers that lie."""
    rows = []
    for scene in ("room", "crowd"):
        for what, (_, cause) in LYING.items():
            tasks = [(scene, what, seed) for seed in range(first, first + runs)]
            trips = list(Processes().outcomes(lie, tasks, say))
            into = sum(trip.air <= 0 or trip.drove_into for trip in trips)
            unnamed = sum(cause not in " ".join([*trip.doubts, trip.reason]) for trip in trips)
            reached = sum(trip.state == "reached" for trip in trips)
            say(f"{scene}, {what}: {into} touches by own motion, {unnamed} unnamed, {reached} reached of {len(trips)}")
            rows.append(bounded(f"{scene}, {what}: touches by own motion", into, f"of {len(trips)}", 0))
            if cause:
                rows.append(bounded(f"{scene}, {what}: not named", unnamed, f"of {len(trips)}", 0))
    return rows
