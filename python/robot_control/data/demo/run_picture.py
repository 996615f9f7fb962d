"""A run as one picture: the path, the speeds, the torques; on legs the feet in place of the torques."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from robot_control.data.brakes import Brake
from robot_control.data.demo.run_summary import RunSummary
from robot_control.data.demo.tracking import ON_WHEELS, commanded_path
from robot_control.data.footfalls import Footfalls, footfalls_of
from robot_control.data.intervals import intervals
from robot_control.data.run_log import Log, joint_names
from robot_control.ui.picture_style import STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COMMANDED, TRUE, ESTIMATED, BRAKED = "#9a9a9a", "#1f5fa8", "#f2b366", "#c0392b"
ESTIMATED_PATH = "#e07b00"
"""dashed over the true one, which it covers"""
BRAKES_NAMED = 3
"""in the picture; the table and summary.json name all of them"""
JOINTS = ("#1f5fa8", "#c0392b", "#2e8b57", "#7d3c98")


def draw_run(log: Log, summary: RunSummary, title: str, path: Path) -> None:
    """Writes a PNG of 1760 × 990 pixels."""
    with plt.style.context(STYLE):
        figure = plt.figure(figsize=(16, 9), layout="constrained")
        figure.get_layout_engine().set(w_pad=0.12, h_pad=0.08)
        grid = figure.add_gridspec(3, 2, width_ratios=(1, 1.35))
        figure.suptitle(title, fontsize=15, fontweight="bold", x=0.01, ha="left")
        _draw_path(figure.add_subplot(grid[:, 0]), log, summary)
        linear = figure.add_subplot(grid[0, 1])
        angular = figure.add_subplot(grid[1, 1], sharex=linear)
        below = figure.add_subplot(grid[2, 1], sharex=linear)
        linear.set_xlim(float(log["time"][0]), float(log["time"][-1]))
        _draw_speed(linear, log, summary, "linear")
        _draw_speed(angular, log, summary, "angular")
        if summary.postures:
            _draw_feet(below, log, footfalls_of(log))
        else:
            _draw_torques(below, log)
        for axes in (linear, angular, below):
            _mark_brakes(axes, summary.brakes)
            axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=10)
        _name_brakes(linear, summary.brakes)
        for axes in (linear, angular):
            axes.tick_params(labelbottom=False)
        below.set_xlabel("time [s]")
        figure.savefig(path)
        plt.close(figure)


def _draw_path(axes: Axes, log: Log, summary: RunSummary) -> None:
    x, y, _ = commanded_path(log)
    axes.plot(x, y, color=COMMANDED, linewidth=5, alpha=0.5, label="commanded")
    axes.plot(log["truth_x"], log["truth_y"], color=TRUE, linewidth=2, label="true")
    estimated = log["estimate_x"], log["estimate_y"]
    axes.plot(*estimated, color=ESTIMATED_PATH, linewidth=2, linestyle=(0, (3, 2)), label="estimated")
    axes.plot(0, 0, "o", color="black", markersize=7)
    axes.annotate("start", (0, 0), xytext=(8, -14), textcoords="offset points")
    known = np.flatnonzero(~np.isnan(log["truth_x"]))
    if known.size:
        end = known[-1]
        yaw = float(log["truth_yaw"][end])
        marker = (3, 0, float(np.degrees(yaw)) - 90)
        axes.plot(log["truth_x"][end], log["truth_y"][end], marker=marker, color=TRUE, markersize=14, linestyle="none")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.set_title(_path_title(summary))
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.legend(loc="upper left")


def _path_title(summary: RunSummary) -> str:
    tracking = summary.tracking
    if tracking is None:
        return "Path"
    return f"Path: {tracking.distance:.2f} m, estimate off by {tracking.position_error * 1000:.1f} mm"


def _draw_speed(axes: Axes, log: Log, summary: RunSummary, component: str) -> None:
    name, unit = ("Speed", "m/s") if component == "linear" else ("Yaw rate", "rad/s")
    time = log["time"]
    axes.plot(time, log[f"requested_{component}"], color=COMMANDED, linewidth=1.2, linestyle=":", label="requested")
    limited = log[f"limited_{component}"].copy()
    for brake in summary.brakes:
        limited[(time >= brake.begin) & (time <= brake.end)] = np.nan  # which the brake leaves without effect
    axes.plot(time, limited, color=COMMANDED, linewidth=4, alpha=0.5, label="within limits")
    axes.plot(time, log[f"estimate_{component}"], color=ESTIMATED, linewidth=2, label="estimated")
    axes.plot(time, log[f"truth_{component}"], color=TRUE, linewidth=1.2, label="true")  # above the estimate's noise
    if summary.tracking is not None:
        tracking = summary.tracking
        axis = tracking.linear if component == "linear" else tracking.angular
        steady = [tracking.begin, tracking.end]
        if summary.postures:
            axes.plot(steady, [axis.truth] * 2, color="black", linewidth=2, linestyle="--", label="true mean, judged")
        else:
            share = ON_WHEELS.cycle or 0.0
            band = abs(axis.commanded) * share
            axes.fill_between(
                steady, axis.commanded - band, axis.commanded + band, color=TRUE, alpha=0.12, linewidth=0,
                label=f"±{share * 100:.0f} %, judged",
            )  # fmt: skip
    axes.set_title(name)
    axes.set_ylabel(f"{name.lower()} [{unit}]")


def _draw_torques(axes: Axes, log: Log) -> None:
    for joint, color in zip(joint_names(log), JOINTS, strict=False):
        name = joint.removesuffix("_joint").replace("_", " ")
        commanded = log[f"{joint}_effort_command"]
        axes.plot(log["time"], commanded, color=color, linewidth=5, alpha=0.3, label=f"{name}, commanded")
        measured = log[f"{joint}_effort"]
        if np.isfinite(measured).any():  # some drives measure no torque
            axes.plot(log["time"], measured, color=color, linewidth=1.2, label=f"{name}, actual")
    axes.set_title("Torque")
    axes.set_ylabel("torque [N·m]")


def _draw_feet(axes: Axes, log: Log, feet: list[Footfalls]) -> None:
    """A bar while a foot bears; a pale one while it was asked to."""
    time = log["time"]
    for row, foot in enumerate(reversed(feet)):
        for asked, true, color, half, name in (
            (True, foot.asked, COMMANDED, 0.42, "commanded stance"),
            (False, foot.bears, TRUE, 0.22, "bears"),
        ):
            spans = [(time[begin], time[end - 1] - time[begin]) for begin, end in intervals(true)]
            alpha = 0.5 if asked else 1.0
            axes.broken_barh(
                spans, (row - half, 2 * half), color=color, alpha=alpha, linewidth=0, label=None if row else name
            )
    axes.set_yticks(range(len(feet)), [foot.foot.replace("_", " ") for foot in reversed(feet)])
    axes.grid(visible=False, axis="y")
    axes.set_title("Feet")


def _mark_brakes(axes: Axes, brakes: tuple[Brake, ...]) -> None:
    """Marks a brake by a line and an area, because a brake of one cycle is narrower than a pixel."""
    for i, brake in enumerate(brakes):
        label = f"gate braked, {len(brakes)} ×" if i == 0 else None
        axes.axvspan(brake.begin, brake.end, color=BRAKED, alpha=0.25, linewidth=1.5, label=label)


def _name_brakes(axes: Axes, brakes: tuple[Brake, ...]) -> None:
    """Writes the names above the panel, where no curve is; the table names those that would overlap."""
    begin, end = axes.get_xlim()
    free = begin
    for brake in brakes[:BRAKES_NAMED]:
        text = f"{brake.begin:.2f} s: {brake.describe(1)}"
        width = (end - begin) * len(text) / 95  # of an axis of 95 such letters
        at = min(max(brake.begin, begin), end - width)
        if at < free:
            continue
        transform = axes.get_xaxis_transform()
        axes.text(at, 1.01, text, color=BRAKED, fontsize=9, va="bottom", transform=transform, clip_on=False)
        free = at + width
