"""calibrate.py without ROS: its command line, what is plausible, the table and the YAML."""

import argparse
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from robot_control.files.files import given_path
from robot_control.loop.roles import ESTIMATOR
from robot_control.robot.send_plan import number_of_sends, positive
from robot_control.setup.calibrate import law
from robot_control.setup.overlay import Outcome, to_yaml
from robot_control.ui.table import table

RATIO = (0.95, 1.05)
BASE = (0.7, 1.3)
SCALE = (0.8, 1.2)
"""The parameters accept these factors (src/estimation/wheeled/calibration_bounds.h). A radius that is a quarter
larger belongs to another wheel."""
MIN_RATIO, MIN_BASE = 0.0005, 0.003
"""Smaller standard deviations are never written: another load and another floor change the wheels by so much
(calibration_file.h)."""
FAR = 0.25
"""Share of a square's side; a robot that can be calibrated returns less far from its start."""
WRONG = 0.15
"""Share of a distance; no wheel is so wrong, but a reading in feet, paces or centimetres is."""


def not_negative(text: str) -> float:
    """argparse type: a finite number of at least zero."""
    value = float(text)
    if not (math.isfinite(value) and value >= 0):
        raise argparse.ArgumentTypeError(f"{text} is not a number of at least zero")
    return value


def place(text: str) -> tuple[float, float]:
    """argparse type, and a user's answer: "x,y" in m.

    Raises:
        ValueError: it is not two finite numbers.
    """
    parts = text.replace(",", " ").split()
    if len(parts) != 2:
        raise ValueError(f"{text!r} is not two numbers x,y")
    x, y = (float(part) for part in parts)
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError(f"{text!r} is not finite")
    return x, y


