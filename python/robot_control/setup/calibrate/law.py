"""Computes common radius, ratio of the radii and wheel base from driven distances and squares. It needs no ROS.

Wheel odometry uses the nominal radius R and wheel base b. In truth the left and right wheels roll s·c_l·R and s·c_r·R
over a base of
E_b·b. With E_d = right over left radius and the mean radius in s (Borenstein & Feng, "Measurement and
Correction of Systematic Odometry Errors in Mobile Robots", IEEE Trans. Robotics and Automation 12(6), 1996):

    c_l = 2/(E_d + 1)      c_r = 2/(1/E_d + 1)

Each step of the path of wheel odometry, Δs and Δθ, is then in truth

    left = Δs − Δθ·b/2     right = Δs + Δθ·b/2
    Δs'  = s·(c_l·left + c_r·right)/2      Δθ' = s·(c_r·right − c_l·left)/(E_b·b)

`replay` integrates that to the robot's true path. s, E_d and E_b are fitted until this path agrees with the tape. The
tape measures the length of straight drives, and the place to which squares driven both ways return. Least
squares on the exact arcs are minimised, so large errors, round corners and an open square do no harm.

Only straight drives separate the common radius from the wheel base, because squares show E_b/s. Without straight drives
s is 1.

`umbmark` has the authors' own formulas for small errors. On a square of side L, every quarter turn lacks α, and every
side turns to the left by β. Adding the four sides' displacements to first order, a return of

    clockwise          x =  y = −2L(α + β)
    counter-clockwise  x = −y = −2L(α − β)

for side k points k·(β ∓ α) + β/2 beside its direction. So α and β are means of four numbers; then, from the arc of a
side, of radius ρ, and from the quarter turn:

    ρ = (L/2)/sin(β/2)      E_d = (ρ + b/2)/(ρ − b/2)      E_b = 90°/(90° − α)
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from robot_control.robot.pose import FloatArray, along_arcs, arcs_between

TAPE = 0.003
"""m, standard deviation of one reading: half a finger's width, on marks on a floor"""
FARTHEST = 0.9
"""of a factor from 1; no robot has such wheels"""


class NotCalibratedError(ValueError):
    """The measurements do not determine the wheels; the message names the reason and the remedy."""


@dataclass(frozen=True)
class Wheels:
    """The nominal geometry of wheel odometry."""

    wheel_base: float  # m, effective
    axle: tuple[float, float] = (0.0, 0.0)  # m, middle of the wheels in the axes of odometry's child frame


@dataclass(frozen=True)
class Straight:
    """One driven distance."""

    path: FloatArray  # (n, 3): x m, y m, yaw rad by wheel odometry
    measured: float  # m between the middles of the wheels at its ends, by tape


@dataclass(frozen=True)
class Square:
    """One closed path."""

    path: FloatArray  # (n, 3)
    measured: tuple[float, float]  # m, end of the middle of the wheels: ahead, to the left of the start
    clockwise: bool


@dataclass(frozen=True)
class Truth:
    """The true wheels relative to their nominal values, with standard deviations; 0 means not measured."""

    scale: float = 1.0  # mean radius
    ratio: float = 1.0  # E_d, right over left radius
    base: float = 1.0  # E_b, wheel base
    scale_deviation: float = 0.0
    ratio_deviation: float = 0.0
    base_deviation: float = 0.0


def sides(ratio: float) -> tuple[float, float]:
    """c_l, c_r."""
    return 2 / (ratio + 1), 2 / (1 / ratio + 1)


def of_axle(path: FloatArray, axle: tuple[float, float]) -> FloatArray:
    """The path of the middle of the wheels, which lies at `axle` in the axes of the frame that follows `path`."""
    x, y, yaw = np.asarray(path, float).T
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return np.column_stack([x + cosine * axle[0] - sine * axle[1], y + sine * axle[0] + cosine * axle[1], yaw])


def replay(path: FloatArray, wheels: Wheels, truth: Truth) -> FloatArray:
    """(n, 3): the true path of the middle of the wheels, seen from its start."""
    advance, turn = arcs_between(*of_axle(path, wheels.axle).T)
    left, right = sides(truth.ratio)
    left *= truth.scale
    right *= truth.scale
    half = turn * wheels.wheel_base / 2
    true_left, true_right = left * (advance - half), right * (advance + half)
    true_turn = (true_right - true_left) / (truth.base * wheels.wheel_base)
    return along_arcs((true_left + true_right) / 2, true_turn)


