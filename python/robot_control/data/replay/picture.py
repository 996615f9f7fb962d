"""Draws the recorded results of the laws and those of the replay in one picture."""

from collections.abc import Mapping
from pathlib import Path

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

from robot_control.ui.picture_style import STYLE

mpl.use("Agg")
from matplotlib import pyplot as plt

Pairs = Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64]]]
UNITS = {"estimate_x": "m", "estimate_y": "m", "supervisor_state": ""}
UNITS |= dict.fromkeys(("estimate_linear", "limited_linear"), "m/s")
UNITS |= dict.fromkeys(("estimate_angular", "limited_angular"), "rad/s")


def draw(columns: Pairs, period: float, path: Path) -> None:
    """One panel per column that is not the same in both; `period` in s."""
    changed = [name for name, (was, would) in columns.items() if not np.array_equal(was, would, equal_nan=True)]
    shown = changed or list(columns)[:1]
    with plt.style.context(STYLE):
        figsize = (10, 1 + 2 * len(shown))
        figure, panels = plt.subplots(len(shown), squeeze=False, sharex=True, figsize=figsize, layout="constrained")
        for panel, name in zip(panels[:, 0], shown, strict=True):
            was, would = columns[name]
            time = np.arange(len(was)) * period
            panel.plot(time, was, label="logged")
            panel.plot(time, would, "--", label="with these parameters")
            panel.set_title(f"{name} [{UNITS.get(name, 'N·m')}]".replace(" []", ""))
        panels[0, 0].legend(loc="upper right")
        panels[-1, 0].set_xlabel("s of the log")
        if not changed:
            panels[0, 0].set_title("no column differs")
        figure.savefig(path)
        plt.close(figure)
