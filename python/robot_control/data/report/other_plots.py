"""The path, the time lines of states and reasons, the histograms."""

from typing import Any

import numpy as np
from bokeh.models import ColumnDataSource, FactorRange

from robot_control.data.intervals import intervals, joined, runs_of
from robot_control.data.loop_timing import LATENCIES, durations_ns
from robot_control.data.report import style
from robot_control.data.report.decimate import BINS
from robot_control.data.report.drive import Drive
from robot_control.data.report.figures import true_path
from robot_control.data.report.incidents import Incident
from robot_control.data.report.walking import BEARS, MISSING, UNASKED, footfalls
from robot_control.data.run_log import FloatArray
from robot_control.loop import signal_names as names

ELLIPSES = 40
"""along the path, at equal distances"""
PATH_POINTS = 6000
CHI_SQUARE_95 = 5.991
"""of two axes"""
HISTOGRAM_BINS = 80

ROWS = (
    ("permit_causes", "StopCause", "stopped by", style.RED),
    ("permit_warnings", "StopCause", "warning", style.ORANGE),
    ("faults", "DriverFault", "driver fault", style.RED),
    ("gate_reasons", "GateReason", "gate", style.PURPLE),
    ("command_reasons", "CommandReason", "command", style.BLUE),
    ("estimate_slip", "SlipReason", "slip", style.ORANGE),
    ("estimate_flags", "StateFlag", "estimate", style.SKY),
)
"""columns of bits: kind of name, word before it, colour"""
STATE_ROWS = ("state", "permit", "gate verdict", "posture")
WORD_WIDTH = 0.07
"""share of the run; a shorter bar has no word in it"""
ORDINARY = {"valid"}
"""bits that are set in normal operation"""
ACTIONS = {"brake": style.RED, "ramp": style.ORANGE, "drive": style.GREEN}
FEET = {BEARS: style.BLUE, UNASKED: style.ORANGE, MISSING: style.GREY}
POSTURES = {"lying": style.GREY, "standing": style.SKY, "walking": style.GREEN}
VERDICTS = ACTIONS | {"passed": style.GREEN, "held": style.ORANGE, "clamped": style.PURPLE}


def path_plot(drives: list[Drive], found: list[Incident]) -> Any:  # noqa: ANN401 (Bokeh's)
    """Seen from above: paths, covariance ellipses, places of stops and brakes."""
    tools = "pan,box_zoom,wheel_zoom,reset,save"
    plot = style.framed(height=460, match_aspect=True, tools=tools, x_axis_label="x [m]", y_axis_label="y [m]")
    legend = []
    for i, drive in enumerate(drives):
        prefix = f"{drive.name}: " if len(drives) > 1 else ""
        colour = style.OF_DRIVES[i]
        x, y = drive.column("estimate_x"), drive.column("estimate_y")
        if len(drives) == 1 and not drive.kind.legged:
            wheels = drive.column("wheel_odom_x"), drive.column("wheel_odom_y")
            legend.append(("wheels alone", _path(plot, *wheels, style.Line("", style.GREY, 1.0, "dotted"))))
        if len(drives) == 1:
            legend.append(("true", _path(plot, *true_path(drive), style.Line("", style.INK, 1.2, "dashed"))))
        legend.append((f"{prefix}estimated", _path(plot, x, y, style.Line("", colour, 2.0))))
        legend.append((f"{prefix}95 % of the estimate", _ellipses(plot, drive, colour)))
    drive = drives[0]
    if len(drives) == 1:
        legend.append(("begin", [plot.scatter(*_first(drive), size=11, marker="circle", color=style.GREEN)]))
        marks = [one for one in found if one.severity <= 1]
        rows = np.searchsorted(drive.time, [one.begin for one in marks]).clip(0, drive.time.size - 1)
        if marks:
            source = ColumnDataSource({
                "x": drive.column("estimate_x")[rows], "y": drive.column("estimate_y")[rows],
                "what": [f"{one.kind}: {one.title}" for one in marks], "at": [one.begin for one in marks],
            })  # fmt: skip
            shown = plot.scatter("x", "y", source=source, size=13, marker="inverted_triangle", color=style.RED)
            style.with_values(plot, [shown], [("", "@what"), ("time", "@at{0.00} s")])
            legend.append(("stops and brakes", [shown]))
    return style.with_legend(plot, [(label, drawn) for label, drawn in legend if drawn])


