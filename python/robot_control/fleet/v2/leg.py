"""The way from one stand to the next: what follow_path is given, and where its nodes lie on it.

A leg ends where the robot has to stand: at the end of the base, and at a node with another orientation than the way. It
also ends before a SOFT or HARD action, which belongs to the node or to the edge after it. An edge without length is a
leg of its own: a turn to the orientation of its last node. So is the turn on the first node of an order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

from robot_control.drive.path.follower import FollowParameters
from robot_control.drive.path.pieces import CORNER
from robot_control.drive.path.waypoints import APART, JUMP
from robot_control.fleet.v2.curve import CurveError, Point, points_of
from robot_control.fleet.v2.messages import Message, RefusedError
from robot_control.fleet.v2.order import NONE, Edge, Node, Place
from robot_control.robot.pose import turned

SAME_HEADING = math.radians(2.0)
"""rad between two orientations that count as one"""
END_GAP = 0.1
"""m that the ends of a trajectory may lie off their nodes"""
SHORTEST = 0.02
"""m of an edge that is driven; a shorter one has no length"""
STEP = JUMP / 2
"""m between points beside a curve, at most"""
SLOWEST = FollowParameters.slowest
"""m/s, rad/s that follow_path keeps"""


class PathPoint(NamedTuple):
    """A point of a leg; the limits hold from it on."""

    x: float
    y: float
    yaw: float  # rad, of the robot
    speed: float  # m/s, negative: backwards
    turn_speed: float  # rad/s, 0: that of the robot


@dataclass(frozen=True)
class Way:
    """An edge as it is driven."""

    points: tuple[Point, ...]  # one: the robot stands
    sign: int  # −1: backwards
    speed: float  # m/s, 0: the speed of the robot
    turn_speed: float  # rad/s, 0: that of the robot

    @property
    def length(self) -> float:
        """m"""
        return sum(math.dist(a, b) for a, b in pairwise(self.points))

    def limits(self, number: int, fastest: float) -> tuple[float, float, float]:
        """yaw, speed and turn_speed of the points of a segment; `fastest`: m/s."""
        yaw = self.heading(number) if len(self.points) > 1 else 0.0
        return yaw, self.sign * min(self.speed or fastest, fastest), self.turn_speed

    def heading(self, number: int) -> float:
        """rad, of the robot on a segment."""
        (ax, ay), (bx, by) = self.points[number : number + 2] if number >= 0 else self.points[-2:]
        return turned(math.atan2(by - ay, bx - ax) + (math.pi if self.sign < 0 else 0.0))

    def foot(self, x: float, y: float, start: float) -> tuple[float, float]:
        """Its nearest point: m along it plus `start`, m of distance."""
        best = (start, math.dist((x, y), self.points[0]))
        for (ax, ay), (bx, by) in pairwise(self.points):
            size = math.dist((ax, ay), (bx, by))
            share = min(1.0, max(0.0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / size**2))
            distance = math.dist((x, y), (ax + share * (bx - ax), ay + share * (by - ay)))
            best = min(best, (start + share * size, distance), key=lambda each: each[1])
            start += size
        return best


def _apart(points: list[Point]) -> tuple[Point, ...]:
    """The points without each one that is nearer than APART to the last one before it that stays."""
    kept = points[:1]
    for point in points[1:]:
        if math.dist(kept[-1], point) > APART:
            kept.append(point)
    return tuple(kept)


def way_of(edge: Edge, begin: Place, end: Place) -> Way:
    """Raises RefusedError: orderError with the field that cannot be followed."""

    def refused(field: str, why: str) -> RefusedError:
        return RefusedError("orderError", f"edge {edge.id}: {field} {why}", edgeId=edge.id, parameter=field)

    raw = edge.raw
    for field in ("corridor", "direction"):
        if field in raw:
            raise refused(field, "cannot be followed by this robot")
    if raw.get("minHeight", 0.0) > 0:
        raise refused("minHeight", "needs a load handling device, but the robot has none")
    for field in ("maxSpeed", "maxRotationSpeed"):
        if raw.get(field, SLOWEST) < SLOWEST:
            raise refused(field, f"must be at least {SLOWEST:g}")
    points: list[Point] = [(begin.x, begin.y), (end.x, end.y)]
    if "trajectory" in raw:
        try:
            points = points_of(raw["trajectory"])
        except CurveError as error:
            raise refused("trajectory", str(error)) from None
        for place, point in ((begin, points[0]), (end, points[-1])):
            if math.dist((place.x, place.y), point) > max(END_GAP, place.deviation_xy):
                raise refused("trajectory", f"must begin and end within {END_GAP:g} m of the nodes")
    way = Way(_apart(points), 1, raw.get("maxSpeed", 0.0), raw.get("maxRotationSpeed", 0.0))
    if way.length < SHORTEST:
        if raw.get("orientationType") == "GLOBAL":
            raise refused("orientation", f"needs an edge of {SHORTEST:g} m: set theta of its last node")
        return Way(way.points[-1:], 1, way.speed, way.turn_speed)
    if raw.get("rotationAllowed") is False and _sharpest(way) > CORNER:
        raise refused("rotationAllowed", "is false, and the trajectory has a corner")
    return Way(way.points, _sign(way, raw, refused), way.speed, way.turn_speed)


def _sharpest(way: Way) -> float:
    headings = [way.heading(number) for number in range(len(way.points) - 1)]
    return max((abs(turned(b - a)) for a, b in pairwise(headings)), default=0.0)


def _sign(way: Way, raw: Message, refused: Callable[[str, str], RefusedError]) -> int:
    wanted = raw.get("orientation", 0.0)
    kind = raw.get("orientationType", "TANGENTIAL")
    if kind not in ("TANGENTIAL", "GLOBAL"):
        raise refused("orientationType", "must be TANGENTIAL or GLOBAL")
    numbers = range(len(way.points) - 1)
    offsets = [turned(wanted - (way.heading(n) if kind == "GLOBAL" else 0.0)) for n in numbers]
    if all(abs(offset) <= SAME_HEADING for offset in offsets):
        return 1
    if all(abs(turned(offset - math.pi)) <= SAME_HEADING for offset in offsets):
        return -1
    raise refused("orientation", "is not along the edge: a differential drive cannot drive sideways")


@dataclass(frozen=True)
class Leg:
    """Edges with the nodes at their ends, in one go."""

    begin: Node
    ways: tuple[Way, ...]
    nodes: tuple[Node, ...]  # at the ends of `ways`

    @property
    def ends(self) -> list[float]:
        """m along the leg, of each node."""
        total, result = 0.0, []
        for way in self.ways:
            total += way.length
            result.append(total)
        return result

    @property
    def length(self) -> float:
        """m"""
        return self.ends[-1]

    def path(self, fastest: float) -> list[PathPoint]:
        """Its points; the last one's yaw is the orientation of the last node, if it has one. `fastest`: m/s.

        Beside a curve a straight edge has points, too: in a path of close points follow_path refuses a long step.
        """
        dense = any(len(way.points) > 2 for way in self.ways)
        result = [
            PathPoint(ax + (bx - ax) * part / parts, ay + (by - ay) * part / parts, *way.limits(number, fastest))
            for way in self.ways
            for number, ((ax, ay), (bx, by)) in enumerate(pairwise(way.points))
            for parts in [math.ceil(math.dist((ax, ay), (bx, by)) / STEP) if dense else 1]
            for part in range(parts)
        ]
        last, place = self.ways[-1], self.nodes[-1].place
        yaw, *limits = last.limits(-1, fastest)
        theta = yaw if place is None or place.theta is None else place.theta
        return [*result, PathPoint(*last.points[-1], theta, *limits)]

    def without_driven(self, along: float) -> tuple[Leg, float]:
        """The leg from the edge on which the robot is, and the distance on it."""
        starts = [0.0, *self.ends[:-1]]
        number = max(n for n, start in enumerate(starts) if n == 0 or start < along)
        begin = self.begin if number == 0 else self.nodes[number - 1]
        return Leg(begin, self.ways[number:], self.nodes[number:]), along - starts[number]

    def foot(self, x: float, y: float, reach: float) -> tuple[float, float]:
        """m along the leg, m of distance: the nearest point of the first edge within `reach`, else of all."""
        feet, start = [], 0.0
        for way in self.ways:
            feet.append(way.foot(x, y, start))
            start += way.length
        return next((foot for foot in feet if foot[1] <= reach), min(feet, key=lambda foot: foot[1]))


def leg_of(begin: Node, base: Sequence[Node | Edge], tolerance: float) -> Leg:
    """The leg from a node over the base. It begins with an edge, or with this node, which is then not reached before
    the robot has its orientation. `tolerance`: rad, of an orientation.
    """
    if base and isinstance(base[0], Node) and begin.place is not None:
        return Leg(begin, (Way(((begin.place.x, begin.place.y),), 1, 0.0, 0.0),), (begin,))
    ways: list[Way] = []
    nodes: list[Node] = []
    for edge, node in zip(base[::2], base[1::2], strict=False):
        if not isinstance(edge, Edge) or not isinstance(node, Node):
            break
        before = nodes[-1] if nodes else begin
        if before.place is None or node.place is None:
            break
        if nodes and any(action.blocking != NONE for action in edge.actions):
            break
        way = way_of(edge, before.place, node.place)
        if nodes and not way.length:
            break
        ways.append(way)
        nodes.append(node)
        blocks = any(action.blocking != NONE for action in node.actions)
        if blocks or not way.length or not aligned(node.place, way.heading(-1), tolerance):
            break
    return Leg(begin, tuple(ways), tuple(nodes))


def aligned(place: Place | None, heading: float, tolerance: float) -> bool:
    """True if a heading is the orientation of a node within its deviation, or the node has none."""
    if place is None or place.theta is None:
        return True
    return abs(turned(place.theta - heading)) <= max(place.deviation_theta or 0.0, tolerance)
