"""Fits wheels and gyro of a recording to each other: the offset of their clocks, the wheel base, the sense of turning.

Both measure the turning. With W = right − left travel, ψ the integral of the gyro's rate about the vertical, s the way,

    ΔW(t) = B · Δψ(t + τ) + ρ · Δs + β · Δt        over blocks of BLOCK seconds between two readings of the wheels

The IMU's stamps are later than those of the wheels by τ. B is the effective wheel base, negative if the two turn
opposite ways. ρ is a difference of the radii, and β/B the gyro's bias. Huber's weights make the least squares robust.
The best of
a grid of τ, then Gauss–Newton steps with ∂ΔW/∂τ = B · Δω.
"""

from dataclasses import dataclass

import numpy as np

from robot_control.data.estimate.samples import FloatArray, IntArray

BLOCK = 0.2  # s
MAX_OFFSET, GRID = 0.5, 0.02  # s, of τ
STEPS = 8  # of Gauss–Newton
HUBER = 2.0  # standard deviations
FEWEST = 20  # blocks
ILL = 1e6  # condition number above which the drive does not determine the unknowns


@dataclass(frozen=True)
class TurnFit:
    """The result of the fit to the turning."""

    offset: float  # s, τ
    offset_deviation: float  # s
    wheel_base: float  # m, B
    explained: float  # share of the variance of ΔW


def fit_turning(
    wheel_time: FloatArray, left: FloatArray, right: FloatArray, gyro_time: FloatArray, yaw_rate: FloatArray
) -> TurnFit | None:
    """None if the drive is too short, or the robot does not turn.

    Args:
        wheel_time: (n,) s.
        left: (n,) m, travel.
        right: likewise.
        gyro_time: (m,) s.
        yaw_rate: (m,) rad/s, about the vertical, bias included.
    """
    if wheel_time.size < FEWEST or gyro_time.size < FEWEST:
        return None
    angle = np.concatenate([[0.0], np.cumsum(np.diff(gyro_time) * (yaw_rate[1:] + yaw_rate[:-1]) / 2)])
    reach = MAX_OFFSET + BLOCK
    inside = (wheel_time > gyro_time[0] + reach) & (wheel_time < gyro_time[-1] - reach)
    rows = _block_ends(wheel_time, np.flatnonzero(inside))
    if rows.size < FEWEST:
        return None
    travel, difference = (np.diff(table[rows]) for table in ((left + right) / 2, right - left))
    if np.ptp(difference) == 0:
        return None
    problem = _Problem(wheel_time[rows], travel, difference, gyro_time, np.column_stack([angle, yaw_rate]))
    costs = [problem.solve(offset)[1] for offset in _grid()]
    offset = float(_grid()[int(np.argmin(costs))])
    return problem.refined(offset)


def _grid() -> FloatArray:
    return np.arange(-MAX_OFFSET, MAX_OFFSET + GRID / 2, GRID)


def _block_ends(time: FloatArray, rows: IntArray) -> IntArray:
    """Those of `rows` that are at least BLOCK apart."""
    chosen: list[int] = []
    for row in rows.tolist():
        if not chosen or time[row] - time[chosen[-1]] >= BLOCK:
            chosen.append(row)
    return np.array(chosen, dtype=np.int64)


@dataclass(frozen=True)
class _Problem:
    time: FloatArray  # (b + 1,) s, ends of the blocks
    travel: FloatArray  # (b,) m, Δs
    difference: FloatArray  # (b,) m, ΔW
    gyro_time: FloatArray  # (m,) s
    turning: FloatArray  # (m, 2) ψ, ω

    def solve(self, offset: float) -> tuple[FloatArray, float]:
        """B, ρ, β and the cost at this τ."""
        columns = self._columns(offset)[:, :3]
        return self._weighted(columns)

    def refined(self, offset: float) -> TurnFit | None:
        """Gauss–Newton steps from `offset` on; None if they leave the grid or are not determined."""
        base = float(self.solve(offset)[0][0])
        for _ in range(STEPS):
            columns = self._columns(offset)
            columns[:, 3] *= base
            solution, _ = self._weighted(columns)
            base = float(solution[0])
            offset += float(np.clip(solution[3], -GRID, GRID))
        if abs(offset) > MAX_OFFSET:
            return None
        columns = self._columns(offset)
        columns[:, 3] *= base
        residuals = self.difference - columns[:, :3] @ solution[:3]
        variance = float(np.mean(self._weights(residuals) * residuals**2)) + 1e-18
        if np.linalg.cond(columns) > ILL:
            return None
        deviations = np.sqrt(variance * np.diagonal(np.linalg.inv(columns.T @ columns)))
        explained = 1 - float(np.mean(np.minimum(residuals**2, 9 * variance)) / np.var(self.difference))
        return TurnFit(offset, float(deviations[3]), base, explained)

    def _columns(self, offset: float) -> FloatArray:
        turned, faster = (np.diff(np.interp(self.time + offset, self.gyro_time, column)) for column in self.turning.T)
        return np.column_stack([turned, self.travel, np.diff(self.time), faster])

    def _weighted(self, columns: FloatArray) -> tuple[FloatArray, float]:
        weights = np.ones(self.difference.size)
        for _ in range(3):
            root = np.sqrt(weights)
            solution = np.linalg.lstsq(columns * root[:, None], self.difference * root, rcond=None)[0]
            residuals = self.difference - columns @ solution
            weights = self._weights(residuals)
        return solution, float(np.sum(weights * residuals**2))

    @staticmethod
    def _weights(residuals: FloatArray) -> FloatArray:
        scale = 1.4826 * float(np.median(np.abs(residuals))) + 1e-9
        return np.asarray(np.minimum(1.0, HUBER * scale / np.maximum(np.abs(residuals), 1e-12)))
