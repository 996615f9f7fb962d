"""Draws an estimate as one picture: the path with its uncertainty, yaw, speeds, gyro bias, innovations and slip."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Ellipse
from scipy.ndimage import uniform_filter1d

from robot_control.data.intervals import intervals
from robot_control.loop.estimator import FLAGS, SENSORS, Estimate
from robot_control.ui.picture_style import STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from robot_control.data.estimate.samples import FloatArray, IntArray
    from robot_control.data.run_log import BoolArray

WHEELS, OURS, SLIP, ANGULAR = "#c4c4c4", "#1f5fa8", "#c0392b", "#e07b00"
AXES = (("x", "#c0392b"), ("y", "#2e8b57"), ("z", "#1f5fa8"))
POINTS = 4000
"""points of a curve; the picture is 1760 pixels wide"""
ELLIPSES = 14
NINETY_FIVE = 2.4477
"""Standard deviations of a circle that holds 95 % of a two-dimensional normal distribution: √(−2 ln 0.05)"""
DEGREES = 180 / np.pi
SMOOTH = 0.05
"""s over which drawn speeds are averaged; without it the counts of an encoder in one millisecond would hide them"""
MIN_NIS = 1e-3  # smallest innovation that is drawn; a sensor that agrees better does so by chance
UNDER = 5.0
"""points; width of a curve below the estimate, so that it stays visible on both sides"""


class Picture:
    """Gathers what will be drawn: curves of a few thousand points, and every row's slip."""

    def __init__(self, rows: int) -> None:
        self._every = max(1, rows // POINTS)
        self._count = 0
        self._parts: list[Estimate] = []
        self._slip: list[tuple[FloatArray, BoolArray]] = []

    def add(self, time_ns: IntArray, estimate: Estimate) -> None:
        """Adds rows."""
        chosen = np.arange(-self._count % self._every, time_ns.size, self._every)
        self._count += time_ns.size
        rows = dict(estimate)
        for name in ("linear", "angular"):
            rows[name] = _mean_of_neighbours(rows[name], time_ns)
        self._parts.append({name: values[chosen] for name, values in rows.items()})
        self._slip.append((estimate["time"], (estimate["flags"] & FLAGS["slip"]) != 0))

    def draw(self, path: Path, title: str) -> None:
        """Writes a picture of 1760 × 990 pixels, in the format that the name ends in."""
        rows = {name: np.concatenate([part[name] for part in self._parts]) for name in self._parts[0]}
        time, spans = rows["time"], self._spans()
        with plt.style.context(STYLE):
            figure = plt.figure(figsize=(16, 9), layout="constrained")
            figure.get_layout_engine().set(w_pad=0.12, h_pad=0.08)
            grid = figure.add_gridspec(4, 2, width_ratios=(1, 1.35), height_ratios=(1, 1, 1, 0.8))
            figure.suptitle(title, fontsize=15, fontweight="bold", x=0.01, ha="left")
            _draw_path(figure.add_subplot(grid[:, 0]), time, rows, spans)
            yaw = figure.add_subplot(grid[0, 1])
            speeds = figure.add_subplot(grid[1, 1], sharex=yaw)
            bias = figure.add_subplot(grid[2, 1], sharex=yaw)
            _draw_yaw(yaw, time, rows)
            _draw_speeds(speeds, time, rows)
            _draw_bias(bias, time, rows)
            innovations = figure.add_subplot(grid[3, 1], sharex=yaw)
            _draw_innovations(innovations, time, rows)
            for axes in (yaw, speeds, bias, innovations):
                for first, last in spans:
                    axes.axvspan(first, last, color=SLIP, alpha=0.15, linewidth=0)
            for axes in (yaw, speeds, bias):
                axes.tick_params(labelbottom=False)
            innovations.set_xlabel("time [s]")
            yaw.set_xlim(0, max(float(time[-1]), 1e-3))
            figure.savefig(path)
            plt.close(figure)

    def _spans(self) -> list[tuple[float, float]]:
        """Begin and end [s] of every stretch of slip."""
        time = np.concatenate([part[0] for part in self._slip])
        slip = np.concatenate([part[1] for part in self._slip])
        return [(float(time[begin]), float(time[end - 1])) for begin, end in intervals(slip)]


def _mean_of_neighbours(values: FloatArray, time_ns: IntArray) -> FloatArray:
    """Means over SMOOTH about each row of (rows, 3)."""
    step = float(np.median(np.diff(time_ns))) / 1e9 if time_ns.size > 1 else np.inf
    half = round(SMOOTH / 2 / step)
    if half < 1:
        return values
    return np.asarray(uniform_filter1d(values, 2 * half + 1, axis=0, mode="nearest"))


def _draw_path(axes: Axes, time: FloatArray, rows: Estimate, spans: list[tuple[float, float]]) -> None:
    axes.set_title("Path [m]")
    axes.plot(rows["wheel_x"], rows["wheel_y"], color=WHEELS, linewidth=UNDER, label="wheels alone")
    axes.plot(rows["x"], rows["y"], color=OURS, linewidth=1.6, label="estimate")
    half_axis = NINETY_FIVE * np.sqrt(np.linalg.eigvalsh(rows["pose_covariance"][-1, :2, :2])[1])  # m, of the last one
    for i, row in enumerate(_along(rows["distance"])):
        ellipse = _ellipse(rows["x"][row], rows["y"][row], rows["pose_covariance"][row, :2, :2])
        label = f"95 %, at the end ± {half_axis:.2g} m" if i == 0 else None  # which may be too small to see
        ellipse.set(edgecolor=OURS, facecolor=OURS, alpha=0.25, label=label)
        axes.add_patch(ellipse)
    for i, (first, last) in enumerate(spans):
        inside = (time >= first) & (time <= last)
        if not inside.any():
            inside[np.argmin(np.abs(time - first))] = True
        axes.plot(rows["x"][inside], rows["y"][inside], ".", color=SLIP, markersize=4, label="slip" if i == 0 else None)
    axes.plot(rows["x"][0], rows["y"][0], "o", color=OURS, markerfacecolor="white", markersize=7, label="begin")
    axes.plot(rows["x"][-1], rows["y"][-1], "s", color=OURS, markersize=6, label="end")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.05), ncols=3, markerscale=1.5)


