"""Trajectories of edges: NURBS → points (6.6.6).

    C(u) = Σ wᵢ·Nᵢ(u)·Pᵢ / Σ wᵢ·Nᵢ(u),    u from knot[degree] to knot[n]

by de Boor's algorithm in homogeneous coordinates: L. Piegl, W. Tiller, The NURBS Book (1997), sections 3.1 and 4.1.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from itertools import pairwise

from robot_control.fleet.v2.messages import Message

Point = tuple[float, float]
STEP = 0.05
"""m between two points, along the control points"""
MAX_DEGREE = 10
MAX_LENGTH = 200.0
"""m along the control points of one edge"""


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
    if min(weights) <= 0:
        raise CurveError("every weight must be above zero")
    homogeneous = [(w * each["x"], w * each["y"], w) for w, each in zip(weights, controls, strict=True)]
    length = sum(math.dist((a["x"], a["y"]), (b["x"], b["y"])) for a, b in pairwise(controls))
    if length > MAX_LENGTH:
        raise CurveError(f"its control points are {length:.0f} m long, more than {MAX_LENGTH:g} m")
    begin, end = knots[degree], knots[count]
    if degree == 1:
        return [(each["x"], each["y"]) for each in controls]
    steps = max(2 * count, math.ceil(length / STEP))
    return [_at(begin + (end - begin) * n / steps, degree, knots, homogeneous) for n in range(steps + 1)]


def _at(u: float, degree: int, knots: list[float], controls: list[tuple[float, float, float]]) -> Point:
    span = min(max(bisect_right(knots, u) - 1, degree), len(controls) - 1)
    while knots[span] == knots[span + 1]:
        span -= 1  # u is the last knot
    local = [list(controls[span - degree + n]) for n in range(degree + 1)]
    for level in range(1, degree + 1):
        for n in range(degree, level - 1, -1):
            low, high = knots[span - degree + n], knots[span + 1 + n - level]
            share = 0.0 if high == low else (u - low) / (high - low)
            local[n] = [(1 - share) * a + share * b for a, b in zip(local[n - 1], local[n], strict=True)]
    x, y, w = local[degree]
    return x / w, y / w
