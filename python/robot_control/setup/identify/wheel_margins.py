"""Computes how much more gain and delay a wheel loop bears, by eigenvalues as in
src/control/wheeled/wheel_loops/wheel_loop_stability.h.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace

from robot_control._robot_control import spectral_radius

MAX_DELAY = 60
"""Largest delay that the search tries, cycles"""
MAX_GAIN = 64.0
"""Largest factor that the search tries"""
GAIN_STEPS = 12
"""Halvings of that range in the logarithm: 0.1 %"""


@dataclass(frozen=True)
class Loop:
    """The loop of a wheel: gains and plant."""

    kp: float  # N·m·s/rad
    ki: float  # N·m/rad
    kd: float  # N·m·s²/rad
    model_inertia: float  # kg·m²
    bandwidth: float  # Hz
    period: float  # s
    inertias: tuple[float, ...]  # kg·m²: lifted, turning, straight, straight with twice the mass
    damping: float  # N·m·s/rad

    def radius(self, delay: int) -> float:
        """The largest spectral radius over all inertias, `delay` cycles beyond the bus' one."""
        given = asdict(self)
        inertias = given.pop("inertias")
        return max(spectral_radius(**given, inertia=inertia, delay=delay) for inertia in inertias)

    def scaled(self, kp: float, ki: float) -> Loop:
        """The loop with kp and kd times `kp`, ki times `ki`."""
        return replace(self, kp=kp * self.kp, ki=ki * self.ki, kd=kp * self.kd)


@dataclass(frozen=True)
class Margins:
    """Margins of a loop behind a delay."""

    radius: float
    """Spectral radius; below 1: stable"""
    gain: float
    """The loop stays stable if all gains are multiplied by it; at most MAX_GAIN, 0 if the loop is unstable already"""
    delay: int
    """Largest delay beyond the bus' one with a stable loop, cycles; −1 if there is none"""


def margins(loop: Loop, delay: int) -> Margins:
    """The margins of `loop` behind `delay` cycles beyond the bus' one."""
    return Margins(loop.radius(delay), gain_margin(loop, delay), delay_margin(loop))


def gain_margin(loop: Loop, delay: int) -> float:
    """The factor on all gains at which the loop becomes unstable."""

    def stable(factor: float) -> bool:
        return loop.scaled(factor, factor).radius(delay) < 1

    return _last(stable, 1.0, MAX_GAIN) if stable(1.0) else 0.0


def delay_margin(loop: Loop) -> int:
    """The largest n for which the loop is stable behind 0 … n cycles."""
    for delay in range(MAX_DELAY + 1):
        if not loop.radius(delay) < 1:
            return delay - 1
    return MAX_DELAY


def _last(holds: Callable[[float], bool], low: float, high: float) -> float:
    """The largest value up to `high` at which `holds`, true at `low`, is still true."""
    if holds(high):
        return high
    for _ in range(GAIN_STEPS):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
