"""The plan by which a robot is driven to be identified: ramps forwards and back, then turns both ways, at three speeds.

Every move is a step of the command, which the robot's own limiter turns into a ramp, and ends in rest. The next move
undoes it. So the plan ends at its begin, and never leaves `space` m ahead of it. A move to speed v within the limits
(a, d, j: acceleration, deceleration, jerk) covers no more than

    v·(cruise + v/(2a) + v/(2d) + (a + d)/(2j))

A ramp to v lasts v/a + a/j and covers half of v times that (src/control/common/limits/axis_limiter.h). The fastest
speed is the largest for which the move fits into REACH times the space.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

LEVELS = (1 / 3, 2 / 3, 1.0)
"""Shares of the fastest speed; three of them distinguish viscous from dry friction."""
CRUISE = 0.8
"""s at the speed of a move; five times the filters of the fit, so that friction is measured without inertia"""
PAUSE = 0.2
"""s at rest; below 0.25 s the controller does not yet hand over to the brake (standstill.h)"""
REACH = 0.9
"""Share of the space; the remaining tenth covers the errors of tracking and odometry."""
SLOWEST = 0.05
"""m/s at the wheels' rims; below it the three levels are too close to show dry friction"""
MAX_TURN = 2 * math.pi
"""rad; a larger turn winds up cables"""


class NoRoomError(ValueError):
    """The space is too small; the message names the space that is needed."""


@dataclass(frozen=True)
class AxisLimits:
    """Limits of one axis; m/s or rad/s and its derivatives; jerk may be infinite."""

    speed: float
    acceleration: float
    deceleration: float
    jerk: float

    def ramps(self, speed: float) -> float:
        """Way [m or rad] of the ramp to `speed` and of the one back to rest."""
        jerks = (self.acceleration + self.deceleration) / (2 * self.jerk)
        return speed * (speed / (2 * self.acceleration) + speed / (2 * self.deceleration) + jerks)

    def time_down(self, speed: float) -> float:
        """s from `speed` to rest, at most."""
        return speed / self.deceleration + self.deceleration / self.jerk

    def time_up(self, speed: float) -> float:
        """s from rest to `speed`, at most."""
        return speed / self.acceleration + self.acceleration / self.jerk

    def fastest_within(self, distance: float) -> float:
        """The largest speed at which a move covers at most `distance`; 0 if there is none."""
        square = 1 / (2 * self.acceleration) + 1 / (2 * self.deceleration)
        linear = CRUISE + (self.acceleration + self.deceleration) / (2 * self.jerk)
        return (math.sqrt(linear**2 + 4 * square * distance) - linear) / (2 * square)


@dataclass(frozen=True)
class Move:
    """A command and its duration."""

    linear: float  # m/s
    angular: float  # rad/s
    seconds: float


@dataclass(frozen=True)
class Excitation:
    """The whole plan."""

    moves: tuple[Move, ...]
    linear: float  # m/s, fastest
    angular: float  # rad/s, fastest
    reach: float  # m ahead of the start
    turn: float  # rad, to the left of the start

    @property
    def seconds(self) -> float:
        """Duration of the plan, s."""
        return sum(move.seconds for move in self.moves)

    def command(self, time: float) -> tuple[float, float]:
        """m/s and rad/s at `time` s after the begin; zero after the end."""
        for move in self.moves:
            if time < move.seconds:
                return move.linear, move.angular
            time -= move.seconds
        return 0.0, 0.0


def plan_excitation(
    linear: AxisLimits, angular: AxisLimits, *, wheel_base: float, space: float, max_speed: float, repeats: int
) -> Excitation:
    """Fits the moves into `space` m ahead of the robot, no wheel faster than `max_speed` m/s; `wheel_base` m.

    Raises:
        NoRoomError: not even SLOWEST fits.
    """
    v = min(linear.speed, max_speed, linear.fastest_within(REACH * space))
    needed = (SLOWEST * CRUISE + linear.ramps(SLOWEST)) / REACH
    if v < SLOWEST * (1 - 1e-9):
        raise NoRoomError(
            f"--space {space:g} m, --max-speed {max_speed:g} m/s: the robot would drive {v:.3g} m/s at most, "
            f"{SLOWEST:g} m/s are needed. Give at least {math.ceil(100 * needed) / 100:g} m and {SLOWEST:g} m/s"
        )
    w = min(angular.speed, 2 * max_speed / wheel_base, angular.fastest_within(MAX_TURN))
    moves = [*_moves(linear, v, repeats, turn=False), *_moves(angular, w, repeats, turn=True)]
    return Excitation(tuple(moves), v, w, v * CRUISE + linear.ramps(v), w * CRUISE + angular.ramps(w))


def _moves(limits: AxisLimits, fastest: float, repeats: int, *, turn: bool) -> Iterator[Move]:
    for _ in range(repeats):
        for level in LEVELS:
            for speed in (level * fastest, -level * fastest):
                pair = (0.0, speed) if turn else (speed, 0.0)
                yield Move(*pair, limits.time_up(abs(speed)) + CRUISE)
                yield Move(0.0, 0.0, limits.time_down(abs(speed)) + PAUSE)
