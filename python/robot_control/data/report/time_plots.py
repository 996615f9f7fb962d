"""Plots of values over time."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from robot_control.data.loop_timing import TO_COMMAND, durations_ns
from robot_control.data.report import style
from robot_control.data.report.decimate import decimated
from robot_control.data.report.drive import Drive
from robot_control.data.report.figures import position_error
from robot_control.data.run_log import FloatArray
from robot_control.files.files import printable
from robot_control.loop.estimator import SENSORS

Series = tuple[style.Line, FloatArray, FloatArray]
"""how it is drawn, time [s], values"""
UNITS = {"linear": "m/s", "angular": "rad/s"}
BEFORE, AFTER = 0.5, 1.5
"""s around an incident"""
OF_SENSORS = (style.BLUE, style.SKY, style.ORANGE, style.GREEN, style.PURPLE, style.GREY)


def line_plot(axis: style.TimeAxis, unit: str, series: Iterable[Series], **options: Any) -> Any:  # noqa: ANN401 (Bokeh's)
    """One plot of several series; None if there is nothing to draw."""
    known = [one for one in series if not np.all(np.isnan(one[2]))]
    if not known:
        return None
    plot = axis.plot(unit, **options)
    legend = []
    for line, time, values in known:
        x, y = decimated(time, values)
        drawn = plot.line(
            x, y.astype(np.float32), color=line.colour, line_width=line.width, line_dash=line.dash, alpha=line.alpha
        )
        style.with_values(plot, [drawn], [(line.label, "@y{0.0000}"), ("time", "@x{0.000} s")])
        legend.append((line.label, [drawn]))
    return style.with_legend(plot, legend)


def drawn(*made: Any) -> list[Any]:  # noqa: ANN401 (Bokeh's)
    """Those of the plots for which there was something to draw."""
    return [plot for plot in made if plot is not None]


def band(plot: Any, time: FloatArray, low: FloatArray, high: FloatArray, colour: str) -> None:  # noqa: ANN401
    """Fills the area between two series lightly."""
    known = ~np.isnan(low) & ~np.isnan(high)
    if not known.any():
        return
    x, lower = decimated(time[known], low[known])
    upper = np.interp(x, *decimated(time[known], high[known]))
    plot.varea(x, lower.astype(np.float32), upper.astype(np.float32), fill_color=colour, fill_alpha=0.15)


def _of(drive: Drive, number: int, count: int, lines: list[tuple[str, style.Line]]) -> list[Series]:
    """Columns of one of `count` drives; two drives show only the first and last of the lines, in the drive's colour."""
    if count == 1:
        return [(line, drive.time, drive.column(name)) for name, line in lines]
    colour = style.OF_DRIVES[number]
    looks = {lines[0]: (1.0, "dashed"), lines[-1]: (1.4, "solid")}
    return [
        (style.Line(f"{drive.name}: {line.label}", colour, width, dash), drive.time, drive.column(name))
        for (name, line), (width, dash) in looks.items()
    ]


def speeds(axis: style.TimeAxis, drives: list[Drive], which: str) -> Any:  # noqa: ANN401 (Bokeh's)
    """Requested, after limits, true, estimated; the limits themselves."""
    lines = [
        (f"limited_{which}", style.Line("after limits", style.ORANGE, 1.6)),
        (f"requested_{which}", style.Line("requested", style.GREY, 1.2, "dashed")),
        (f"truth_{which}", style.Line("true", style.INK, 1.0)),
        (f"estimate_{which}", style.Line("estimated", style.BLUE, 1.2)),
    ]
    series = [one for i, drive in enumerate(drives) for one in _of(drive, i, len(drives), lines)]
    if len(drives) == 1:
        drive = drives[0]
        limit = drive.column(f"max_{which}_speed")
        low = drive.column("min_linear_speed") if which == "linear" else -limit
        series += [(style.Line("limits", style.RED, 1.0, "dotted"), drive.time, each) for each in (limit, low)]
        if which == "linear" and not drive.kind.legged:
            series.append((style.Line("monitor's limit", style.PURPLE, 1.2), drive.time, drive.column("speed_limit")))
    return line_plot(axis, f"{which} [{UNITS[which]}]", series, height=240)


