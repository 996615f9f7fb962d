"""A walk in figures: when the feet bore, and what the way cost."""

import numpy as np

from robot_control.data.footfalls import footfalls_of
from robot_control.data.intervals import intervals
from robot_control.data.report.drive import Drive
from robot_control.data.run_log import FloatArray
from robot_control.loop.signal_names import number_of

GRAVITY = 9.81
"""m/s²"""
WALKING = number_of("LegPhase", "walking")
SHORTEST = 1.0
"""m; a shorter way costs nothing that could be judged"""
BEARS, UNASKED, MISSING = "bears", "in stance, but not commanded", "commanded stance, but not in stance"
Stretch = tuple[str, int, int, str]
"""foot, first row of the log, the row behind the last one, what it did"""


def footfalls(drive: Drive) -> list[Stretch]:
    """The diagram of the feet; empty on wheels."""
    return [
        (foot.foot.replace("_", " "), begin, end, words)
        for foot in footfalls_of(drive.log)
        for true, words in (
            (foot.bears & foot.asked, BEARS),
            (foot.bears & ~foot.asked, UNASKED),
            (~foot.bears & foot.asked, MISSING),
        )
        for begin, end in intervals(true)
    ]


def phase_steps(drive: Drive) -> FloatArray:
    """By how much of its period the gait went on since the row before; 0 where no foot swings, and on wheels."""
    phase = np.nan_to_num(drive.column("legged_gait_phase"))
    return np.asarray(np.mod(np.diff(phase, prepend=phase[0]), 1.0))


def walked_speed(drive: Drive) -> FloatArray:
    """m/s to the front: the command after limits. While the feet swing it passes the low pass of half a period that the
    target of a walk has (control/legged/walk/walker.h).
    """
    speed, parts = drive.column("limited_linear").copy(), np.minimum(1.0, 2 * phase_steps(drive))
    for row in np.flatnonzero(parts):
        before = speed[row - 1]
        if not np.isnan(before):
            speed[row] = before + parts[row] * (speed[row] - before)
    return speed


def cost_of_transport(drive: Drive) -> float:
    """Σ|τ·ω|·Δt / (m·g·way) of all joints while it walks: their mechanical work, without the losses of the motors. NaN
    where mass or way is not known.
    """
    walks = drive.column("legged_phase") == WALKING
    distance = drive.column("estimate_distance")
    way = float(np.nansum(np.diff(distance, prepend=distance[0])[walks]))
    power = np.zeros_like(drive.time)
    for joint in drive.joints:
        power += np.abs(np.nan_to_num(drive.column(f"{joint}_effort") * drive.column(f"{joint}_velocity")))
    if not way > SHORTEST:
        return float("nan")
    return float(np.sum(power[walks])) * drive.period / (drive.mass * GRAVITY * way)
