"""Points of a path: their checks, and CSV files of them. Pure but for reading the file."""

import csv
import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from robot_control.files.files import InputFileError, check_input, listed
from robot_control.robot.pose import FARTHEST, Pose

COLUMNS = ("x", "y", "yaw", "speed")
APART = 1e-4
"""m; a point that is nearer to the one before is left out"""
MAX_POINTS = 100_000
"""points"""
MAX_FILE = 1 << 24
"""bytes of a CSV file"""
JUMP, JUMP_RATIO, ENOUGH = 1.0, 20.0, 10
"""m, times the median distance, points: in a path of so many a longer step than both is an error"""


class PathError(ValueError):
    """No path can be driven; the message names the reason."""


@dataclass(frozen=True)
class Waypoint:
    """A point of a path."""

    x: float  # m
    y: float  # m
    yaw: float | None = None  # rad, of the robot; None: along the path
    speed: float | None = None  # m/s, from here on; None: as before, at first as asked for
    turn_speed: float | None = None  # rad/s at most, from here on; None: as before, at first that of the law
    sign: int = 0  # −1: backwards from here on, 1: forwards, 0: by the yaws at both ends


def checked(points: Sequence[Waypoint]) -> list[Waypoint]:
    """The points without repetitions; the last one's yaw stays. A single point with a yaw is a turn on the spot.

    Raises:
        PathError: fewer than two points and no turn, a number that is none, a speed that is not above zero, a jump.
    """
    if len(points) > MAX_POINTS:
        raise PathError(f"the path has {len(points)} points, more than {MAX_POINTS}")
    for number, point in enumerate(points):
        numbers = (point.x, point.y, point.yaw or 0.0, point.speed or 0.0)
        if not all(map(math.isfinite, numbers)):
            raise PathError(f"point {number} of the path holds a number that is not finite")
        if max(map(abs, numbers)) > FARTHEST:
            raise PathError(f"point {number} of the path holds a number beyond {FARTHEST:g}")
        if point.speed is not None and point.speed <= 0:
            raise PathError(f"point {number} of the path has a speed of {point.speed:g} m/s: it must be above zero")
        if point.turn_speed is not None and not point.turn_speed > 0:
            raise PathError(f"point {number} of the path turns at {point.turn_speed:g} rad/s: it must be above zero")
    kept: list[Waypoint] = []
    for point in points:
        if kept and math.hypot(point.x - kept[-1].x, point.y - kept[-1].y) < APART:
            kept[-1] = replace(kept[-1], yaw=point.yaw if point.yaw is not None else kept[-1].yaw)
        else:
            kept.append(point)
    if len(kept) < 2 and (not kept or kept[0].yaw is None):
        raise PathError(f"the path has {len(kept)} different points: it needs two at least")
    _refuse_jumps(kept)
    return kept


def _refuse_jumps(points: list[Waypoint]) -> None:
    if len(points) < ENOUGH:
        return
    lengths = [math.hypot(b.x - a.x, b.y - a.y) for a, b in itertools.pairwise(points)]
    median = sorted(lengths)[len(lengths) // 2]
    for number, length in enumerate(lengths):
        if length > max(JUMP, JUMP_RATIO * median):
            why = f"the path jumps by {length:.2f} m after point {number}, where its points are {median:.3g} m apart"
            raise PathError(why)


def from_poses(poses: Iterable[Any]) -> list[Waypoint]:
    """The points of geometry_msgs/Pose. Four zeros stand for no orientation: the robot then drives along the path."""
    return [Waypoint(each.position.x, each.position.y, _yaw(each.orientation)) for each in poses]


def _yaw(q: Any) -> float | None:  # noqa: ANN401 (geometry_msgs/Quaternion)
    if not any((q.x, q.y, q.z, q.w)):
        return None
    return math.atan2(2 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z)


def shortened(points: Sequence[Waypoint], begin_at: float) -> list[Waypoint]:
    """The rest of a path from `begin_at` m on.

    Raises:
        PathError: it is not that long, or the length is none.
    """
    length = sum(math.hypot(b.x - a.x, b.y - a.y) for a, b in itertools.pairwise(points))
    if begin_at == 0:
        return list(points)
    if not 0 <= begin_at < length:
        raise PathError(f"begin_at is {begin_at:g} m: it must be from 0 to below the path's length, {length:.2f} m")
    speed, turn_speed, start = None, None, 0.0
    for number, (a, b) in enumerate(itertools.pairwise(points)):
        speed = a.speed if a.speed is not None else speed
        turn_speed = a.turn_speed if a.turn_speed is not None else turn_speed
        size = math.hypot(b.x - a.x, b.y - a.y)
        if begin_at < start + size:
            share = (begin_at - start) / size
            x, y = a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)
            first = replace(a, x=x, y=y, speed=speed, turn_speed=turn_speed)
            return [first, *points[number + 1 :]]
        start += size
    return list(points[-2:])  # the rounding of the sum


