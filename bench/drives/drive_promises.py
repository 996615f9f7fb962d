"""The promises of the drive under default limits, robot by robot, each with its figure: `scripts/bench drive`.

The bounds are those of the project's requirements; a figure from another source names it beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from bench.drives import drive_figures as measured
from bench.drives.drive_figures import Figure
from bench.robot_corpus import DIFFBOT, robot_names

ROBOTS = (DIFFBOT, "kobuki", "boxer", "jackal")  # 12 kg; 2 kg; 450 kg; a skid steer of 18 kg
FULL = 1.0  # m/s, the default limit
SPEEDS = (0.05, 0.1, 0.2, 0.5, FULL)  # m/s, on either side of d²/j = 0.1
FINE = 4096
RIPPLES = {FINE: 1.0, 512: 2.0, 90: 4.0}  # counts → % of the torque limit
LOADED_RMS = {200: 7.0, 100: 15.0}  # Hz → %
CURVES = ((0.7, 1.0), (-0.7, 1.0), (0.4, 1.8))  # m/s, rad/s


def straight(robot: str) -> list[Figure]:
    """0 → 1 m/s → 0, forwards and backwards, as it is and with its mass doubled unknown to the controller."""
    runs = [measured.straight(robot, direction * FULL) for direction in (1, -1)]
    loaded = measured.straight(robot, FULL, measured.mass_of(robot))
    return [
        Figure("tracking RMS", 100 * max(run.rms for run in runs), 2, "%"),
        Figure("overshoot", 100 * max(run.overshoot for run in runs), 1, "%"),
        Figure("settled after its profile", max(run.late for run in runs), 0.1, "s"),
        Figure("RMS, mass doubled", 100 * loaded.rms, 5, "%"),
        Figure("swing back, mass doubled", 100 * loaded.swing, 100 * measured.BAND, "%"),
    ]


def curves(robot: str) -> list[Figure]:
    """Curves for which the wheels are too slow, or too weak during the ramp."""
    fast = [measured.fast_curve(robot, *curve) for curve in CURVES]
    figures = [Figure("radius, wheel too slow", 100 * max(map(abs, fast)), 2, "%")]
    if not measured.scrubs(measured.make(robot)):
        weak = [measured.weak_curve(robot, *curve) for curve in CURVES]
        figures.append(Figure("radius, wheel too weak", 100 * max(map(abs, weak)), 2, "%"))
    return figures


def stops(robot: str) -> list[Figure]:
    """Stops from each speed, in both directions, up, down and level; the figure is the one nearest to its bound."""
    speeds = SPEEDS if robot == DIFFBOT else (0.1, FULL)
    figures = []
    for name, silence in (("stop distance", False), ("stop distance, silence", True)):
        errors = [
            measured.stop_error(robot, direction * speed, slope, silence=silence)
            for speed in speeds
            for direction in (1, -1)
            for slope in measured.SLOPES
        ]
        error, allowed = max(errors, key=lambda pair: abs(pair[0]) / pair[1])
        figures.append(Figure(name, 1e3 * error, 1e3 * allowed, "mm"))
    return figures


def rest(robot: str) -> list[Figure]:
    """Figures at rest: quiet at standstill, holding on a slope, steady in the air, no jump after a brake."""
    torque, distance = measured.standstill(robot)
    dip, jump = measured.released(robot, FULL)
    return [
        Figure("torque at rest, RMS", torque, 1e-3, "N·m"),
        Figure("way in 20 s on 5°", 1e3 * distance, 1, "mm"),  # that of the stand test
        Figure("lifted wheels' error", measured.lifted(robot), 0.2, "rad/s"),  # some counts, drive_performance_test.cpp
        Figure("dip after a brake", 100 * dip, 2, "%"),  # the tracking RMS
        Figure("torque after a brake", 100 * jump, 50, "% of it"),  # a release, not another brake
    ]


def coarse_encoders(robot: str) -> list[Figure]:
    """Ripple of the torque and the drive with coarse encoders; payload at low rates."""
    figures = []
    for counts, bound in RIPPLES.items():
        curves = {speed: measured.steady_curve(robot, counts, speed) for speed in (0.5, 0.1)}
        for speed, curve in curves.items():
            figures.append(Figure(f"ripple at {speed} m/s, {counts} counts", 100 * curve.ripple, bound, "% of torque"))
        figures.append(Figure(f"mean speed, {counts} counts", 100 * curves[0.5].off, 1, "%"))
        if counts == FINE:
            continue
        run = measured.straight(robot, FULL, params=measured.coarse(counts))
        figures.append(Figure(f"overshoot, {counts} counts", 100 * run.overshoot, 5, "%"))
    for rate, bound in LOADED_RMS.items():
        run = measured.straight(robot, FULL, measured.mass_of(robot), {"robot": {"rate": rate}})
        figures.append(Figure(f"RMS, mass doubled, {rate} Hz", 100 * run.rms, bound, "%"))
    return figures


def peer(_robot: str) -> list[Figure]:
    """The drives of diff_drive_controller's own test, and its tolerances."""
    distance, turn = measured.of_the_peer()
    return [Figure("10 s at 0.1 m/s", 1e3 * distance, 10, "mm"), Figure("10 s at π/10 rad/s", 1e3 * turn, 30, "mrad")]


def promises(robot: str) -> Iterator[Figure]:
    """All promises of `robot`; standing and hand-over apply to the own robot, whose brakes are known."""
    parts: list[Callable[[str], list[Figure]]] = [straight, curves, stops]
    for part in [*parts, rest, coarse_encoders, peer] if robot == DIFFBOT else parts:
        yield from part(robot)


def bench(say: Callable[[str], None]) -> tuple[dict[str, Any], bool]:
    """The result, and whether every present robot keeps every promise."""
    rows, absent, good = [], [], True
    for robot in ROBOTS:
        if robot not in robot_names():
            absent.append(robot)
            continue
        for figure in promises(robot):
            good = good and figure.good
            if not figure.good:
                say(f"{robot}: {figure.name} {figure.value:.4g} {figure.unit}, allowed {figure.bound:.4g}")
            ratio = float(np.abs(figure.value) / figure.bound)
            row = {"name": f"{robot} {figure.name}", "value": figure.value, "unit": figure.unit}
            rows.append(row | {"reference": figure.bound, "reference_name": "what is allowed", "ratio": ratio})
    return {"bench": "drive", "rows": rows, "not_judged": absent}, good