def _first(drive: Drive) -> tuple[list[float], list[float]]:
    known = np.flatnonzero(~np.isnan(drive.column("estimate_x")))[:1]
    return drive.column("estimate_x")[known].tolist(), drive.column("estimate_y")[known].tolist()


def _path(plot: Any, x: FloatArray, y: FloatArray, look: style.Line) -> list[Any]:  # noqa: ANN401 (Bokeh's)
    if np.all(np.isnan(x)):
        return []
    distance = np.concatenate([[0.0], np.cumsum(np.hypot(np.nan_to_num(np.diff(x)), np.nan_to_num(np.diff(y))))])
    step = max(float(distance[-1]) / PATH_POINTS, 1e-9)
    ticks = np.floor(distance / step)
    kept = np.concatenate([[True], np.diff(ticks) > 0])
    kept[-1] = True
    return [plot.line(x[kept].astype(np.float32), y[kept].astype(np.float32), color=look.colour, line_width=look.width,
                      line_dash=look.dash)]  # fmt: skip


def _ellipses(plot: Any, drive: Drive, colour: str) -> list[Any]:  # noqa: ANN401 (Bokeh's)
    """Ellipses of 95 %, from the eigenvalues of the covariance of x and y."""
    columns = ("estimate_x", "estimate_y", "estimate_x_variance", "estimate_y_variance", "estimate_xy_covariance")
    table = np.column_stack([drive.column(name) for name in columns])
    distance = drive.column("estimate_distance")
    known = np.flatnonzero(~np.isnan(table).any(axis=1) & ~np.isnan(distance))
    if known.size == 0:
        return []
    places = np.linspace(distance[known[0]], distance[known[-1]], ELLIPSES)
    rows = np.unique(known[np.searchsorted(distance[known], places).clip(0, known.size - 1)])
    x, y, xx, yy, xy = table[rows].T
    middle, difference = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    half = [np.sqrt(CHI_SQUARE_95 * np.maximum(value, 0)) for value in (middle + difference, middle - difference)]
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    around = np.linspace(0, 2 * np.pi, 49)[:, np.newaxis]
    along, across = half[0] * np.cos(around), half[1] * np.sin(around)
    xs = x + along * np.cos(angle) - across * np.sin(angle)
    ys = y + along * np.sin(angle) + across * np.cos(angle)
    return [plot.patches(xs.T.tolist(), ys.T.tolist(), fill_color=colour, fill_alpha=0.12, line_color=colour,
                         line_alpha=0.5)]  # fmt: skip


