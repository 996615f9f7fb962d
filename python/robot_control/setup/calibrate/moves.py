"""calibrate.py drives straight lines and squares by wheel odometry with these moves, which know no ROS.

A pilot receives every pose and answers with a velocity. It need not be exact, because calibrate.py measures what was
driven, not what was planned. A proportional law with the cruise speed as a ceiling suffices.

    on a line  v = clip(creep + k·(rest of the path)),  ω = −k_θ·(heading error) − k_y·(m to the left of the line)
    corner     ω = ±clip(creep_ω + k·|rest of the turn|),  v = 0
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from robot_control.robot.pose import Pose, turned

APPROACH = 1.2  # 1/s
CREEP = 0.02  # m/s; 2 mm of overshoot per 0.1 s of delay
CREEP_TURN = 0.04  # rad/s
HEADING = 1.5  # 1/s
SIDEWAYS = 1.0  # 1/(m·s)
ARRIVED = 0.002  # m
TURNED = math.radians(0.3)
STEER = 0.3  # rad/s, at most, on a line
REST = 0.6  # s of zero between two moves: the body stops rocking


@dataclass(frozen=True)
class Line:
    """A straight line from `begin` to `length` m ahead of it; poses in the frame of the run's start."""

    begin: Pose
    length: float  # m


@dataclass(frozen=True)
class Corner:
    """A turn on the spot to this heading."""

    yaw: float  # rad, in the frame of the run's start
    left: bool


Move = Line | Corner


def straight(length: float) -> list[Move]:
    """One line of `length` m."""
    return [Line(Pose(0.0, 0.0, 0.0), length)]


def square(side: float, *, clockwise: bool) -> list[Move]:
    """Four sides and four corners, back to the first heading."""
    sign = -1 if clockwise else 1
    moves: list[Move] = []
    x = y = 0.0
    for leg in range(4):
        yaw = sign * leg * math.pi / 2
        moves += [Line(Pose(x, y, yaw), side), Corner(turned(yaw + sign * math.pi / 2), left=not clockwise)]
        x, y = x + side * math.cos(yaw), y + side * math.sin(yaw)
    return moves


class Pilot:
    """Follows moves from the pose at the first call of `command`."""

    def __init__(self, moves: Sequence[Move], speed: float, turn_speed: float) -> None:
        """`speed` m/s, `turn_speed` rad/s: ceilings."""
        self._moves = list(moves)
        self._speed = speed
        self._turn_speed = turn_speed
        self._start: Pose | None = None
        self._number = 0
        self._rest_until = 0.0

    @property
    def done(self) -> bool:
        """True when all moves and the rest after the last one are over."""
        return self._number >= len(self._moves) and self._rest_until == 0.0

    @property
    def number(self) -> int:
        """Number of moves that are over."""
        return self._number

    def command(self, pose: Pose, time: float) -> tuple[float, float]:
        """m/s and rad/s; `pose` by wheel odometry, `time` s of any clock."""
        self._start = self._start or pose
        if self._rest_until > 0.0:
            if time >= self._rest_until:
                self._rest_until = 0.0
            return 0.0, 0.0
        if self._number >= len(self._moves):
            return 0.0, 0.0
        move = self._moves[self._number]
        here = Pose(*pose.seen_from(self._start), turned(pose.yaw - self._start.yaw))
        wanted = self._line(move, here) if isinstance(move, Line) else self._corner(move, here)
        if wanted is None:
            self._number += 1
            self._rest_until = time + REST
            return 0.0, 0.0
        return wanted

    def _line(self, line: Line, here: Pose) -> tuple[float, float] | None:
        ahead, left = here.seen_from(line.begin)
        rest = line.length - ahead
        if rest <= ARRIVED:
            return None
        steer = -HEADING * turned(here.yaw - line.begin.yaw) - SIDEWAYS * left
        return min(self._speed, CREEP + APPROACH * rest), max(-STEER, min(STEER, steer))

    def _corner(self, corner: Corner, here: Pose) -> tuple[float, float] | None:
        sign = 1 if corner.left else -1
        rest = turned(sign * (corner.yaw - here.yaw))
        if rest <= TURNED:
            return None
        return 0.0, sign * min(self._turn_speed, CREEP_TURN + APPROACH * rest)
