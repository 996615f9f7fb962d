"""Draws a robot as it was understood: from the front corner, from its right, from above; in true scale. A robot on legs
is drawn as it lies and as it stands.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, Wedge
from scipy.ndimage import uniform_filter

from robot_control.robot.pose import rotation
from robot_control.setup.inspect.rendering import Array, Part, View, Window, render
from robot_control.setup.shapes import ground_height, poses, triangles_in_base

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import SubFigure

LEFT, RIGHT, CASTER, OTHER, BODY = "#2f6fb7", "#d2553f", "#5d8f4e", "#c9a24b", "#c3c9d0"
INK, SOFT, FLOOR = "#22262b", "#7b838c", "#9aa1a9"
CORNER, FROM_THE_RIGHT, FROM_ABOVE = (View.towards(d) for d in ((0.62, -0.72, 0.46), (0, -1, 0), (0, 0, 1)))
ROLLING = {to_rgb(LEFT), to_rgb(RIGHT), to_rgb(CASTER)}
THROUGH = 0.4  # opacity of wheels behind other shapes
PIXELS = 1000  # width of a rendered view


def draw_robot(robot: dict[str, Any], path: Path) -> None:
    """Writes a PNG of 1760 × 990 pixels for each pose, one below the other."""
    shown = poses(robot)
    style = {"font.size": 11, "axes.titlesize": 12, "axes.titleweight": "bold", "axes.titlelocation": "left"}
    with mpl.rc_context(style):
        figure = plt.figure(figsize=(16, 9 * len(shown)), dpi=110)
        for panel, pose in zip(figure.subfigures(len(shown), 1, squeeze=False).flat, shown, strict=True):
            _draw_pose(panel, pose)
        figure.savefig(path)
        plt.close(figure)


def _draw_pose(figure: SubFigure, robot: dict[str, Any]) -> None:
    ground = ground_height(robot)
    parts = _parts(robot)
    figure.text(0.02, 0.955, robot["name"] or "robot", fontsize=19, fontweight="bold", color=INK)
    figure.text(0.02, 0.923, _subtitle(robot), fontsize=12, color=SOFT)
    corner = figure.add_axes((0.01, 0.07, 0.53, 0.84))
    side = figure.add_axes((0.56, 0.52, 0.43, 0.40))
    above = figure.add_axes((0.56, 0.03, 0.43, 0.44))
    _draw_corner(corner, robot, parts, ground)
    _draw_side(side, robot, parts, ground)
    _draw_above(above, robot, parts)
    _legend(figure, robot)


def _subtitle(robot: dict[str, Any]) -> str:
    if robot["kind"] == "legs":
        length = _length(min(leg["length"] for leg in robot["legs"]))
        return f"{robot['mass']:.4g} kg · 4 legs of {length} · {robot['pose']}"
    count = len(robot["wheels"])
    base = f"wheel base {_length(robot['wheel_base'])}"
    if robot["wheel_base_multiplier"] != 1:
        base += f" × {robot['wheel_base_multiplier']:.3g} = {_length(robot['effective_wheel_base'])} effective"
    return f"{robot['mass']:.4g} kg · {count} drive wheels · {base}"


def _length(metres: float) -> str:
    return f"{metres * 1000:.4g} mm" if abs(metres) < 0.1 else f"{metres:.4g} m"


def _parts(robot: dict[str, Any]) -> list[Part]:
    colours = {wheel["joint"]: LEFT if wheel["side"] == "left" else RIGHT for wheel in robot.get("wheels", ())}
    colours |= {caster["joint"]: CASTER for caster in robot.get("casters", ())}
    for leg in robot.get("legs", ()):
        colours |= dict.fromkeys(leg["joints"], LEFT if leg["place"].endswith("left") else RIGHT)
    colours |= {joint["name"]: OTHER for joint in robot["joints"] if joint["name"] not in colours}
    parts = [Part(triangles_in_base(shape), to_rgb(colours.get(shape["joint"], BODY))) for shape in robot["shapes"]]
    return [part for part in parts if part.triangles.size]


def _extent(points: Array, margin: float) -> tuple[float, float, float, float]:
    """Left, right, bottom, top of projected points with a margin relative to the larger side."""
    low, high = points.reshape(-1, 3).min(axis=0), points.reshape(-1, 3).max(axis=0)
    rim = margin * max(high[0] - low[0], high[1] - low[1])
    return float(low[0] - rim), float(high[0] + rim), float(low[1] - rim), float(high[1] + rim)


def _all_points(robot: dict[str, Any], parts: list[Part]) -> Array:
    wheels = [
        np.asarray(wheel["centre"]) + sign * wheel["radius"]
        for wheel in (*robot.get("wheels", ()), *robot.get("casters", ()))
        for sign in (-1, 1)
    ]
    return np.concatenate([part.triangles.reshape(-1, 3) for part in parts] + [np.array(wheels).reshape(-1, 3)])


def _show(axes: Axes, parts: list[Part], view: View, extent: tuple[float, float, float, float]) -> None:
    axes.imshow(render(parts, view, Window(*extent), PIXELS), extent=extent, zorder=3, interpolation="antialiased")
    rolling = [part for part in parts if part.colour in ROLLING]
    through = render(rolling, view, Window(*extent), PIXELS)
    axes.imshow(through, extent=extent, zorder=4, interpolation="antialiased", alpha=THROUGH)


def _frame(axes: Axes, left: float, right: float, bottom: float, top: float) -> None:
    """Sets limits that hold at least this area, in true scale."""
    box = axes.get_window_extent()
    wide = max(right - left, (top - bottom) * box.width / box.height)
    high = wide * box.height / box.width
    axes.set_xlim((left + right - wide) / 2, (left + right + wide) / 2)
    axes.set_ylim((bottom + top - high) / 2, (bottom + top + high) / 2)
    axes.set_aspect("equal")
    axes.axis("off")


def _draw_corner(axes: Axes, robot: dict[str, Any], parts: list[Part], ground: float) -> None:
    points = _all_points(robot, parts)
    size = float(np.ptp(points, axis=0).max())
    _draw_floor(axes, points, ground, size)
    extent = _extent(CORNER.project(points), 0.02)
    _draw_shadow(axes, parts, ground, size)
    _show(axes, parts, CORNER, extent)
    front = np.array([points[:, 0].max() + 0.06 * size, 0, ground])
    _arrow(axes, CORNER.project(front), CORNER.project(front + np.array([0.22 * size, 0, 0])), "forward")
    _triad(axes, CORNER, np.asarray(robot["imu"]["position"]), robot["imu"]["orientation"], 0.09 * size)
    left, right, bottom, top = _extent(CORNER.project(points), 0.12)
    _frame(axes, left, right, bottom, top)


def _draw_floor(axes: Axes, points: Array, ground: float, size: float) -> None:
    decade = 10.0 ** np.floor(np.log10(size))
    step = float(decade * next(part for part in (0.1, 0.2, 0.5, 1) if size / decade <= 12 * part))
    low = np.floor((points.min(axis=0) - 0.25 * size) / step) * step
    high = np.ceil((points.max(axis=0) + 0.25 * size) / step) * step
    for x in np.arange(low[0], high[0] + step / 2, step):
        _line(axes, CORNER, (x, low[1], ground), (x, high[1], ground))
    for y in np.arange(low[1], high[1] + step / 2, step):
        _line(axes, CORNER, (low[0], y, ground), (high[0], y, ground))
    axes.text(0.01, 0.01, f"grid {_length(step)}", transform=axes.transAxes, color=SOFT, fontsize=10)


def _line(axes: Axes, view: View, begin: tuple[float, float, float], end: tuple[float, float, float]) -> None:
    ends = view.project(np.array([begin, end]))
    axes.plot(ends[:, 0], ends[:, 1], color="#e6e9ec", linewidth=0.9, zorder=1)


def _draw_shadow(axes: Axes, parts: list[Part], ground: float, size: float) -> None:
    flat = []
    for part in parts:
        triangles = part.triangles.copy()
        triangles[..., 2] = ground
        flat.append(Part(triangles, (0, 0, 0)))
    extent = _extent(CORNER.project(np.concatenate([part.triangles.reshape(-1, 3) for part in flat])), 0.05)
    width = 300
    alpha = render(flat, CORNER, Window(*extent), width)[..., 3] / 255
    blur = max(1, round(0.02 * size * width / (extent[1] - extent[0])))
    shadow = np.zeros((*alpha.shape, 4))
    shadow[..., 3] = 0.22 * np.clip(uniform_filter(alpha, 2 * blur + 1, mode="constant"), 0, 1)  # rounding
    axes.imshow(shadow, extent=extent, zorder=2, interpolation="bilinear")


def _draw_side(axes: Axes, robot: dict[str, Any], parts: list[Part], ground: float) -> None:
    points = _all_points(robot, parts)
    left, right, bottom, top = _extent(FROM_THE_RIGHT.project(points), 0.02)
    size = max(right - left, top - bottom)
    _show(axes, parts, FROM_THE_RIGHT, (left, right, bottom, top))
    axes.axhline(ground, color=FLOOR, linewidth=1.4, zorder=2)
    for wheel in robot.get("wheels", ()):
        if wheel["side"] == "right":
            axes.add_patch(_circle((wheel["centre"][0], wheel["centre"][2]), wheel["radius"], RIGHT))
    for caster in robot.get("casters", ()):
        axes.add_patch(_circle((caster["centre"][0], caster["centre"][2]), caster["radius"], CASTER))
    x, _, z = robot["centre_of_gravity"]
    _centre_of_gravity(axes, x, z, 0.022 * size)
    position = robot["imu"]["position"]
    _triad(axes, FROM_THE_RIGHT, np.asarray(position), robot["imu"]["orientation"], 0.07 * size)
    _draw_height(axes, robot, ground, left - 0.06 * size)
    at = right + 0.09 * size
    _dimension(axes, (at, ground), (at, z), f"centre of gravity\n{_length(z - ground)} high", x, before=False)
    axles = sorted({round(float(each[0]), 4) for each in _bearings(robot)})
    if axles[-1] - axles[0] > 0.02 * size:
        below = ground - 0.08 * size
        text = f"{'hips' if robot['kind'] == 'legs' else 'axles'} {_length(axles[-1] - axles[0])}"
        _dimension_across(axes, (axles[0], below), (axles[-1], below), text)
    _arrow(axes, (right - 0.14 * size, top + 0.05 * size), (right + 0.02 * size, top + 0.05 * size), "forward")
    axes.set_title("From its right")
    _frame(axes, left - 0.36 * size, right + 0.44 * size, min(bottom, ground) - 0.16 * size, top + 0.12 * size)


def _draw_height(axes: Axes, robot: dict[str, Any], ground: float, at: float) -> None:
    """Dimensions the radius of the rear right wheel, or the height of the base's origin."""
    if robot["kind"] == "legs":
        _dimension(axes, (at, ground), (at, 0.0), f"base\n{_length(-ground)} high", 0.0)
        return
    rear = min(
        (wheel for wheel in robot.get("wheels", ()) if wheel["side"] == "right"), key=lambda wheel: wheel["centre"][0]
    )
    _dimension(axes, (at, ground), (at, rear["centre"][2]), f"radius {_length(rear['radius'])}", rear["centre"][0])


