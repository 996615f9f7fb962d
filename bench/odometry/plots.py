"""Draws the odometry benchmark as pictures beside its table."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from robot_control.ui.picture_style import STYLE

from bench.odometry.consistency import ROLLING, SLIPPING
from bench.odometry.judge import Run
from bench.odometry.picture import Picture
from bench.odometry.promises import CALIBRATED, RAW, SIMPLE, runs_of
from bench.odometry.tested_estimator import OURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = {
    RAW: "#9a9a9a",
    CALIBRATED: "#2e8b57",
    "gyro, no bias": "#7d3c98",
    SIMPLE: "#1f5fa8",
    OURS: "#e07b00",
}
TRUE, SLIP = "black", "#c0392b"


def draw_all(runs: Sequence[Run], folder: Path) -> None:
    """Writes the pictures of all present runs: PNG, 110 dots per inch."""
    present = {run.scenario for run in runs}
    pictured = {run.scenario: run.picture for run in runs if run.picture is not None}
    with plt.style.context(STYLE):
        if "umbmark" in present:
            _save(_umbmark(runs_of(runs, "umbmark")), folder / "umbmark.png")
        if "slip" in pictured:
            _save(_slip(pictured["slip"]), folder / "slip.png")


def _save(figure: plt.Figure, path: Path) -> None:
    figure.savefig(path)
    plt.close(figure)


def _umbmark(runs: Sequence[Run]) -> plt.Figure:
    figure, (wide, narrow) = plt.subplots(1, 2, figsize=(14, 7.6), layout="constrained")
    _returns(wide, runs, (RAW, "gyro, no bias", SIMPLE, OURS), 1.0)
    _returns(narrow, runs, (SIMPLE, OURS), 1e3)
    wide.set_title("All methods")
    narrow.set_title("The two best, in millimetres")
    wide.set(xlabel="return error in x [m]", ylabel="return error in y [m]")
    narrow.set(xlabel="return error in x [mm]", ylabel="return error in y [mm]")
    _head(figure, f"UMBmark, square of 4 m: centres of gravity of five runs each way, {len(runs)} robots")
    return figure


def _returns(axes: Axes, runs: Sequence[Run], methods: Sequence[str], scale: float) -> None:
    for method in methods:
        means = np.array([run.returns[method].reshape(2, -1, 2).mean(axis=1) for run in runs]) * scale
        for direction, marker, size in ((0, "v", 42), (1, "o", 34)):
            axes.scatter(*means[:, direction].T, marker=marker, s=size, color=COLOURS[method], alpha=0.7, lw=0)
        axes.plot([], [], "s", color=COLOURS[method], label=method)
    for name, marker in (("clockwise", "v"), ("counter-clockwise", "o")):
        axes.plot([], [], marker, color="none", markeredgecolor="black", label=name)
    reach = 1.1 * max(abs(np.array([axes.get_xlim(), axes.get_ylim()])).max(), 1e-6)
    axes.axhline(0, color="black", linewidth=0.8)
    axes.axvline(0, color="black", linewidth=0.8)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_aspect("equal")
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=6, fontsize=10, columnspacing=1, handletextpad=0.2
    )


def _head(figure: plt.Figure, text: str) -> None:
    figure.suptitle(text, fontsize=14, fontweight="bold", x=0.01, ha="left")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1, wspace=0.03)


def _slip(picture: Picture) -> plt.Figure:
    figure = plt.figure(figsize=(16, 7.5), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1, 1.5))
    plan, ratio, error = (figure.add_subplot(grid[place]) for place in ((slice(None), 0), (0, 1), (1, 1)))
    for method in (CALIBRATED, SIMPLE):
        path = picture.paths[method]
        plan.plot(path.x, path.y, color=COLOURS[method], linewidth=1.2, label=method)
    plan.plot(picture.truth.x, picture.truth.y, color=TRUE, linewidth=2.2, label="true")
    plan.plot(picture.paths[OURS].x, picture.paths[OURS].y, color=COLOURS[OURS], linewidth=1.6, label=OURS)
    plan.plot(0, 0, "o", color=TRUE, markersize=7)
    plan.set_aspect("equal", adjustable="datalim")
    plan.set(xlabel="x [m]", ylabel="y [m]")
    plan.set_title("The way")
    plan.legend(loc="best")
    ratio.fill_between(
        picture.time,
        0,
        100,
        where=picture.flagged > 0,
        color=COLOURS[OURS],
        alpha=0.3,
        lw=0,
        step="mid",
        label="flagged",
    )
    slip = np.minimum(100 * picture.slip, 100)  # a wheel that turns against its way slips by up to twice that
    ratio.plot(picture.time, slip, color=SLIP, linewidth=1, label="true, the worse wheel")
    for bound in (SLIPPING, ROLLING):
        ratio.axhline(100 * bound, color="black", linewidth=0.8, linestyle=":")
    ratio.set(ylabel="slip [%]", ylim=(0, 125), yticks=range(0, 101, 20), xlim=(0, picture.time[-1]))
    ratio.set_title("Slip, and what is said of it")
    ratio.legend(loc="upper right", ncols=2)
    ratio.tick_params(labelbottom=False)
    error.fill_between(picture.time, 0, 2 * picture.deviation, color=COLOURS[OURS], alpha=0.18, lw=0, label="ours, 2 σ")
    for method in (CALIBRATED, SIMPLE, OURS):
        error.plot(picture.time, picture.error[method], color=COLOURS[method], linewidth=1.6, label=method)
    top = 1.1 * max(picture.error[method].max() for method in (CALIBRATED, SIMPLE, OURS))
    error.set(xlabel="time [s]", ylabel="position error [m]", xlim=(0, picture.time[-1]), ylim=(0, max(top, 0.01)))
    error.set_title("Position error")
    error.legend(loc="upper left")
    _head(figure, "A run with spinning and locked wheels")
    return figure