def return_errors(squares: Sequence[Square], wheels: Wheels, truth: Truth) -> FloatArray:
    """(n, 2) m: measured minus calculated return; UMBmark calls it ε."""
    return np.array([np.array(square.measured) - replay(square.path, wheels, truth)[-1, :2] for square in squares])


def largest_mean_return_error(squares: Sequence[Square], wheels: Wheels, truth: Truth) -> float:
    """m, E_max,syst: the longer of the two directions' mean ε."""
    errors = return_errors(squares, wheels, truth)
    clockwise = np.array([square.clockwise for square in squares])
    directions = (rows for rows in (clockwise, ~clockwise) if rows.any())
    return max(float(np.linalg.norm(errors[rows].mean(axis=0))) for rows in directions)


def fit(straights: Sequence[Straight], squares: Sequence[Square], wheels: Wheels) -> Truth:
    """Fits the scale to straight drives, and ratio and base to squares both ways, if there are any.

    Raises:
        NotCalibratedError: nothing was measured, squares go one way only, or the numbers fit no robot.
    """
    free = [len(straights) > 0, len(squares) > 0, len(squares) > 0]
    ways = {square.clockwise for square in squares}
    if not any(free):
        raise NotCalibratedError("nothing was measured: drive a distance, or squares both ways")
    if len(ways) == 1:
        what = "squares of one direction cannot distinguish unequal wheels from a wrong base (Borenstein & Feng 1996)"
        raise NotCalibratedError(f"{what}: drive them both ways")

    def residual(at: FloatArray) -> FloatArray:
        truth = Truth(*_spread(at, free))
        driven = [float(np.linalg.norm(replay(drive.path, wheels, truth)[-1, :2])) for drive in straights]
        straight = np.array([drive.measured for drive in straights]) - np.array(driven)
        returned = return_errors(squares, wheels, truth).ravel() if squares else np.empty(0)
        return np.concatenate([straight, returned])

    found = least_squares(residual, np.ones(np.count_nonzero(free)), bounds=(1 - FARTHEST, 1 + FARTHEST))
    if not found.success or found.active_mask.any():
        why = "these numbers are not consistent: check units (m), signs (x forward, y left) and directions"
        raise NotCalibratedError(why)
    deviations = np.zeros(3)
    deviations[free] = _deviations(found.jac, found.fun)
    return Truth(*_spread(found.x, free), *deviations)


def _spread(found: FloatArray, free: list[bool]) -> FloatArray:
    """All factors: those that were found, and 1."""
    values = np.ones(3)
    values[free] = found
    return values


def _deviations(jacobian: FloatArray, residual: FloatArray) -> FloatArray:
    """Standard deviations from the spread of the residuals, which is taken to be at least that of a tape."""
    freedom = len(residual) - jacobian.shape[1]
    variance = max(TAPE**2, float(residual @ residual) / freedom if freedom > 0 else 0.0)
    return np.asarray(np.sqrt(variance * np.diag(np.linalg.inv(jacobian.T @ jacobian))))


@dataclass(frozen=True)
class Umbmark:
    """The authors' two errors for a robot that drove squares by its wheels."""

    alpha: float  # rad that a quarter turn lacks
    beta: float  # rad that a side turns to the left
    ratio: float  # E_d
    base: float  # E_b


def umbmark(clockwise: FloatArray, counter_clockwise: FloatArray, side: float, wheel_base: float) -> Umbmark:
    """Computes the errors from returns ε, (n, 2) m each way, on squares of `side` m."""
    x_cw, y_cw = np.mean(clockwise, axis=0)
    x_ccw, y_ccw = np.mean(counter_clockwise, axis=0)
    together = -(x_cw + y_cw) / (4 * side)  # α + β
    apart = -(x_ccw - y_ccw) / (4 * side)  # α − β
    alpha, beta = (together + apart) / 2, (together - apart) / 2
    radius = math.inf if beta == 0 else side / 2 / math.sin(beta / 2)
    ratio = 1.0 if math.isinf(radius) else (radius + wheel_base / 2) / (radius - wheel_base / 2)
    return Umbmark(alpha, beta, ratio, (math.pi / 2) / (math.pi / 2 - alpha))