def _bearings(robot: dict[str, Any]) -> list[list[float]]:
    """Centres of the wheels, or of the hips."""
    return [wheel["centre"] for wheel in robot.get("wheels", ())] or [leg["hip"] for leg in robot["legs"]]


def _draw_above(axes: Axes, robot: dict[str, Any], parts: list[Part]) -> None:
    points = _all_points(robot, parts)
    left, right, bottom, top = _extent(FROM_ABOVE.project(points), 0.02)
    size = max(right - left, top - bottom)
    _show(axes, parts, FROM_ABOVE, (left, right, bottom, top))
    for wheel in robot.get("wheels", ()):
        colour = LEFT if wheel["side"] == "left" else RIGHT
        (x, y, _), radius, half = wheel["centre"], wheel["radius"], wheel["width"] / 2
        axes.add_patch(
            plt.Rectangle((x - radius, y - half), 2 * radius, 2 * half, fill=False, ec=colour, linewidth=1.8, zorder=5)
        )
    for caster in robot.get("casters", ()):
        axes.add_patch(_circle(caster["centre"][:2], caster["radius"], CASTER))
    x, y, _ = robot["centre_of_gravity"]
    _centre_of_gravity(axes, x, y, 0.022 * size)
    _triad(axes, FROM_ABOVE, np.asarray(robot["imu"]["position"]), robot["imu"]["orientation"], 0.07 * size)
    ys = [each[1] for each in _bearings(robot)]
    lefts, rights = [y for y in ys if y > np.mean(ys)], [y for y in ys if y <= np.mean(ys)]
    named = (
        f"hips\n{_length(max(ys) - min(ys))}"
        if robot["kind"] == "legs"
        else f"wheel base\n{_length(robot['wheel_base'])}"
    )
    at = left - 0.06 * size
    measured = min(each[0] for each in _bearings(robot))
    _dimension(axes, (at, float(np.mean(rights))), (at, float(np.mean(lefts))), named, measured)
    _arrow(axes, (right + 0.05 * size, 0), (right + 0.2 * size, 0), "forward")
    axes.set_title("From above")
    _frame(axes, left - 0.36 * size, right + 0.44 * size, bottom - 0.05 * size, top + 0.05 * size)


