"""Fits inertia, friction and delay of a driven robot's wheels to a log of every cycle.

The law is that of wheel_law.py. The loop is closed and the angle quantised, so torque and motion share noise, and least
squares would be biased. The planned motion knows nothing of that noise: it is the instrument Z of θ = (ZᵀX)⁻¹Zᵀτ
(Söderström, Stoica, System Identification, ch. 8; for robots Janot, Vandanjon, Gautier, IEEE TCST 22(1), 2014).
Standard errors are those of blocks of BLOCK s, between which the residuals no longer know of each other.

The delay from command to measured torque, beyond that of the bus, is the shift at which both agree best. The delay from
measured torque to motion is the shift with the smallest residual.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robot_control.data.run_log import FloatArray, Log
from robot_control.setup.identify import wheel_law as law
from robot_control.setup.identify.rows import UnfitError, fit_rows

BLOCK = 0.5
"""s; three times the filter"""
SLOW_PACE = 0.1
"""Share of the RMS acceleration; below it a wheel cruises, and its tyre's elasticity and the angle's counts disturb
least."""
WEIGHINGS = 3
"""Rounds; the weights settle in two"""
BUS_LAG = 2
"""Cycles from a command to the sample of its torque: the command of cycle k acts over [t_k+1, t_k+2)."""
QUIET = 1e-9
"""RMS of a term, SI; below it, the term is not in the log"""
TINY = 1e-18
"""(N·m)²: the residual of an ideal machine is rounding, and counts for at least this"""
MAX_DELAY = 40
"""Cycles, searched"""
INERTIA_ERROR = 0.05
"""Largest standard error of an inertia, relative: what identification promises"""
LEFT_OVER = 0.2
"""Largest RMS of the residual over that of the torque; a robot on even ground has 1 … 7 %"""
FRICTION_ERROR = 0.05
"""Largest standard error of friction at the fastest speed, of the RMS torque"""
MIN_SECONDS = 2.0
"""s in motion; fewer blocks give no standard error"""


@dataclass(frozen=True)
class Estimate:
    """A value and its standard error, in the same unit."""

    value: float
    error: float

    def __format__(self, spec: str) -> str:
        """`0.0651 ± 0.0002`, both formatted by `spec`."""
        return f"{self.value:{spec}} ± {self.error:{spec}}"


@dataclass(frozen=True)
class SideFit:
    """The wheels of one side, mean over the side; about their own axles, forward positive."""

    joints: tuple[str, ...]
    straight: Estimate  # kg·m², inertia while driving straight
    turning: Estimate  # kg·m², while turning on the spot
    damping: Estimate  # N·m·s/rad
    friction: Estimate  # N·m, dry
    scrub: Estimate  # N·m, beyond friction while turning
    residual: float  # N·m RMS, residual of the law
    effort: float  # N·m RMS


@dataclass(frozen=True)
class Identification:
    """A robot's wheels, and the delay of its torque."""

    sides: tuple[SideFit, SideFit]  # left, right
    delay: Estimate  # cycles beyond the bus' one
    seconds: float  # s of motion that were used
    period: float  # s

    def mean(self, name: str) -> Estimate:
        """Mean over both sides of the field `name` of SideFit; the errors are those of independent sides."""
        values = [getattr(side, name) for side in self.sides]
        error = np.sqrt(sum(value.error**2 for value in values)) / len(values)
        return Estimate(float(np.mean([value.value for value in values])), float(error))


def identify(log: Log, base: law.Base) -> Identification:
    """Fits `log` (columns of run.bag or ClosedLoop.run).

    Raises:
        UnfitError: a log of another robot, of too little, of slipping, saturated or interrupted motion.
    """
    stretches, period = fit_rows(log, [wheel.joint for wheel in base.wheels])
    lag = _effort_lag(log, stretches, base)
    signals = [law.signals_of(log, rows, base, lag) for rows in stretches]
    width = max(2, round(law.WINDOW / period))
    signals = [one for one in signals if len(one.angle) > law.FILTERS * width + 2 * MAX_DELAY]
    _refuse_short(signals, base, period, width)
    shift = _motion_lag(signals, base, period, width)
    parts = [law.regression(one, base, period, width, max(0, round(shift.value))) for one in signals]
    delay = Estimate(max(0.0, lag - BUS_LAG + max(0.0, shift.value)), shift.error)
    left, right = (_fit_side(base, i, parts, period) for i in range(len(law.SIDES)))
    return Identification((left, right), delay, _seconds(parts, period), period)


