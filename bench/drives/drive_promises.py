"""The promises of the drive under default limits, robot by robot, each with its figure: `scripts/bench drive`.

The bounds are those of the project's requirements; a figure from another source names it beside it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

import numpy as np

from bench.drives import drive_figures as measured
from bench.drives.drive_figures import Figure
from bench.drives.wheel_command import for_drives
from bench.robot_corpus import DIFFBOT, robot_names
from bench.rows import Result, Say

ROBOTS = (DIFFBOT, "kobuki", "boxer", "jackal")  # 12 kg; 2 kg; 450 kg; a skid steer of 18 kg
FULL = 1.0  # m/s, the default limit
SPEEDS = (0.05, 0.1, 0.2, 0.5, FULL)  # m/s, on either side of d²/j = 0.1
FINE = 4096
RIPPLES = {FINE: 1.0, 512: 2.0, 90: 4.0}  # counts → % of the torque limit
LOADED_RMS = {200: 7.0, 100: 15.0}  # Hz → %
CURVES = ((0.7, 1.0), (-0.7, 1.0), (0.4, 1.8))  # m/s, rad/s
GAINS = (0.5, 1.0, 1.5)  # of a drive that closes the loop of its speed, of those that its robot needs
DELAYS = (0, 10, 20)  # ms, cycles of 1 ms


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
        found = []
        for speed, direction, slope in itertools.product(speeds, (1, -1), measured.SLOPES):
            error, predicted = measured.stop_error(robot, direction * speed, slope, silence=silence)
            found.append(Figure(name, 1e3 * error, 1e3 * max(0.03 * predicted, 0.005), "mm"))
        figures.append(nearest_to_its_bound(found))
    return figures


def nearest_to_its_bound(figures: list[Figure]) -> Figure:
    """The figure that is the largest part of its bound."""
    return max(figures, key=lambda figure: abs(figure.value) / figure.bound)


def drives_of_velocity(robot: str) -> list[Figure]:
    """Robots whose drives close the loops of their speeds, over all gains and delays of these drives. A stop may be
    longer by what the robot drives during the delay. The robot states the response time of its drives, as it is
    measured. The speed leads by it where they take no torque.
    """
    figures = []
    for name, takes_torque in (("", True), (", without feed-forward", False)):
        straight, stops = [], []
        for gain, delay in itertools.product(GAINS, DELAYS):
            plant = {"drive_gain": gain, "actuator_delay": delay, "drive_feed_forward": takes_torque}
            response = measured.response_time(robot, plant)
            params = for_drives("velocity", {"robot": {"wheel_response_time": response}, "mujoco_plant": plant})
            straight += [measured.straight(robot, direction * FULL, params=params) for direction in (1, -1)]
            for speed, slope, silence in itertools.product((0.1, FULL), measured.SLOPES, (False, True)):
                error, predicted = measured.stop_error(robot, speed, slope, silence=silence, params=params)
                allowed = 0.05 * predicted + 1e-3 * delay * speed
                stops.append(Figure(f"stop distance{name}", 1e3 * error, 1e3 * allowed, "mm"))
        figures += [
            Figure(f"tracking RMS{name}", 100 * max(run.rms for run in straight), 3, "%"),
            Figure(f"overshoot{name}", 100 * max(run.overshoot for run in straight), 2, "%"),
            nearest_to_its_bound(stops),
        ]
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


def promises(robot: str, wheel_command: str) -> Iterator[Figure]:
    """All promises of `robot`; standing and hand-over apply to the own robot, whose brakes are known."""
    if wheel_command == "velocity":
        yield from drives_of_velocity(robot)
        return
    parts: list[Callable[[str], list[Figure]]] = [straight, curves, stops]
    for part in [*parts, rest, coarse_encoders, peer] if robot == DIFFBOT else parts:
        yield from part(robot)


def bench(say: Say, wheel_command: str = "torque") -> Result:
    """The result, and whether every present robot keeps every promise."""
    rows, absent, good = [], [], True
    for robot in ROBOTS:
        if robot not in robot_names():
            absent.append(robot)
            continue
        for figure in promises(robot, wheel_command):
            good = good and figure.good
            if not figure.good:
                say(f"{robot}: {figure.name} {figure.value:.4g} {figure.unit}, allowed {figure.bound:.4g}")
            ratio = float(np.abs(figure.value) / figure.bound)
            row = {"name": f"{robot} {figure.name}", "value": figure.value, "unit": figure.unit}
            rows.append(row | {"reference": figure.bound, "reference_name": "what is allowed", "ratio": ratio})
    return {"bench": "drive", "rows": rows, "not_judged": absent}, good
