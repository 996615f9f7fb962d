"""The names of StopCause bits in a column of a log."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_control.common.signal_names import bits_in


def causes_in(column: NDArray[np.float64]) -> list[str]:
    """Names of all bits that were ever set in it, lowest first; a NaN, which stands for no message, has none."""
    found = int(np.bitwise_or.reduce(column[~np.isnan(column)].astype(np.int64), initial=0))
    return [cause.name for cause in bits_in("StopCause", found)]
