"""A robot as it was understood, in words: one screen."""

import math
import textwrap
from collections.abc import Iterator
from typing import Any

from robot_control.files.files import escaped_lines
from robot_control.setup.shapes import ground_height, poses
from robot_control.ui.table import table

WIDTH = 110
HEADINGS = {
    "suspicious": "Warnings (accepted, please check)",
    "overridden": "Overridden by the robot: block",
    "repaired": "Repaired (the file contained impossible values)",
    "assumed": "Assumed (not in the file)",
    "ignored": "Ignored (not used)",
}


def report(robot: dict[str, Any]) -> str:
    """The text names what was understood, assumed, repaired, ignored and overridden, and what looks suspicious."""
    lines = [f"{robot['name'] or 'robot'}: {robot['source']}", "", *_body(robot), ""]
    lines += _legs(robot) if robot["kind"] == "legs" else [*_wheels(robot), "", *_base(robot)]
    for section in (_casters(robot), _joints(robot), *(_notes(robot, kind) for kind in HEADINGS)):
        if section:
            lines += ["", *section]
    return escaped_lines(lines)


def _body(robot: dict[str, Any]) -> list[str]:
    imu = robot["imu"]
    place = f"{imu['link']} at {_vector(imu['position'])}" if imu["link"] else f"none: assumed in {robot['base_link']}"
    yaw_inertia = f", yaw inertia {robot['yaw_inertia']:.4g} kg·m²" if "yaw_inertia" in robot else ""
    return [
        f"base               {robot['base_link']}, floor at z {ground_height(robot):.4g} m",
        f"mass               {robot['mass']:.5g} kg{yaw_inertia}",
        *_centres(robot),
        f"IMU                {place}",
        *_standing(robot),
    ]


def _centres(robot: dict[str, Any]) -> Iterator[str]:
    head = "centre of gravity"
    for pose in poses(robot):
        centre = pose["centre_of_gravity"]
        where = f", {pose['pose']}" if pose["pose"] else ""
        yield f"{head:<19}{_vector(centre)}, {centre[2] - ground_height(pose):.4g} m above the floor{where}"
        head = ""


def _standing(robot: dict[str, Any]) -> list[str]:
    if "standing" not in robot:
        return []
    lean, carried = robot["standing"]["lean"], robot["standing"]["carried"]
    if robot["kind"] == "legs":
        return [f"lies               leaning {math.degrees(lean):.2f}°, {100 * carried:.0f} % on the legs"]
    lines = [f"stands             leaning {math.degrees(lean):.2f}°, {100 * carried:.0f} % on the drive wheels"]
    if robot["standing"].get("unloaded"):
        lines.append(f"NO LOAD            {robot['standing']['unloaded']}")
    return lines


def _wheels(robot: dict[str, Any]) -> list[str]:
    limits = {joint["name"]: joint for joint in robot["joints"]}
    rows: list[tuple[str, ...]] = [
        ("drive wheel", "side", "x [m]", "y [m]", "z [m]", "radius", "width", "turns", "N·m", "rad/s", "kg·m²")
    ]
    for wheel in robot["wheels"]:
        limit = limits[wheel["joint"]]
        turns = "forward" if wheel["sign"] > 0 else "reversed"
        speed = f"{limit['velocity_limit']:.4g}" if limit["velocity_limit"] else "unknown"
        limits_of = (turns, f"{limit['effort_limit']:.4g}", speed, f"{wheel['inertia']:.3g}")
        rows.append((wheel["joint"], wheel["side"], *_sizes(wheel), *limits_of))
    return table(rows, left=2)


def _sizes(wheel: dict[str, Any]) -> Iterator[str]:
    return (f"{value:.4f}" for value in (*wheel["centre"], wheel["radius"], wheel["width"]))


def _legs(robot: dict[str, Any]) -> list[str]:
    limits = {joint["name"]: joint for joint in robot["joints"]}
    head = ("leg", "joints", "hip x", "y", "z [m]", "length", "foot", "knee", "N·m", "rad/s", "lies at [rad]")
    rows: list[tuple[str, ...]] = [head]
    for leg in robot["legs"]:
        joints = [limits[name] for name in leg["joints"]]
        sizes = (f"{value:.4f}" for value in (*leg["hip"], leg["length"]))
        foot = f"{leg['foot_radius']:.4f}" if leg["foot_radius"] else "no ball"
        efforts, speeds = (" ".join(f"{each[of]:.4g}" for each in joints) for of in ("effort_limit", "velocity_limit"))
        lying = " ".join(f"{angle:.2f}" for angle in leg["lying"])
        names = leg["place"].replace("_", " "), ", ".join(leg["joints"])
        rows.append((*names, *sizes, foot, leg["bends"], efforts, speeds, lying))
    rotor = f"rotors             {robot['rotor_inertia']:.3g} kg·m² at each joint (robot.leg_rotor_inertia)"
    return [*table(rows, left=2), "", rotor]


def _base(robot: dict[str, Any]) -> list[str]:
    line = f"wheel base         {robot['wheel_base']:.5g} m"
    if robot["wheel_base_multiplier"] != 1:
        line += f" × {robot['wheel_base_multiplier']:.4g} = {robot['effective_wheel_base']:.5g} m effective in a turn"
    return [line]


def _casters(robot: dict[str, Any]) -> list[str]:
    rows: list[tuple[str, ...]] = [("caster wheel", "x [m]", "y [m]", "z [m]", "radius", "width")]
    rows += [(caster["joint"], *_sizes(caster)) for caster in robot.get("casters", ())]
    return table(rows, left=1) if robot.get("casters") else []


def _joints(robot: dict[str, Any]) -> list[str]:
    others = [joint for joint in robot["joints"] if joint["role"] not in ("wheel", "leg")]
    rows: list[tuple[str, ...]] = [("other joint", "role", "type", "moves", "range")]
    rows += [(joint["name"], joint["role"], joint["type"], joint["link"], _range(joint)) for joint in others]
    return table(rows, left=5) if others else []


def _range(joint: dict[str, Any]) -> str:
    if joint["mimicked"]:
        return f"follows {joint['mimicked']}"
    if joint["lower"] == joint["upper"]:
        return "unlimited"
    return f"{joint['lower']:.4g} … {joint['upper']:.4g} {'m' if joint['type'] == 'prismatic' else 'rad'}"


def _notes(robot: dict[str, Any], kind: str) -> list[str]:
    notes = [note for note in robot["notes"] if note["kind"] == kind]
    if not notes:
        return []
    lines = [HEADINGS[kind]]
    for note in notes:
        text = f"{note['element']}: {note['text']}"
        lines += textwrap.wrap(
            text, WIDTH, initial_indent="  ", subsequent_indent="      ", break_long_words=False, break_on_hyphens=False
        )
    return lines


def _vector(values: tuple[float, ...] | list[float]) -> str:
    return "(" + ", ".join(f"{round(value, 6) + 0.0:.4g}" for value in values) + ") m"  # to a micrometre, and no -0
