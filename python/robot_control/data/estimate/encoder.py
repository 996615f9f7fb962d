"""Measures how fine the wheel angles of a recording are."""

import numpy as np

from robot_control.data.estimate.samples import FloatArray, Samples

FINE = 4096 / 1.5
"""counts a turn of the default encoder_noise; a finer encoder makes little difference to it"""
MIN_STEPS, MAX_COUNTS = 20, 20  # number of steps that suffice for a judgement, and the largest one in counts
KINDS = 2
"""number of different steps that are needed; a single one may be a steady speed"""


def counts_per_turn(samples: Samples) -> float | None:
    """Counts per turn of an encoder that is coarser than the default; None if it is not, or the data do not show it."""
    steps = [_step(np.diff(column[~np.isnan(column)])) for column in _columns(samples)]
    known = [step for step in steps if step is not None]
    counts = 2 * np.pi / max(known) if known else np.inf
    return float(counts) if counts < FINE else None


def _columns(samples: Samples) -> list[FloatArray]:
    return [column for table in (samples.left, samples.right) for column in np.atleast_2d(table.T)]


def _step(differences: FloatArray) -> float | None:
    """The unit [rad] of which all small differences are multiples."""
    sizes = np.abs(differences[differences != 0])
    if sizes.size < MIN_STEPS:
        return None
    unit = float(sizes[sizes < 1.5 * sizes.min()].mean())
    multiples = sizes[sizes < (MAX_COUNTS + 0.5) * unit] / unit
    whole = np.round(multiples)
    if multiples.size < MIN_STEPS or np.mean(np.abs(multiples - whole) < 0.05) < 0.98 or np.unique(whole).size < KINDS:
        return None
    return unit