def tracking_error(axis: style.TimeAxis, drives: list[Drive], which: str) -> Any:  # noqa: ANN401 (Bokeh's)
    """Draws commanded minus estimated speed; with a single drive the band shows the estimate's standard deviation."""
    series = [
        (style.Line(drive.name if len(drives) > 1 else "after limits − estimated", style.OF_DRIVES[i]), drive.time,
         drive.column(f"limited_{which}") - drive.column(f"estimate_{which}"))
        for i, drive in enumerate(drives)
    ]  # fmt: skip
    ranges = [(float(np.nanmin(v)), float(np.nanmax(v))) for _, _, v in series if not np.all(np.isnan(v))]
    if not ranges:
        return None
    low, high = min(low for low, _ in ranges), max(high for _, high in ranges)
    margin = 0.1 * (high - low) or 0.01
    y_range = (low - margin, high + margin)
    plot = line_plot(axis, f"{which} [{UNITS[which]}]", series, height=180, y_range=y_range)
    if plot is not None and len(drives) == 1:
        twice = 2 * np.sqrt(np.maximum(drives[0].column(f"estimate_{which}_variance"), 0))
        band(plot, drives[0].time, np.maximum(-twice, y_range[0]), np.minimum(twice, y_range[1]), style.BLUE)
    return plot


def joint_plots(axis: style.TimeAxis, drives: list[Drive], columns: tuple[str, str], unit: str) -> list[Any]:
    """A plot per joint: commanded and measured."""
    plots = []
    for joint in drives[0].joints:
        lines = [
            (f"{joint}_{columns[0]}", style.Line("commanded", style.ORANGE, 1.6)),
            (f"{joint}_{columns[1]}", style.Line("measured", style.BLUE, 1.0)),
        ]
        series = [one for i, drive in enumerate(drives) for one in _of(drive, i, len(drives), lines)]
        plots.append(line_plot(axis, unit, series, height=200, title=printable(joint, 40)))
    return drawn(*plots)


def position_plot(axis: style.TimeAxis, drives: list[Drive]) -> Any:  # noqa: ANN401 (Bokeh's)
    """Standard deviation of the position, and the true error where there is a truth."""
    series: list[Series] = []
    for i, drive in enumerate(drives):
        error, deviation = position_error(drive)
        prefix = f"{drive.name}: " if len(drives) > 1 else ""
        colour = style.OF_DRIVES[i]
        series.append((style.Line(f"{prefix}2 σ of the estimate", colour, 1.4, "dashed"), drive.time, 2 * deviation))
        series.append(
            (style.Line(f"{prefix}true error", style.INK if len(drives) == 1 else colour, 1.2), drive.time, error)
        )
    return line_plot(axis, "position [m]", series, height=200)


def innovations(axis: style.TimeAxis, drive: Drive) -> list[Any]:
    """Normalised innovation squared and confidence of each sensor that the estimator uses."""
    sensors = [(sensor, colour) for sensor, colour in zip(SENSORS, OF_SENSORS, strict=True) if drive.uses(sensor)]
    lines = [(style.Line(sensor.replace("_", " "), colour, 1.1), sensor) for sensor, colour in sensors]
    nis = [(line, drive.time, np.maximum(drive.column(f"nis_{sensor}"), 1e-3)) for line, sensor in lines]
    confidence = [(line, drive.time, drive.column(f"confidence_{sensor}")) for line, sensor in lines]
    return drawn(
        line_plot(axis, "NIS", nis, height=220, y_axis_type="log"),
        line_plot(axis, "confidence", confidence, height=180, y_range=(-0.05, 1.05)),
    )


def close_up(drive: Drive, begin: float, title: str) -> Any:  # noqa: ANN401 (Bokeh's)
    """Speeds around an incident, every cycle."""
    rows = slice(*np.searchsorted(drive.time, (begin - BEFORE, begin + AFTER)).tolist())
    if drive.time[rows].size < 2:
        return None
    part = Drive(drive.name, {name: values[rows] for name, values in drive.log.items()})
    axis = style.TimeAxis(float(part.time[0]), float(part.time[-1]), [begin])
    series: list[Series] = []
    shown = (
        ("limited", "after limits", style.ORANGE),
        ("truth", "true", style.INK),
        ("estimate", "estimated", style.BLUE),
    )
    for which, dash in (("linear", "solid"), ("angular", "dashed")):
        for name, words, colour in shown:
            line = style.Line(f"{which} [{UNITS[which]}] {words}", colour, 1.4, dash)
            series.append((line, part.time, part.column(f"{name}_{which}")))
    return line_plot(axis, "speed", series, height=210, title=title)


def latency_plot(axis: style.TimeAxis, drives: list[Drive]) -> Any:  # noqa: ANN401 (Bokeh's)
    """Sensors to command, cycle by cycle."""
    series = [
        (style.Line(drive.name if len(drives) > 1 else "sensors to command", style.OF_DRIVES[i], 1.0), drive.time,
         durations_ns(drive.log, TO_COMMAND) / 1000)
        for i, drive in enumerate(drives)
    ]  # fmt: skip
    return line_plot(axis, "latency [µs]", series, height=200)