def limited(points: Sequence[Waypoint], speeds: Sequence[float], turn_speeds: Sequence[float]) -> list[Waypoint]:
    """The points with limits from each of them on: m/s, negative for backwards, and rad/s, 0 for none. Either list may
    be empty.

    Raises:
        PathError: a list has another length, or a number is none.
    """
    for name, given in (("speeds", speeds), ("turn_speeds", turn_speeds)):
        if given and len(given) != len(points):
            raise PathError(f"{name} has {len(given)} numbers and the path {len(points)} poses: it needs one of each")
    if not all(map(math.isfinite, speeds)) or 0 in speeds:
        raise PathError("speeds must be finite and not zero")
    if not speeds and not turn_speeds:
        return list(points)
    no_speeds: list[float | None] = [None] * len(points)
    limits = zip(points, speeds or no_speeds, turn_speeds or [0.0] * len(points), strict=True)
    return [
        replace(
            point,
            speed=point.speed if speed is None else abs(speed),
            sign=0 if speed is None else int(math.copysign(1, speed)),
            turn_speed=turn_speed or math.inf,
        )
        for point, speed, turn_speed in limits
    ]


def placed(points: Sequence[Waypoint], origin: Pose) -> list[Waypoint]:
    """The same path, its origin at this pose."""
    places = (origin.holding(point.x, point.y) for point in points)
    return [
        replace(point, x=x, y=y, yaw=None if point.yaw is None else point.yaw + origin.yaw)
        for point, (x, y) in zip(points, places, strict=True)
    ]


def read_csv(path: Path) -> list[Waypoint]:
    """A header of x, y and maybe yaw, speed, then one point a line; an empty yaw or speed is none.

    Raises:
        PathError: naming file and line.
        OSError: the file cannot be read.
    """
    try:
        check_input(path, MAX_FILE)
    except InputFileError as error:
        raise PathError(str(error)) from None
    with path.open(newline="", encoding="utf-8", errors="replace") as file:
        return read_csv_text(str(path), file)


def read_csv_text(path: str, lines: Iterable[str]) -> list[Waypoint]:
    """The same of lines; `path` is their name in a message.

    Raises:
        PathError: naming the line.
    """
    try:
        return _points_of(path, csv.DictReader(lines))
    except csv.Error as error:
        raise PathError(f"{path}: is not a CSV: {error}") from None


def _points_of(path: str, rows: "csv.DictReader[str]") -> list[Waypoint]:
    names = [name.strip() for name in rows.fieldnames or []]
    if not {"x", "y"} <= set(names) <= set(COLUMNS) or len(set(names)) < len(names):
        raise PathError(f"{path}: the first line must be x,y or x,y,yaw or x,y,yaw,speed; it is '{listed(names)}'")
    rows.fieldnames = names
    points = []
    for row in rows:
        try:
            if None in row:
                raise ValueError  # more values than names
            values = {name: float(row[name]) for name in names if (row[name] or "").strip()}
            points.append(Waypoint(values["x"], values["y"], values.get("yaw"), values.get("speed")))
        except (KeyError, TypeError, ValueError):
            raise PathError(f"{path}:{rows.line_num}: not a point of {','.join(names)}") from None
    return points
