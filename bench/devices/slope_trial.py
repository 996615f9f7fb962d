"""The cable of a robot that stands on 5° is taken out: what do its drives do by themselves?"""

from __future__ import annotations

import numpy as np
from robot_control import ClosedLoop
from robot_control.installed_files import share_file

from bench.devices.loss_trial import SPEED

ROLLS = {"odrive": (0.3, 2.0), "cia402": (0.0, 0.02), "vesc": (0.3, 2.0)}
"""m in `SILENCE`: an ODrive and a VESC release their motors, so that the robot rolls; a CiA 402 drive brakes and holds.
A body that slides down without friction reaches ½·g·sin 5°·t² = 1.7 m."""
SILENCE = 2.0  # s


def rolled(dialect: str, seed: int) -> float:
    """m that the robot moves in `SILENCE` after the cable is out."""
    loop = ClosedLoop(
        seed=seed, scene=share_file("urdf/scenes/slope_5deg.xml"), drives=share_file(f"config/drives/{dialect}.yaml")
    )
    loop.run(1.0 + 0.01 * (seed % 50), (SPEED / 2, 0.0))
    before = loop.run(2.0, (0.0, 0.0))
    loop.inject_fault("bus", "off")
    after = loop.run(SILENCE)
    return float(np.hypot(*(after[f"truth_{axis}"][-1] - before[f"truth_{axis}"][-1] for axis in "xy")))


def as_stated(trial: tuple[str, int]) -> bool:
    """True if that is what docs/drivers.md states; `trial` is (dialect, seed)."""
    least, most = ROLLS[trial[0]]
    return least <= rolled(*trial) <= most