def _circle(centre: tuple[float, float], radius: float, colour: str) -> Circle:
    return Circle(centre, radius, fill=False, edgecolor=colour, linewidth=1.8, zorder=5)


def _centre_of_gravity(axes: Axes, x: float, y: float, radius: float) -> None:
    axes.add_patch(Circle((x, y), radius, facecolor="white", edgecolor=INK, linewidth=1.2, zorder=7))
    for begin in (0, 180):
        axes.add_patch(Wedge((x, y), radius, begin, begin + 90, facecolor=INK, linewidth=0, zorder=8))


def _triad(axes: Axes, view: View, origin: Array, orientation: list[float], length: float) -> None:
    """The axes of a frame: x red, y green, z blue. `orientation` is a quaternion x y z w."""
    start = view.project(origin)
    for axis, colour in zip(rotation(orientation).T, ("#d62728", "#2ca02c", "#1f3fd6"), strict=True):
        end = view.project(origin + length * axis)
        axes.plot((start[0], end[0]), (start[1], end[1]), color="white", linewidth=4, zorder=8, solid_capstyle="round")
        axes.plot((start[0], end[0]), (start[1], end[1]), color=colour, linewidth=2.2, zorder=9, solid_capstyle="round")
    axes.plot(start[0], start[1], "o", color=INK, markersize=4.5, zorder=10)


