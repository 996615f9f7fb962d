"""Cuts a path at corners and reversals into pieces that are driven without a stop."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

from robot_control.drive.path.waypoints import Waypoint, checked
from robot_control.robot.pose import turned

CORNER = math.radians(35.0)
"""rad; a sharper change of direction is turned on the spot"""

Point = tuple[float, float]


@dataclass(frozen=True)
class Foot:
    """The nearest point of a piece within reach."""

    along: float  # m from the begin of the piece
    distance: float  # m from the robot
    aside: float  # m that the robot is to the left of the tangent
    tangent: float  # rad, direction of the piece there


class Piece:
    """A polyline; lengths in m."""

    def __init__(
        self,
        points: Sequence[Point],
        sign: int,
        speeds: Sequence[float | None],
        turn_speeds: Sequence[float | None] = (),
    ) -> None:
        """`sign` −1: driven backwards; `speeds` and `turn_speeds` of each segment, None: the requested speed, the limit
        of the law.
        """
        self.points, self.sign, self.speeds = list(points), sign, list(speeds)
        self.turn_speeds = list(turn_speeds) or [None] * len(self.speeds)
        lengths = (math.dist(a, b) for a, b in pairwise(self.points))
        self.starts = list(accumulate(lengths, initial=0.0))
        self._segment = 0
        self._along = 0.0  # m, position of the last foot

    @property
    def length(self) -> float:
        """m"""
        return self.starts[-1]

    @property
    def first_heading(self) -> float:
        """rad, heading of the robot at the begin of the piece."""
        return self.heading(self._tangent(0))

    @property
    def last_heading(self) -> float:
        """rad, heading of the robot at its end."""
        return self.heading(self._tangent(len(self.points) - 2))

    def heading(self, tangent: float) -> float:
        """Heading of a robot that drives along this direction."""
        return turned(tangent if self.sign > 0 else tangent + math.pi)

    def foot(self, x: float, y: float, reach: float) -> Foot:
        """The nearest point to this one, searched from the last answer on, at most `reach` ahead, never behind."""
        best, best_along, best_distance = self._segment, self._along, math.inf
        for number in range(self._segment, len(self.points) - 1):
            if self.starts[number] > self._along + reach:
                break
            along, distance = self._nearest(number, x, y)
            if distance < best_distance - 1e-12:
                best, best_along, best_distance = number, along, distance
        self._segment, self._along = best, best_along
        tangent = self._tangent(best)
        dx, dy = x - self.points[best][0], y - self.points[best][1]
        return Foot(best_along, best_distance, dy * math.cos(tangent) - dx * math.sin(tangent), tangent)

    def at(self, along: float) -> Point:
        """The point at this distance from its begin; beyond the ends it lies on their tangents."""
        number = min(max(bisect_right(self.starts, along) - 1, 0), len(self.points) - 2)
        tangent, rest = self._tangent(number), along - self.starts[number]
        return self.points[number][0] + rest * math.cos(tangent), self.points[number][1] + rest * math.sin(tangent)

    def speed_at(self, along: float, ahead: float, speed: float, deceleration: float) -> float:
        """m/s at the distance `along` from the begin: that of its segment, else `speed`. It is lower where a slower
        segment has to be entered at its own speed, with this deceleration from the distance `ahead` on.
        """
        number = self._segment_at(along)
        result = self._own(number, speed)
        for slower in range(number + 1, len(self.speeds)):
            distance = max(0.0, self.starts[slower] - ahead)
            if 2 * deceleration * distance >= result * result:
                break
            result = min(result, math.sqrt(self._own(slower, speed) ** 2 + 2 * deceleration * distance))
        return result

    def _own(self, number: int, speed: float) -> float:
        given = self.speeds[number]
        return speed if given is None else given

    def turn_speed_at(self, along: float, turn_speed: float) -> float:
        """rad/s at this distance from the begin: that of the path where it is lower."""
        given = self.turn_speeds[self._segment_at(along)]
        return turn_speed if given is None else min(given, turn_speed)

    def _segment_at(self, along: float) -> int:
        return min(max(bisect_right(self.starts, along) - 1, 0), len(self.speeds) - 1)

    def _tangent(self, number: int) -> float:
        (ax, ay), (bx, by) = self.points[number], self.points[number + 1]
        return math.atan2(by - ay, bx - ax)

    def _nearest(self, number: int, x: float, y: float) -> tuple[float, float]:
        """The nearest point of a segment, not behind the last one: m from the begin of the piece, m from this point."""
        (ax, ay), (bx, by) = self.points[number], self.points[number + 1]
        dx, dy = bx - ax, by - ay
        start, size = self.starts[number], self.starts[number + 1] - self.starts[number]
        share = min(1.0, max(0.0, self._along - start) / size)
        share = min(1.0, max(share, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)))
        return start + share * size, math.hypot(x - ax - share * dx, y - ay - share * dy)


@dataclass(frozen=True)
class Route:
    """All pieces in their order; none where the robot turns on the spot alone."""

    pieces: tuple[Piece, ...]
    end_heading: float  # rad
    begin: Point
    turn_speed: float  # rad/s at most, of a turn without pieces

    @property
    def length(self) -> float:
        """m"""
        return sum(piece.length for piece in self.pieces)


def route(waypoints: Sequence[Waypoint]) -> Route:
    """Cuts a path. Raises PathError."""
    points = checked(waypoints)
    segments = list(pairwise(points))
    tangents = [math.atan2(b.y - a.y, b.x - a.x) for a, b in segments]
    signs = [_sign(a, b, tangent) for (a, b), tangent in zip(segments, tangents, strict=True)]
    speeds = _held([point.speed for point in points[:-1]])
    turn_speeds = _held([point.turn_speed for point in points[:-1]])
    pieces, begin = [], 0
    for number in range(1, len(points)):
        last = number == len(points) - 1
        if last or signs[number] != signs[number - 1] or abs(turned(tangents[number] - tangents[number - 1])) > CORNER:
            part = [(point.x, point.y) for point in points[begin : number + 1]]
            pieces.append(Piece(part, signs[begin], speeds[begin:number], turn_speeds[begin:number]))
            begin = number
    end = points[-1].yaw
    heading = pieces[-1].last_heading if end is None else turned(end)
    return Route(tuple(pieces), heading, (points[0].x, points[0].y), points[-1].turn_speed or math.inf)


def _held(given: list[float | None]) -> list[float | None]:
    """Each value until the next one."""
    held: list[float | None] = []
    for value in given:
        held.append(value if value is not None or not held else held[-1])
    return held


def _sign(begin: Waypoint, end: Waypoint, tangent: float) -> int:
    """That of the segment, if given; else −1 if the mean of the robot's headings at both ends points against it."""
    if begin.sign:
        return begin.sign
    headings = [point.yaw for point in (begin, end) if point.yaw is not None]
    if len(headings) < 2:
        return 1
    return 1 if sum(math.cos(heading - tangent) for heading in headings) >= -1e-9 else -1
