"""Colours (Okabe and Ito's, which all eyes tell apart) and the frame of a plot."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bokeh.models import CrosshairTool, HoverTool, Legend, Span
from bokeh.plotting import figure

BLUE, ORANGE, GREEN, RED = "#0072B2", "#E69F00", "#009E73", "#D55E00"
PURPLE, SKY, GREY, INK = "#CC79A7", "#56B4E9", "#9AA0A6", "#3C4043"
OF_DRIVES = (BLUE, ORANGE)
STATES = {"INIT": GREY, "READY": SKY, "DRIVE": GREEN, "STOPPING": ORANGE, "STOPPED": RED, "FAULT": "#7B1E3A"}
FONT = "Inter, 'Segoe UI', Roboto, 'Helvetica Neue', 'DejaVu Sans', sans-serif"


@dataclass(frozen=True)
class Line:
    """How one series is drawn."""

    label: str
    colour: str
    width: float = 1.4
    dash: str = "solid"
    alpha: float = 1.0


class TimeAxis:
    """The plots over time, which zoom and point together."""

    def __init__(self, begin: float, end: float, marks: Sequence[float] = ()) -> None:
        """`marks`: s, where every plot gets a vertical line."""
        self._range: Any = None
        self._marks = marks
        self._span = (begin, end)
        self._cursor = Span(dimension="height", line_dash="dotted", line_width=1, line_color=INK)

    def plot(self, unit: str, height: int = 210, **options: Any) -> Any:  # noqa: ANN401 (Bokeh's)
        """An empty plot."""
        margin = 0.01 * (self._span[1] - self._span[0])
        x_range = self._range or (self._span[0] - margin, self._span[1] + margin)
        made = framed(
            height=height, x_range=x_range, tools="xpan,xbox_zoom,xwheel_zoom,reset,save", active_drag="xbox_zoom",
            y_axis_label=unit, x_axis_label="time [s]", **options,
        )  # fmt: skip
        self._range = made.x_range
        for mark in self._marks:
            made.add_layout(Span(location=mark, dimension="height", line_color=RED, line_width=1, line_alpha=0.45))
        made.add_tools(CrosshairTool(overlay=self._cursor))
        return made


def framed(**options: Any) -> Any:  # noqa: ANN401 (Bokeh's)
    """A figure in the style of the page."""
    made = figure(sizing_mode="stretch_width", toolbar_location="right", min_border_left=80, **options)
    made.toolbar.logo = None
    made.toolbar.autohide = True
    made.background_fill_color = "#FFFFFF"
    made.border_fill_color = "#FFFFFF"
    made.outline_line_color = None
    made.grid.grid_line_color = "#E8EAED"
    for axis in made.axis:
        axis.axis_line_color = "#BDC1C6"
        axis.major_tick_line_color = "#BDC1C6"
        axis.minor_tick_line_color = None
        axis.axis_label_text_font_style = "normal"
        axis.axis_label_text_color = axis.major_label_text_color = "#5F6368"
        axis.axis_label_text_font = axis.major_label_text_font = FONT
        axis.axis_label_text_font_size = axis.major_label_text_font_size = "12px"
    return made


def with_legend(plot: Any, items: list[tuple[str, list[Any]]]) -> Any:  # noqa: ANN401 (Bokeh's)
    """A legend above the plot, in which series of one label share its entry; a click hides them."""
    entries: dict[str, list[Any]] = {}
    for label, drawn in items:
        entries.setdefault(label, []).extend(drawn)
    legend = Legend(
        items=list(entries.items()), orientation="horizontal", click_policy="hide", border_line_color=None, spacing=14,
        label_text_font=FONT, label_text_font_size="12px", label_text_color=INK, glyph_width=18, padding=0, margin=2,
    )  # fmt: skip
    plot.add_layout(legend, "above")
    return plot


def with_values(plot: Any, renderers: list[Any], tips: list[tuple[str, str]], mode: str = "mouse") -> None:  # noqa: ANN401
    """Sets what the pointer shows."""
    plot.add_tools(HoverTool(renderers=renderers, tooltips=tips, mode=mode, line_policy="nearest"))
