"""Measures how honest the estimate is: whether its covariance fits its errors, and whether it reports slip.

NEES    eᵀ P⁻¹ e of e = (x, y, yaw) and of e = (forward speed, yaw rate); ideal 3 and 2 (Bar-Shalom, Li &
        Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, section 5.4)
slip    of truth.py: SLIPPING is a wheel above 20 %, ROLLING all of them below 5 %, which is not to be flagged
blocked all wheels turn and the robot stands; of more than BLOCKED s it is to be flagged
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bench.odometry.tested_estimator import Ours
from bench.odometry.truth import Array, Truth, wrapped

SLIPPING, ROLLING = 0.2, 0.05
BLOCKED = 1.0  # s
STANDS = 0.02  # m/s
ALL = 0.8  # slip of a wheel that turns beside a ground that stands
ROW = 0.01  # s, between two rows of truth


@dataclass(frozen=True)
class Notice:
    """Truth rows of a run, of 10 ms each."""

    slipping: int
    noticed: int  # of the slipping ones
    rolling: int
    alarms: int  # of the rolling ones
    rows: int  # all of them
    blocked: int = 0  # spans of more than BLOCKED s
    reported: int = 0  # number of these that were flagged before their end


def pose_error(ours: Ours, truth: Truth) -> Array:
    """(M, 3) errors of x, y, yaw."""
    yaw = wrapped(ours.path.yaw - truth.odom.yaw)
    return np.column_stack([ours.path.x - truth.odom.x, ours.path.y - truth.odom.y, yaw])


def twist_error(ours: Ours, truth: Truth) -> Array:
    """(M, 2) errors of forward speed and yaw rate."""
    return np.column_stack([ours.linear - truth.linear, ours.angular - truth.angular])


def nees(error: Array, covariance: Array) -> Array:
    """(M,) from (M, n) and (M, n, n); infinite if the covariance is invalid."""
    result = np.full(len(error), np.inf)
    for row, (e, p) in enumerate(zip(error, covariance, strict=True)):
        if np.isfinite(p).all() and np.linalg.eigvalsh(p)[0] > 0:
            result[row] = e @ np.linalg.solve(p, e)
    return result


def nees_band(runs: int, dimension: int) -> tuple[float, float]:
    """The band that holds the mean of `runs` values of χ² with `dimension` degrees of freedom with 95 %. It uses
    quantiles of χ² with
    n = runs · dimension, over runs, by Wilson & Hilferty (1931), n (1 − 2/(9n) ± 1.96 √(2/(9n)))³, right to 3 % for
    n = 6 and to 0.01 % for n = 100.
    """
    n = runs * dimension
    part = 2 / (9 * n)
    low, high = (n * (1 - part + z * math.sqrt(part)) ** 3 / runs for z in (-1.96, 1.96))
    return low, high


def notice(ours: Ours, truth: Truth) -> Notice:
    """Counts how long slip lasted, and how long it was reported."""
    slipping = (truth.slip > SLIPPING).any(axis=1)
    rolling = (truth.slip < ROLLING).all(axis=1)
    stands = (truth.slip > ALL).all(axis=1) & (np.abs(truth.linear) < STANDS)
    edges = np.flatnonzero(np.diff(stands.astype(int), prepend=0, append=0))
    spans = [(begin, end) for begin, end in edges.reshape(-1, 2) if end - begin > round(BLOCKED / ROW)]
    return Notice(
        slipping=int(slipping.sum()),
        noticed=int((slipping & ours.slip).sum()),
        rolling=int(rolling.sum()),
        alarms=int((rolling & ours.slip).sum()),
        rows=len(rolling),
        blocked=len(spans),
        reported=sum(bool(ours.slip[begin:end].any()) for begin, end in spans),
    )
