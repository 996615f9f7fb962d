"""Trajectories of edges: NURBS → points (6.6.6).

    C(u) = Σ wᵢ·Nᵢ(u)·Pᵢ / Σ wᵢ·Nᵢ(u),    u from knot[degree] to knot[n]

as B-spline in homogeneous coordinates: L. Piegl, W. Tiller, The NURBS Book (1997), section 4.1.
"""

import math
from itertools import pairwise

import numpy as np
from scipy.interpolate import BSpline

from robot_control.fleet.v2.messages import Message

Point = tuple[float, float]
STEP = 0.05
"""m between two points, along the control points"""
MAX_DEGREE = 10
MAX_LENGTH = 200.0
"""m along the control points of one edge"""
MAX_WEIGHT_RATIO = 1e6
"""of the largest weight of a curve to its smallest one; in the books both are near 1"""


class CurveError(ValueError):
    """No curve; the message names the rule."""


def points_of(trajectory: Message) -> list[Point]:
    """Points of the curve from its begin to its end. Raises CurveError."""
    controls, knots = trajectory["controlPoints"], trajectory["knotVector"]
    degree, count = int(trajectory.get("degree", 1)), len(trajectory["controlPoints"])
    if not 1 <= degree <= min(MAX_DEGREE, count - 1):
        raise CurveError(f"degree must be from 1 to {MAX_DEGREE} and below the number of control points")
    if len(knots) != count + degree + 1:
        raise CurveError(f"knotVector must have {count + degree + 1} entries, not {len(knots)}")
    if any(b < a for a, b in pairwise(knots)) or knots[degree] == knots[count]:
        raise CurveError("knotVector must not fall, and must rise between its ends")
    weights = [each.get("weight", 1.0) for each in controls]
    heaviest = max(weights)
    if min(weights) <= 0 or min(weights) < heaviest / MAX_WEIGHT_RATIO:
        raise CurveError(f"every weight must be above zero, and at least {1 / MAX_WEIGHT_RATIO:g} of the largest one")
    shares = [weight / heaviest for weight in weights]
    homogeneous = [(w * each["x"], w * each["y"], w) for w, each in zip(shares, controls, strict=True)]
    length = sum(math.dist((a["x"], a["y"]), (b["x"], b["y"])) for a, b in pairwise(controls))
    if length > MAX_LENGTH:
        raise CurveError(f"its control points are {length:.0f} m long, more than {MAX_LENGTH:g} m")
    begin, end = knots[degree], knots[count]
    if degree == 1:
        return [(each["x"], each["y"]) for each in controls]
    steps = max(2 * count, math.ceil(length / STEP))
    along = BSpline(np.asarray(knots, float), np.asarray(homogeneous), degree)(np.linspace(begin, end, steps + 1))
    points: list[Point] = list(map(tuple, (along[:, :2] / along[:, 2:]).tolist()))
    return points