def _seconds(parts: Sequence[law.Regression], period: float) -> float:
    return sum(len(part.torque) for part in parts) * period


def _refuse_short(signals: Sequence[law.Signals], base: law.Base, period: float, width: int) -> None:
    seconds = _seconds([law.regression(one, base, period, width, 0) for one in signals], period)
    if seconds < MIN_SECONDS:
        what = f"the wheels turn for {seconds:.1f} s without disturbance, of {MIN_SECONDS:g} s needed"
        raise UnfitError(f"{what}: drive longer and faster, with more space")


def _effort_lag(log: Log, stretches: Sequence[slice], base: law.Base) -> int:
    """Cycles from a commanded torque to the sample that shows it."""
    lags = np.arange(MAX_DELAY + BUS_LAG + 1)
    misses = np.zeros(len(lags))
    for rows in stretches:
        for wheel in base.wheels:
            # Differences remove what a drive changes evenly (a wrong torque constant, an offset), which moves no lag.
            command = np.diff(log[f"{wheel.joint}_effort_command"][rows])
            effort = np.diff(log[f"{wheel.joint}_effort"][rows])
            count = len(command) - int(lags[-1])
            if count > 0:
                misses += [float(np.sum((effort[lag : lag + count] - command[:count]) ** 2)) for lag in lags]
    return int(lags[np.argmin(misses)])


@dataclass(frozen=True)
class _Solution:
    values: FloatArray  # (terms,)
    errors: FloatArray
    residual: FloatArray  # (rows,), N·m


def _solve(parts: Sequence[law.Regression], side: int, block: int) -> _Solution:
    """Instrumental variables for one side; `block` rows. A term that is not in the log has value and error NaN.

    Cruising and accelerating rows are weighted by the inverse of their own residuals' variance. With equal weights the
    tyres' work in ramps would count as friction, 5 % of it.
    """
    torque = np.concatenate([part.torque[:, side] for part in parts])
    x = np.concatenate([part.regressors[:, side] for part in parts])
    z = np.concatenate([part.instruments[:, side] for part in parts])
    scale = np.sqrt(np.mean(z**2, axis=0))
    excited = scale > QUIET
    x, z = x[:, excited] / scale[excited], z[:, excited] / scale[excited]
    pace = np.hypot(z[:, 0], z[:, 1])
    slow = pace < SLOW_PACE * np.sqrt(np.mean(pace**2))
    weight = np.ones(len(torque))
    for _ in range(WEIGHINGS):
        weighted = z * weight[:, None]
        inverse = np.linalg.pinv(weighted.T @ x)
        theta = inverse @ (weighted.T @ torque)
        residual = torque - x @ theta
        for rows in (slow, ~slow):
            weight[rows] = 1 / max(float(np.mean(residual[rows] ** 2)), TINY) if rows.any() else 1.0
        weight /= weight.mean()
    scores = weighted * residual[:, None]
    sums = np.add.reduceat(scores, np.arange(0, len(scores), block), axis=0)
    variances = np.diag(inverse @ (sums.T @ sums) @ inverse.T)
    errors = np.sqrt(np.where(variances >= 0, variances, np.nan))  # rounding may be negative
    values, spread = np.full(len(law.TERMS), np.nan), np.full(len(law.TERMS), np.nan)
    values[excited], spread[excited] = theta / scale[excited], errors / scale[excited]
    return _Solution(values, spread, residual)