def time_lines(axis: style.TimeAxis, drive: Drive) -> Any:  # noqa: ANN401 (Bokeh's)
    """Draws a bar per state and per reason, as long as it lasted."""
    bars: list[tuple[str, int, int, str, str]] = []  # row of the plot, first row of the log, end, colour, words
    order: list[str] = []
    for column, kind, label, colours in (
        ("supervisor_state", "SupervisorState", STATE_ROWS[0], style.STATES),
        ("permit_action", "PermitAction", STATE_ROWS[1], ACTIONS),
        ("gate_verdict", "GateVerdict", STATE_ROWS[2], VERDICTS),
        *([("legged_phase", "LegPhase", STATE_ROWS[3], POSTURES)] if drive.kind.legged else []),
    ):
        known = names.states(kind)
        found = runs_of(drive.column(column))
        if found:
            order.append(label)
        for begin, end, code in _thinned(found, drive.time.size):
            word = known[code] if code < len(known) else f"{code}"
            bars.append((label, begin, end, colours.get(word, style.GREY), word))
    gap = max(1, drive.time.size // BINS)
    for column, kind, label, colour in ROWS:
        values = drive.bits(column)
        present = int(np.bitwise_or.reduce(values, initial=0))
        for number in range(present.bit_length()):
            bit = names.bit(kind, number)
            if not present >> number & 1 or bit.name in ORDINARY:
                continue
            order.append(f"{label}: {bit.name}")
            bars += [
                (order[-1], begin, end, colour, drive.kind.worded(bit.sentence))
                for begin, end in joined(intervals(values >> number & 1 != 0), gap)
            ]
    if not bars:
        return None
    return _bars(axis, drive, order, bars)


def foot_lines(axis: style.TimeAxis, drive: Drive) -> Any:  # noqa: ANN401 (Bokeh's)
    """Draws a bar for each time that a foot bore, or was asked to; None on wheels."""
    found = footfalls(drive)
    bars = [(foot, begin, end, FEET[words], words) for foot, begin, end, words in found]
    return _bars(axis, drive, list(dict.fromkeys(foot for foot, *_ in found)), bars) if bars else None


def _thinned(found: list[tuple[int, int, int]], rows: int) -> list[tuple[int, int, int]]:
    """Keeps of the changes within one pixel those that last longest."""
    if len(found) <= 2 * BINS:
        return found
    kept: dict[int, tuple[int, int, int]] = {}
    for one in found:
        pixel = one[0] * BINS // rows
        if pixel not in kept or one[1] - one[0] > kept[pixel][1] - kept[pixel][0]:
            kept[pixel] = one
    return list(kept.values())


def _bars(axis: style.TimeAxis, drive: Drive, order: list[str], bars: list[tuple[str, int, int, str, str]]) -> Any:  # noqa: ANN401
    plot = axis.plot("", height=70 + 22 * len(order), y_range=FactorRange(*reversed(order)))
    plot.ygrid.grid_line_color = None
    last = drive.time.size - 1
    left = np.array([drive.time[begin] for _, begin, _, _, _ in bars])
    right = np.array([drive.time[min(end, last)] for _, _, end, _, _ in bars])
    source = ColumnDataSource({
        "row": [bar[0] for bar in bars], "left": left, "right": right, "colour": [bar[3] for bar in bars],
        "words": [bar[4] for bar in bars], "lasts": right - left,
    })  # fmt: skip
    drawn = plot.hbar(y="row", left="left", right="right", height=0.72, color="colour", line_width=0.6, source=source)
    wide = np.flatnonzero((right - left > WORD_WIDTH * (drive.time[-1] - drive.time[0]))
                          & [bar[0] in STATE_ROWS for bar in bars])  # fmt: skip
    plot.text(
        x=(left[wide] + right[wide]) / 2, y=[bars[i][0] for i in wide], text=[bars[i][4] for i in wide],
        text_color="white", text_font={"value": style.FONT}, text_font_size="11px",
        text_align="center", text_baseline="middle",
    )  # fmt: skip
    style.with_values(plot, [drawn], [("@row", "@words"), ("from", "@left{0.000} s"), ("for", "@lasts{0.000} s")])
    return plot


def histograms(drives: list[Drive]) -> list[Any]:
    """Histograms of each latency; the counts have a logarithmic axis, because the rare ones matter."""
    plots = []
    for latency in LATENCIES:
        found = [durations_ns(drive.log, latency) / 1000 for drive in drives]
        known = [values[~np.isnan(values)] for values in found]
        if all(values.size > 0 for values in known):
            plots.append(_histogram(latency.name.replace("_", " "), known))
    return plots


def _histogram(name: str, found: list[FloatArray]) -> Any:  # noqa: ANN401 (Bokeh's)
    low = min(float(values.min()) for values in found)
    high = max(float(values.max()) for values in found)
    edges = np.linspace(low, high if high > low else low + 1, HISTOGRAM_BINS + 1)
    shares = [np.percentile(values, [50, 99, 100]) for values in found]
    words = "  ·  ".join(f"p50 {p50:.0f}  p99 {p99:.0f}  max {top:.0f} µs" for p50, p99, top in shares)
    plot = style.framed(
        height=200, tools="xpan,xbox_zoom,reset,save", y_axis_type="log", x_axis_label="µs", y_axis_label="cycles",
        title=f"{name}:  {words}", name="half",
    )  # fmt: skip
    plot.title.text_font_size = "12px"
    plot.title.text_font_style = "normal"
    for i, values in enumerate(found):
        counts, _ = np.histogram(values, edges)
        source = ColumnDataSource({
            "left": edges[:-1], "right": edges[1:], "count": counts, "top": np.maximum(counts, 0.5),
        })  # fmt: skip
        drawn = plot.quad(
            left="left", right="right", bottom=0.5, top="top", source=source, alpha=0.75 / len(found) ** 0.5,
            color=style.OF_DRIVES[i], line_color="white", line_width=0.3,
        )  # fmt: skip
        style.with_values(plot, [drawn], [("from", "@left{0.0} µs"), ("cycles", "@count")])
    return plot