def _along(distance: FloatArray) -> IntArray:
    """Rows that are spread evenly along the path, the last one included."""
    marks = np.linspace(distance[0], distance[-1], ELLIPSES + 1)[1:]
    return np.asarray(np.unique(np.minimum(np.searchsorted(distance, marks), distance.size - 1)))


def _ellipse(x: float, y: float, covariance: FloatArray) -> Ellipse:
    variances, axes = np.linalg.eigh(covariance)
    half = NINETY_FIVE * np.sqrt(np.maximum(variances, 0))
    angle = float(np.arctan2(axes[1, 1], axes[0, 1])) * DEGREES
    return Ellipse((x, y), 2 * half[1], 2 * half[0], angle=angle)


def _legend_above(axes: Axes) -> None:
    """Places the legend beside the title, where no curve can be."""
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3, borderaxespad=0.2)


def _draw_yaw(axes: Axes, time: FloatArray, rows: Estimate) -> None:
    axes.set_title("Yaw [°]")
    yaw = np.unwrap(rows["yaw"]) * DEGREES
    deviation = np.sqrt(np.maximum(rows["pose_covariance"][:, 5, 5], 0)) * DEGREES
    axes.plot(time, np.unwrap(rows["wheel_yaw"]) * DEGREES, color=WHEELS, linewidth=UNDER, label="wheels alone")
    axes.plot(time, yaw, color=OURS, linewidth=1.6, label="estimate")
    label = f"± 2 σ, at the end ± {2 * deviation[-1]:.2g}°"  # which may be too narrow to see
    axes.fill_between(time, yaw - 2 * deviation, yaw + 2 * deviation, color=OURS, alpha=0.2, linewidth=0, label=label)
    _legend_above(axes)


def _draw_speeds(axes: Axes, time: FloatArray, rows: Estimate) -> None:
    axes.set_title(f"Speeds [m/s], [rad/s], mean of {SMOOTH * 1000:.0f} ms")
    axes.plot(time, rows["linear"][:, 0], color=OURS, linewidth=1.4, label="forward [m/s]")
    axes.plot(time, rows["angular"][:, 2], color=ANGULAR, linewidth=1.4, label="turn [rad/s]")
    _legend_above(axes)


def _draw_bias(axes: Axes, time: FloatArray, rows: Estimate) -> None:
    axes.set_title("Gyro bias [°/s], IMU axes, ± 2 σ")
    if (rows["flags"] & FLAGS["no_gyro"] != 0).all():
        axes.set(yticks=[], ylim=(0, 1))
        axes.text(0.5, 0.5, "no gyro in the recording: yaw is computed from the wheels only", ha="center", va="center",
                  color="#666666", transform=axes.transAxes)  # fmt: skip
        return
    spread = 2 * float(np.median(rows["gyro_bias_deviation"])) * DEGREES + 0.02  # the first band would hide all else
    all_axes = rows["gyro_bias"] * DEGREES
    low, high = float(all_axes.min()) - 2 * spread, float(all_axes.max()) + 2 * spread
    axes.set_ylim(low, high)
    for i, (name, color) in enumerate(AXES):
        bias = rows["gyro_bias"][:, i] * DEGREES
        deviation = rows["gyro_bias_deviation"][:, i] * DEGREES
        known = 4 * deviation < high - low  # the bias is unknown before, and its band would not fit the panel
        axes.plot(time, np.where(known, bias, np.nan), color=color, linewidth=1.4, label=name)
        axes.fill_between(
            time, bias - 2 * deviation, bias + 2 * deviation, where=known, color=color, alpha=0.12, linewidth=0
        )
    _legend_above(axes)


def _draw_innovations(axes: Axes, time: FloatArray, rows: Estimate) -> None:
    axes.set_title("Innovations, squared over their variance: 1 is as expected")
    shown = False
    for i, name in enumerate(SENSORS):
        nis = np.where(rows["nis"][:, i] > 0, np.maximum(rows["nis"][:, i], MIN_NIS), np.nan)
        if not np.isnan(nis).all():
            axes.plot(time, nis, linewidth=1.2, label=name.replace("_", " "))
            shown = True
    if not shown:
        axes.set(yticks=[], ylim=(0, 1))
        axes.text(0.5, 0.5, "none", ha="center", va="center", color="#666666", transform=axes.transAxes)
        return
    axes.axhline(1, color="#666666", linewidth=0.8, linestyle=":")
    axes.set_yscale("log")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.42), ncols=6, fontsize="small", columnspacing=1.2)