def _motion_lag(signals: Sequence[law.Signals], base: law.Base, period: float, width: int) -> Estimate:
    """Cycles from measured torque to motion: the shift with the smallest residual, interpolated by a parabola."""

    def left_over(shift: int) -> float:
        parts = [law.regression(one, base, period, width, shift) for one in signals]
        residuals = [_solve(parts, i, round(BLOCK / period)).residual for i in range(len(law.SIDES))]
        return float(np.mean([np.mean(residual**2) for residual in residuals]))

    left = {shift: left_over(shift) for shift in (-2, -1, 0, 1, 2)}
    while (best := min(left, key=left.__getitem__)) == max(left) and best < MAX_DELAY:
        left[best + 1] = left_over(best + 1)
    best = max(best, min(left) + 1)
    if best + 1 not in left:
        left[best + 1] = left_over(best + 1)
    low, middle, high = left[best - 1], left[best], left[best + 1]
    bend = low - 2 * middle + high
    rows = (
        sum(len(one.angle) for one in signals) * len(law.SIDES) / (law.FILTERS * width)
    )  # number of independent values
    if not bend > 0:
        return Estimate(float(best), float("inf"))
    return Estimate(best + (low - high) / (2 * bend), float(np.sqrt(2 * middle / (bend * rows))))


def _fit_side(base: law.Base, side: int, parts: Sequence[law.Regression], period: float) -> SideFit:
    solution = _solve(parts, side, round(BLOCK / period))
    torque = np.concatenate([part.torque[:, side] for part in parts])
    effort = float(np.sqrt(np.mean(torque**2)))
    fastest = float(
        np.abs(np.concatenate([part.regressors[:, side, law.TERMS.index("damping")] for part in parts])).max()
    )
    found = {
        name: Estimate(float(value), float(error))
        for name, value, error in zip(law.TERMS, solution.values, solution.errors, strict=True)
    }
    joints = tuple(wheel.joint for wheel in base.beside(law.SIDES[side]))
    named = ", ".join(joints)
    left_over = float(np.sqrt(np.mean(solution.residual**2)))
    if left_over > LEFT_OVER * effort:
        raise UnfitError(
            f"{named}: torque and motion do not fit: {left_over:.3g} N·m of {effort:.3g} N·m RMS remain, "
            f"allowed are {LEFT_OVER:.0%}. Drive slower, on even and firm ground, without obstacles"
        )
    for name, remedy in (("straight", "ramps forwards and back"), ("turning", "turns on the spot, both ways")):
        inertia = found[name]
        if not np.isfinite(inertia.value) or not np.isfinite(inertia.error):
            what = f"{named}: the inertia {name} cannot be determined from this log"
            raise UnfitError(f"{what}: it contains no {remedy}. identify.py without --log drives them")
        if not inertia.error < INERTIA_ERROR * abs(inertia.value):
            raise UnfitError(
                f"{named}: the inertia {name} is {inertia:.3g} kg·m², its standard error must be below "
                f"{INERTIA_ERROR:.0%}. The log contains too little of it; drive more {remedy}, faster or longer"
            )
        if inertia.value <= 0:
            both = found["straight"].value <= 0 and found["turning"].value <= 0
            cause = (
                "torque and motion contradict each other; check that the joint's effort has the sign of its motion"
                if both
                else f"the log contains too little of it; drive more {remedy}, faster or longer"
            )
            raise UnfitError(f"{named}: the inertia {name} comes out as {inertia:.3g} kg·m², must be > 0: {cause}")
    friction = max(found["damping"].error * fastest, found["friction"].error)
    if not np.isfinite(friction):
        what = f"{named}: the friction cannot be determined from this log: drive at several speeds, both ways"
        raise UnfitError(f"{what}; identify.py without --log does")
    if not friction < max(FRICTION_ERROR * effort, 1e-9):
        raise UnfitError(
            f"{named}: the friction is known to {friction:.2g} N·m, {FRICTION_ERROR:.0%} of the RMS torque "
            f"{effort:.2g} N·m are needed. Drive at several speeds, both ways, longer"
        )
    names = ("straight", "turning", "damping", "friction", "scrub")
    return SideFit(joints, **{name: found[name] for name in names}, residual=left_over, effort=effort)
