"""A long walk of quadbot behind simulated drives on a disturbed bus or line, in virtual time.

Figures are the stops that latched, the longest gap between two samples, and the error of the odometry.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from robot_control.loop.drives import DRIVES
from robot_control.loop.signal_names import causes_in

from bench.devices.disturbed_drive import SEGMENT, rms, travel
from bench.devices.walk_loss import CAN_RATE, KNEE, SPEED, walker_behind

HOLD = 4  # cycles without a sample, beyond what the gate holds a command
COLUMNS = (
    "permit_causes",
    f"{KNEE}_age",
    *(f"{of}_{axis}" for of in ("truth", "estimate") for axis in ("x", "y", "yaw")),
)


@dataclass(frozen=True)
class DisturbedWalk:
    """A walk of `seconds` behind drives on a bus or line in this state (ok, lossy, disturbed)."""

    drive: str
    state: str
    seconds: float
    seed: int
    can_rate: float = CAN_RATE


@dataclass(frozen=True)
class WalkFigures:
    """Causes that latched and s until the first one; gaps beyond the hold and the longest one in s; RMS of the
    odometry's error per segment in m.
    """

    causes: tuple[str, ...]
    walked: float
    gaps: int
    longest: float
    odometry: float


def run_walk(walk: DisturbedWalk) -> WalkFigures:
    """Runs one walk, until a stop latches."""
    loop = walker_behind(walk.drive, walk.seed, walk.can_rate)
    loop.run(1.0)
    loop.inject_fault("bus" if DRIVES[walk.drive].driver == "can" else "line", walk.state)
    causes: list[str] = []
    walked, gaps, longest, errors = 0.0, 0, 0.0, []
    while walked < walk.seconds and not causes:
        log = loop.run(SEGMENT, (SPEED, 0.0), COLUMNS)
        causes = causes_in(log["permit_causes"])
        walked += SEGMENT
        age = log[f"{KNEE}_age"]
        gaps += int(np.sum(np.diff((age > (HOLD - 0.5) * loop.period).astype(int)) > 0))
        longest = max(longest, float(age.max()))
        errors.append(float(np.linalg.norm(travel(log, "estimate") - travel(log, "truth"))))
    return WalkFigures(tuple(causes), walked, gaps, longest, rms(errors))


def together(walks: Sequence[WalkFigures]) -> WalkFigures:
    """The figures of equally long walks as one."""
    causes = tuple(cause for walk in walks for cause in walk.causes)
    return WalkFigures(
        causes,
        sum(walk.walked for walk in walks),
        sum(walk.gaps for walk in walks),
        max(walk.longest for walk in walks),
        rms([walk.odometry for walk in walks]),
    )
