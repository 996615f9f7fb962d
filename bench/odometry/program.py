"""Velocity commands over time: one row (linear m/s, angular rad/s) per cycle of 1 ms."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

PERIOD = 0.001  # s, of the default rate
RAMP = 0.15  # s that the default jerk limits add to a ramp of v/a seconds

Array = NDArray[np.float64]


class Program:
    """Collects commands one after the other."""

    def __init__(self) -> None:
        self._parts: list[Array] = []
        self._cycles = 0

    @property
    def cycle(self) -> int:
        """Number of the next cycle."""
        return self._cycles

    @property
    def commands(self) -> Array:
        """(cycles, 2)"""
        return np.concatenate(self._parts)

    def drive(self, linear: float, angular: float, seconds: float) -> None:
        """Adds one command for `seconds`."""
        self._add(np.tile((linear, angular), (max(1, round(seconds / PERIOD)), 1)))

    def stand(self, seconds: float) -> None:
        """Adds a zero for `seconds`, which include the ramp to rest."""
        self.drive(0.0, 0.0, seconds)

    def ramp(self, linear: float, angular: float, acceleration: float) -> None:
        """Adds a linear ramp from the last command to this one, whatever the controller's limits are.

        A wheel 0.25 m beside the middle changes by at most `acceleration` m/s².
        """
        last = self._parts[-1][-1] if self._parts else np.zeros(2)
        change = abs(linear - last[0]) + 0.25 * abs(angular - last[1])
        cycles = max(1, round(change / acceleration / PERIOD))
        part = np.arange(1, cycles + 1)[:, None] / cycles
        self._add(last + part * (np.array([linear, angular]) - last))

    def ways(self, linear: float, metres: float, pause: float) -> None:
        """Drives straight on by `metres` as the wheels count them, then rests. The ramp down adds the way that the ramp
        up loses. So speed times seconds is exact under any limits that are equal both ways.
        """
        self.drive(linear, 0.0, metres / abs(linear))
        self.stand(abs(linear) / 1.0 + RAMP + pause)

    def turn(self, angular: float, angle: float, pause: float) -> None:
        """Turns on the spot by `angle` rad with the same exactness; `angular` rad/s has its sign."""
        self.drive(0.0, angular, abs(angle / angular))
        self.stand(abs(angular) / 4.0 + RAMP + pause)

    def _add(self, part: Array) -> None:
        self._parts.append(part)
        self._cycles += len(part)