def _arrow(axes: Axes, begin: Sequence[float] | Array, end: Sequence[float] | Array, text: str) -> None:
    arrowprops = {"arrowstyle": "-|>,head_length=0.7,head_width=0.35", "color": INK, "linewidth": 2.2}
    axes.annotate("", (end[0], end[1]), (begin[0], begin[1]), arrowprops=arrowprops, zorder=9)
    axes.annotate(
        text, ((begin[0] + end[0]) / 2, (begin[1] + end[1]) / 2), (0, 8), textcoords="offset points",
        ha="center", va="bottom", fontsize=10, color=INK, zorder=9,
    )  # fmt: skip


def _dimension(
    axes: Axes, low: tuple[float, float], high: tuple[float, float], text: str, measured: float, *, before: bool = True
) -> None:
    """An upright dimension line with thin lines to x = `measured`, its text `before` (left of) or behind it."""
    for _, height in (low, high):
        axes.plot((low[0], measured), (height, height), color=SOFT, linewidth=0.8, linestyle=(0, (4, 3)), zorder=4)
    axes.annotate("", high, low, arrowprops={"arrowstyle": "<|-|>", "color": INK, "linewidth": 1.1}, zorder=6)
    axes.annotate(
        text, (low[0], (low[1] + high[1]) / 2), (-7 if before else 7, 0), textcoords="offset points",
        ha="right" if before else "left", va="center", fontsize=10.5, color=INK, zorder=6,
    )  # fmt: skip


def _dimension_across(axes: Axes, left: tuple[float, float], right: tuple[float, float], text: str) -> None:
    axes.annotate("", right, left, arrowprops={"arrowstyle": "<|-|>", "color": INK, "linewidth": 1.1}, zorder=6)
    axes.annotate(
        text, ((left[0] + right[0]) / 2, left[1]), (0, -5), textcoords="offset points",
        ha="center", va="top", fontsize=10.5, color=INK, zorder=6,
    )  # fmt: skip


def _legend(figure: SubFigure, robot: dict[str, Any]) -> None:
    what = robot["kind"]
    entries: list[Any] = [Patch(color=LEFT, label=f"left {what}"), Patch(color=RIGHT, label=f"right {what}")]
    if robot.get("casters", ()):
        entries.append(Patch(color=CASTER, label="caster wheels"))
    rolling = {"", *(wheel["joint"] for wheel in (*robot.get("wheels", ()), *robot.get("casters", ())))}
    rolling.update(joint for leg in robot.get("legs", ()) for joint in leg["joints"])
    if any(shape["joint"] not in rolling for shape in robot["shapes"]):
        entries.append(Patch(color=OTHER, label="other moving parts"))
    entries.append(Patch(color=BODY, label="base, as it collides"))
    entries.append(Line2D([], [], marker="o", color="white", markeredgecolor=INK, markerfacecolor=INK, markersize=9,
                          label="centre of gravity"))  # fmt: skip
    imu = robot["imu"]["link"] or f"in {robot['base_link']}"
    entries.append(Line2D([], [], color="#d62728", linewidth=2.2, label=f"IMU ({imu}), x y z red green blue"))
    figure.legend(handles=entries, loc="lower left", bbox_to_anchor=(0.015, 0.012), ncols=4, frameon=False, fontsize=10)