def parse_options(arguments: Sequence[str]) -> argparse.Namespace:
    """Reads the command line (without the program's name); ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="calibrate.py",
        description="Drives a distance and a UMBmark square, and reads the distances measured by tape. Writes wheel "
        "radius, wheel base and the ratio of the radii as parameters.",
        epilog="--distance 0 or --side 0 skips that part.",
    )
    add = parser.add_argument
    add("--distance", type=not_negative, default=3.0, help="m of a straight drive (default %(default)s)")
    add("--repeats", type=number_of_sends, default=2, help="straight drives (default %(default)s)")
    add("--side", type=not_negative, default=4.0, help="m of a side of the square (default %(default)s)")
    add("--runs", type=number_of_sends, default=5, help="squares each way (default %(default)s)")
    add("--speed", type=positive, default=0.3, help="m/s at most (default %(default)s)")
    add("--turn-speed", type=positive, default=0.6, help="rad/s at most (default %(default)s)")
    add(
        "--manual",
        action="store_true",
        help="another sender drives the robot, or a person pushes it: no command is sent",
    )
    add("--truth", action="store_true", help="simulation: ground_truth/odom is the tape")
    add("--yes", action="store_true", help="does not ask whether the path is free")
    add("--measured", type=positive, nargs="+", default=[], metavar="M", help="answers for the straight drives, m")
    add("--returned", type=place, nargs="+", default=[], metavar="X,Y", help="answers for the squares, m")
    add("--out", type=given_path, default=Path("calibrated.yaml"), help="(default %(default)s)")
    given = parser.parse_args(list(arguments))
    if given.distance == 0 and given.side == 0:
        parser.error("--distance 0 and --side 0: nothing to do")
    for name in ("distance", "side"):
        if 0 < getattr(given, name) < 0.5:
            parser.error(f"--{name}: below 0.5 m a tape's {1000 * law.TAPE:g} mm are more than the wheels' errors")
    return given


def margin(length: float) -> float:
    """m beside a path of `length` m: half a metre of robot, and what the wheels get wrong; FAR at a corner."""
    return 0.5 + length / 8


def space(options: argparse.Namespace) -> str:
    """The space that must be free, as text."""
    if options.manual:
        return "Another sender or a person moves the robot; no command is sent."
    needs = []
    if options.distance > 0:
        beside = margin(options.distance)
        needs.append(f"{options.distance + beside:g} m ahead and {beside:g} m to either side")
    if options.side > 0:
        beside = margin(options.side)
        needs.append(
            f"from {beside:g} m behind it to {options.side + beside:g} m ahead, and {options.side + beside:g} m to "
            "either side, for squares to the right and to the left"
        )
    return "The robot drives by itself and does not detect obstacles. It needs " + ", then ".join(needs) + "."


def implausible_distance(measured: float, by_wheels: float) -> str:
    """Why the tape cannot have measured that; empty if it can."""
    if abs(measured - by_wheels) <= WRONG * by_wheels:
        return ""
    what = f"{measured:g} m, but the wheels measured {by_wheels:.3f} m"
    return f"{what}: more than {WRONG:.0%} off. Check that it is in metres, between the two marks"


def implausible_return(returned: tuple[float, float], side: float) -> str:
    """Why the robot cannot have come to that place; empty if it can."""
    if math.hypot(*returned) <= FAR * side:
        return ""
    what = f"{math.hypot(*returned):.2f} m from the start after a square of {side:g} m"
    return f"{what}: more than {FAR:.0%} of a side. Check: metres, x ahead and y to the left of the first mark"


def wheels_of(robot: Mapping[str, Any]) -> law.Wheels:
    """The nominal wheels of wheel odometry, from `ClosedLoop.robot`."""
    centres = np.array([wheel["centre"] for wheel in robot["wheels"]])
    x, y = centres[:, :2].mean(axis=0)
    return law.Wheels(robot["effective_wheel_base"], (float(x), float(y)))


def evaluate(
    robot: Mapping[str, Any], straights: Sequence[law.Straight], squares: Sequence[law.Square], side: float
) -> Outcome:
    """Fits the wheels to the measurements, checks the result and reports it.

    Raises:
        NotCalibratedError: the measurements fit no robot.
    """
    wheels = wheels_of(robot)
    truth = law.fit(straights, squares, wheels)
    for name, value, (low, high) in (
        ("common radius", truth.scale, SCALE),
        ("ratio of the radii", truth.ratio, RATIO),
        ("wheel base", truth.base, BASE),
    ):
        if not low <= value <= high:
            raise law.NotCalibratedError(
                f"the {name} would be {value:.4f} times its nominal value, beyond {low:g} … {high:g}. Check the "
                "measurements (m; x forward, y left) and the URDF (rosrun robot_control inspect_robot.py)"
            )
    rows = [("", "nominal", "measured", "factor")]
    radius = _radius(robot)
    if straights:
        rows.append(
            ("wheel radius", f"{radius:.6g} m", _with(radius, truth.scale, truth.scale_deviation), _factor(truth.scale))
        )
    if squares:
        base = wheels.wheel_base
        measured = _with(base, truth.base, truth.base_deviation)
        rows.append(("effective wheel base", f"{base:.6g} m", measured, _factor(truth.base)))
        rows.append(
            ("right over left radius", "1", _with(1, truth.ratio, truth.ratio_deviation, unit=""), _factor(truth.ratio))
        )
    lines = table(rows)
    if squares:
        lines += ["", *_square_lines(squares, wheels, truth, side)]
    lines += [
        f"drive {number + 1}: {drive.measured:.3f} m by tape, {_driven(drive, wheels, law.Truth()):.3f} m by wheels "
        f"before, {_driven(drive, wheels, truth):.3f} m after"
        for number, drive in enumerate(straights)
    ]
    said = _warnings(straights, squares, wheels, truth)
    head = [
        f"Measured on {robot['name']} by calibrate.py. Load it, then restart every node: rosparam load FILE",
        *lines,
        *(f"! {sentence}" for sentence in said),
    ]
    return Outcome("\n".join(lines), said, to_yaml(head, overlay(robot, truth)))


def overlay(robot: Mapping[str, Any], truth: law.Truth) -> dict[str, dict[str, float]]:
    """The parameters that express `truth`, relative to those of `robot` when it was measured."""
    own: dict[str, float] = {}
    estimator: dict[str, float] = {}
    if truth.scale_deviation > 0:
        own["wheel_radius"] = truth.scale * _radius(robot)
    if truth.base_deviation > 0:
        if len(robot["wheels"]) == 2:  # a skid steer's wheels scrub
            own["wheel_base"] = truth.base * robot["wheel_base"]
        else:
            own["wheel_base_multiplier"] = truth.base * robot["wheel_base_multiplier"]
        estimator = {
            "radius_ratio": truth.ratio,
            "radius_ratio_deviation": max(MIN_RATIO, truth.ratio_deviation),
            "wheel_base_factor": 1.0,
            "wheel_base_deviation": max(MIN_BASE, truth.base_deviation),
        }
    return {"robot": own} | ({ESTIMATOR: estimator} if estimator else {})


def _radius(robot: Mapping[str, Any]) -> float:
    return float(np.mean([wheel["radius"] for wheel in robot["wheels"]]))


def _driven(drive: law.Straight, wheels: law.Wheels, truth: law.Truth) -> float:
    return float(np.linalg.norm(law.replay(drive.path, wheels, truth)[-1, :2]))


def _square_lines(squares: Sequence[law.Square], wheels: law.Wheels, truth: law.Truth, side: float) -> list[str]:
    errors = law.return_errors(squares, wheels, law.Truth())
    clockwise = np.array([square.clockwise for square in squares])
    classic = law.umbmark(errors[clockwise], errors[~clockwise], side, wheels.wheel_base)
    before = law.largest_mean_return_error(squares, wheels, law.Truth())
    after = law.largest_mean_return_error(squares, wheels, truth)
    return [
        f"UMBmark, {len(squares)} squares of {side:g} m: largest mean return error {1000 * before:.0f} mm before, "
        f"{1000 * after:.1f} mm after",
        f"the authors' formulas for small errors: E_d {classic.ratio:.5f}, E_b {classic.base:.5f}, nominal radius",
    ]


def _warnings(
    straights: Sequence[law.Straight], squares: Sequence[law.Square], wheels: law.Wheels, truth: law.Truth
) -> list[str]:
    said = []
    if squares and not straights:
        said.append("no straight drive: the common radius stays nominal, and the wheel base is valid only for it")
    if straights and not squares:
        said.append(
            "no squares: ratio of the radii and wheel base stay nominal; the estimator learns them from its gyro"
        )
    if squares:
        errors = law.return_errors(squares, wheels, truth)
        clockwise = np.array([square.clockwise for square in squares])
        spread = max(
            float(np.linalg.norm(errors[direction] - errors[direction].mean(axis=0), axis=1).max())
            for direction in (clockwise, ~clockwise)
        )
        before = law.largest_mean_return_error(squares, wheels, law.Truth())
        if spread > max(0.03, before):
            said.append(
                f"one square lies {1000 * spread:.0f} mm from the mean of its direction: slip, bumps or a slip of the "
                "tape weigh more than the wheels' errors. Drive slower, on even ground, more runs"
            )
    return said


def _with(nominal: float, factor: float, deviation: float, unit: str = " m") -> str:
    return f"{nominal * factor:.6g} ± {nominal * deviation:.1g}{unit}"


def _factor(factor: float) -> str:
    return f"{factor:.5f}"
