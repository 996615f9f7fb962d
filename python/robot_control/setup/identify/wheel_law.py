"""The law that an identified robot is taken to obey, as rows of a linear regression.

τ and q are torque and angle of a wheel, forward positive; v and ω are the robot's speeds by its wheels. The wheel's
radius is r, and side is −1 left, +1 right. There are h wheels a side; b is the wheel base, b' the effective one. The
law is that of src/control/wheeled/wheel_loops/feed_forward.h. Wheels behind each other are fitted as one, their mean:
the ground moves torque between them, and the share of each is chance.

    τ = J_straight·v̇/r + J_turning·side·ω̇·b'/(2r) + d·q̇ + f·sign(q̇) + side·(s·sign(ω) + e·ω)
        + p·r/h·(side·v·ω/b − ω²/2) + c

s and e: torque of scrubbing beyond f and d while turning; p: mass times centre of gravity ahead of the wheels; c:
slope.

No noisy signal is differentiated. A difference of angles commutes with a moving average. So both sides of the equation
pass the same four moving averages of WINDOW s (a cubic B-spline). The same law holds for the filtered signals, whatever
the torque does from cycle to cycle. The torque of sample k acted over [t_k−1, t_k), hence τ(t_k) is the mean of samples
k and k+1.
"""

from dataclasses import dataclass

import numpy as np

from robot_control.data.run_log import FloatArray, Log

WINDOW = 0.04
"""s, of each moving average, together 0.16 s; oscillations on the tyres faster than 10 Hz average out"""
FILTERS = 4
"""Moving averages on either side"""
STANDING = 0.5
"""rad/s below which dry friction is undefined: five times ε of feed_forward.h"""
SPIN = 1e-6
"""rad/s; a plan with a smaller rate is straight"""


@dataclass(frozen=True)
class Wheel:
    """One drive wheel as the controller knows it."""

    joint: str
    side: int  # −1 left, +1 right
    sign: float  # +1: positive joint velocity drives forward
    radius: float  # m


@dataclass(frozen=True)
class Base:
    """The wheels together."""

    wheels: tuple[Wheel, ...]
    wheel_base: float  # m
    effective_wheel_base: float  # m

    @property
    def wheels_beside(self) -> int:
        """h, wheels a side."""
        return len(self.wheels) // 2

    @property
    def radius(self) -> float:
        """m, mean of all wheels."""
        return float(np.mean([wheel.radius for wheel in self.wheels]))

    def beside(self, side: int) -> tuple[Wheel, ...]:
        """The wheels of one side, front to back."""
        return tuple(wheel for wheel in self.wheels if wheel.side == side)


SIDES = (-1, 1)
"""Left, right: the order of all arrays"""


@dataclass(frozen=True)
class Signals:
    """Signals of one stretch of cycles without a gap, unfiltered; arrays of shape (rows, sides)."""

    angle: FloatArray  # rad
    effort: FloatArray  # N·m
    plan: FloatArray  # rad/s, planned, in the row in which the plan is carried out


def signals_of(log: Log, rows: slice, base: Base, lag: int) -> Signals:
    """The signals of `rows`; `lag`: cycles from a command to the sample of its torque."""

    def mean_of(column: str) -> FloatArray:
        sides = [[wheel.sign * log[f"{wheel.joint}_{column}"][rows] for wheel in base.beside(side)] for side in SIDES]
        return np.asarray(np.mean(sides, axis=1).T)

    # The plan of cycle k is carried out from k + lag on.
    plan = mean_of("velocity_command")[: -lag or None]
    return Signals(mean_of("position")[lag:], mean_of("effort")[lag:], plan)


@dataclass(frozen=True)
class Regression:
    """Filtered signals in rows in which the friction of both sides is known."""

    torque: FloatArray  # (rows, sides), N·m
    regressors: FloatArray  # (rows, sides, terms)
    instruments: FloatArray  # (rows, sides, terms), the same terms of the plan


TERMS = ("straight", "turning", "damping", "friction", "scrub", "scrub_damping", "ahead", "slope")


def regression(signals: Signals, base: Base, period: float, width: int, shift: int) -> Regression:
    """The filtered terms; `shift`: cycles by which the motion follows the measured torque."""
    early, late = max(0, -shift), max(0, shift)
    rows = len(signals.angle) - abs(shift)
    angle = signals.angle[late : late + rows]
    effort, plan = signals.effort[early : early + rows], signals.plan[early : early + rows]

    speed = (angle[2:] - angle[:-2]) / (2 * period)
    sign = _direction(speed, width)
    known = ~np.isnan(sign).any(axis=1)
    planned = plan[1:-1]
    spin = _spin(planned, base)
    turning = np.where(np.abs(spin) > SPIN, np.sign(spin), 0.0)
    moved = _terms(speed, np.diff(angle, 2, axis=0) / period**2, sign, turning, base)
    planned_terms = _terms(planned, (plan[2:] - plan[:-2]) / (2 * period), sign, turning, base)

    used = averaged(known.astype(float), width) > 1 - 1e-9  # rounding of the sums
    torque = averaged((effort[1:-1] + effort[2:]) / 2, width)[used]
    instruments = averaged(np.nan_to_num(planned_terms), width)[used]
    return Regression(torque, averaged(np.nan_to_num(moved), width)[used], instruments)


def _direction(speed: FloatArray, width: int) -> FloatArray:
    """−1, +1, or NaN where a wheel stands, nearly stands, or the direction is unknown; (rows, sides)."""
    sign = np.full_like(speed, np.nan)
    smooth = averaged(speed, width, 1)
    edge = (len(speed) - len(smooth)) // 2
    sign[edge : edge + len(smooth)] = np.where(np.abs(smooth) > STANDING, np.sign(smooth), np.nan)
    return sign


def _spin(speed: FloatArray, base: Base) -> FloatArray:
    """rad/s or rad/s² of the robot, (rows,), from rad/s or rad/s² of its wheels."""
    return np.asarray(base.radius * (speed[:, 1] - speed[:, 0]) / base.effective_wheel_base)


def _advance(speed: FloatArray, base: Base) -> FloatArray:
    """m/s or m/s² of the robot, (rows,), from rad/s or rad/s² of its wheels."""
    return np.asarray(base.radius * speed.mean(axis=1))


def _terms(
    speed: FloatArray, acceleration: FloatArray, sign: FloatArray, turning: FloatArray, base: Base
) -> FloatArray:
    """(rows, sides, terms) of the law above."""
    v, spin = _advance(speed, base), _spin(speed, base)
    linear, angular = _advance(acceleration, base), _spin(acceleration, base)
    r = base.radius
    terms = np.ones((*speed.shape, len(TERMS)))
    for i, side in enumerate(SIDES):
        terms[:, i, 0] = linear / r
        terms[:, i, 1] = side * angular * base.effective_wheel_base / (2 * r)
        terms[:, i, 2] = speed[:, i]
        terms[:, i, 3] = sign[:, i]
        terms[:, i, 4] = side * turning
        terms[:, i, 5] = side * spin
        terms[:, i, 6] = r / base.wheels_beside * (side * v * spin / base.wheel_base - spin**2 / 2)
    return terms


def averaged(values: FloatArray, width: int, times: int = FILTERS) -> FloatArray:
    """Moving averages along the first axis, `times` of `width` rows; times·(width − 1) rows shorter."""
    for _ in range(times):
        total = np.cumsum(np.concatenate([np.zeros_like(values[:1]), values]), axis=0)
        values = (total[width:] - total[:-width]) / width
    return values
