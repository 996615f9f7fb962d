"""A random drive: the requests of a sender on cmd_vel over time, as a pure function of its random numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

MANNERS = ("ahead", "reverse", "curve", "spin", "slalom", "crawl", "stop")


@dataclass(frozen=True)
class Leg:
    """From `start` [s] until the next leg: `linear` [m/s], `angular` [rad/s]."""

    start: float
    linear: float
    angular: float


def draw_drive(random: np.random.Generator, seconds: float, linear_limit: float, angular_limit: float) -> list[Leg]:
    """Legs of 0.2 … 2 s over `seconds`; half of those ahead or in reverse have the full `linear_limit` [m/s]."""
    legs = []
    time = 0.0
    while time < seconds:
        manner = MANNERS[random.integers(len(MANNERS))]
        linear, angular = _leg(random, manner)
        legs.append(Leg(time, linear * linear_limit, angular * angular_limit))
        time += random.uniform(0.2, 2.0)
    return legs


def _leg(random: np.random.Generator, manner: str) -> tuple[float, float]:
    """Linear and angular speed as shares of their limits."""
    full = 1.0 if random.random() < 0.5 else random.uniform(0.2, 1.0)
    sign = random.choice([-1.0, 1.0])
    legs = {
        "ahead": (full, 0.0),
        "reverse": (-full, 0.0),
        "curve": (sign * full, random.uniform(-0.5, 0.5)),
        "spin": (0.0, sign * full),
        "slalom": (full, sign * 0.8),
        "crawl": (0.03 * sign, 0.02),
        "stop": (0.0, 0.0),
    }
    return legs[manner]


def leg_at(legs: Sequence[Leg], time: float) -> Leg:
    """The leg that holds at `time` [s]."""
    return [leg for leg in legs if leg.start <= time][-1]
