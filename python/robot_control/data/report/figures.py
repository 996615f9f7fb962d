"""Computes the figures of a log that budgets can bound."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from robot_control.data.intervals import intervals
from robot_control.data.loop_timing import LATENCIES, durations_ns
from robot_control.data.report.drive import Drive
from robot_control.data.report.walking import cost_of_transport, phase_steps, walked_speed
from robot_control.data.run_log import FloatArray
from robot_control.loop.signal_names import mask_of, number_of

NAN = float("nan")
STOPPED = tuple(number_of("SupervisorState", name) for name in ("STOPPED", "FAULT"))
"""latched"""
SATURATED = mask_of("CommandReason", "saturated")
SHARES = (("p50", 50.0, "median"), ("p99", 99.0, "99 % of all cycles are below"), ("max", 100.0, "largest"))
SLIP, DEGRADED = mask_of("StateFlag", "slip"), mask_of("StateFlag", "degraded")


@dataclass(frozen=True)
class Figure:
    """One number; NaN if this log does not hold it."""

    name: str
    unit: str
    meaning: str
    value: float

    def shown(self, value: float) -> str:
        """A value or a bound of it, with its unit."""
        if np.isnan(value):
            return "–"
        if self.unit == "share":
            return f"{100 * value:.3g} %"
        digits = f"{value:.0f}" if value == round(value) and abs(value) < 1e6 else f"{value:.4g}"
        return f"{digits} {self.unit}".rstrip()


def figures(drive: Drive) -> dict[str, Figure]:
    """All of them, by name."""
    return {figure.name: figure for part in PARTS for figure in part(drive)}


def _mean_over(values: FloatArray, rows: int) -> FloatArray:
    known = values[~np.isnan(values)]
    return np.convolve(known, np.full(rows, 1.0 / rows), "valid") if known.size >= rows else known


def _largest(values: FloatArray) -> float:
    return _percentile(np.abs(values), 100)


def _percentile(values: FloatArray, share: float) -> float:
    known = values[~np.isnan(values)]
    return float(np.percentile(known, share)) if known.size else NAN


def _rms(values: FloatArray) -> float:
    known = values[~np.isnan(values)]
    return float(np.sqrt(np.mean(known**2))) if known.size else NAN


def _log(drive: Drive) -> Iterator[Figure]:
    cycles = drive.log["cycle"]
    missing = float(cycles[-1] - cycles[0] + 1 - cycles.size)
    lost = missing if drive.lost is None else float(drive.lost)
    yield Figure("rows_lost", "", "cycles that should be in the log and are not", lost)
    for node, column in (("estimator", "estimate_x"), ("controller", "command_reasons"), ("monitor", "permit_action")):
        values = drive.log.get(column)
        share = NAN if values is None else float(np.mean(np.isnan(values)))
        yield Figure(f"{node}_absent", "share", f"cycles without a row of the {node}", share)


def _safety(drive: Drive) -> Iterator[Figure]:
    state = drive.column("supervisor_state")
    stops = intervals(np.isin(state, STOPPED), state)
    yield Figure("latched_stops", "", "stops that needed a reset", float(len(stops)))
    braked = float(len(intervals(drive.gate_braked()))) if drive.has("gate_verdict") else NAN
    yield Figure("gate_brakes", "", "times that the gate braked while driving", braked)
    refused = drive.count("refused")
    yield Figure("frames_refused", "", "frames that the gate refused: checksum, cycle or content", refused)


def _tracking(drive: Drive) -> Iterator[Figure]:
    """A body on legs sways within each period of its gait. Its error is the mean over one, from the speed that is the
    target of the walk.
    """
    driving = drive.driving()
    steps = phase_steps(drive)
    period = round(1 / np.median(steps[steps > 0])) if (steps > 0).any() else 1
    for axis, unit in (("linear", "m/s"), ("angular", "rad/s")):
        commanded = walked_speed(drive) if axis == "linear" else drive.column("limited_angular")
        error = _mean_over((commanded - drive.column(f"estimate_{axis}"))[driving], period)
        meaning = f"commanded minus estimated {axis} speed while driving, RMS"
        yield Figure(f"{axis}_error_rms", unit, meaning, _rms(error))
        meaning = "the same, 99 % of all cycles are below"
        yield Figure(f"{axis}_error_p99", unit, meaning, _percentile(np.abs(error), 99))


def _estimate(drive: Drive) -> Iterator[Figure]:
    driving = drive.driving()
    flags = drive.bits("estimate_flags")
    for name, bit, meaning in (
        ("slip", SLIP, "wheels and inertial sensors disagree"),
        ("degraded", DEGRADED, "a correction undone, or no gyro bias yet"),
    ):
        if drive.kind.legged:
            yield Figure(name, "share", "the estimate of a robot on legs has none", NAN)
        else:
            share = float(np.mean(flags[driving] & bit != 0)) if driving.any() else NAN
            yield Figure(name, "share", f"of the time while driving: {meaning}", share)
    for sensor in filter(drive.uses, ("left_encoder", "right_encoder", "gyro", "accelerometer")):
        name = f"confidence_{sensor}"
        low = _percentile(drive.column(name)[driving], 1)
        yield Figure(name, "share", f"confidence in the {sensor.replace('_', ' ')}, 99 % of the time above", low)
    yield Figure("distance", "m", "travelled, as estimated", _largest(drive.column("estimate_distance")))
    yield from _position_error(drive)


def _position_error(drive: Drive) -> Iterator[Figure]:
    error, deviation = position_error(drive)
    distance = _largest(drive.column("estimate_distance"))
    share = _largest(error) / distance if distance > 1 else NAN
    yield Figure(
        "position_error",
        "share",
        "largest distance between true and estimated position, as a share of the distance",
        share,
    )
    known = ~np.isnan(error) & (deviation > 0)
    ratio = float(np.mean(error[known] > 2.45 * deviation[known])) if known.any() else NAN  # χ², 2 axes, 95 %
    meaning = "of the time: true position outside the 95 % ellipse's mean radius"
    yield Figure("position_outside", "share", meaning, ratio)


def position_error(drive: Drive) -> tuple[FloatArray, FloatArray]:
    """Distance [m] of the true from the estimated position, first poses aligned; its standard deviation [m]."""
    x, y = drive.column("estimate_x"), drive.column("estimate_y")
    true_x, true_y = true_path(drive)
    spread = drive.column("estimate_x_variance") + drive.column("estimate_y_variance")
    return np.hypot(x - true_x, y - true_y), np.sqrt(np.maximum(spread, 0) / 2)


def true_path(drive: Drive) -> tuple[FloatArray, FloatArray]:
    """The true path [m], turned and shifted so that it begins as the estimate does; NaN without truth in the log."""
    names = ("truth_x", "truth_y", "truth_yaw", "estimate_x", "estimate_y", "estimate_yaw")
    x, y, yaw, own_x, own_y, own_yaw = (drive.column(name) for name in names)
    known = np.flatnonzero(~np.isnan(x) & ~np.isnan(own_x))
    if known.size == 0:
        return x, y
    first = known[0]
    turn = own_yaw[first] - yaw[first]
    dx, dy = x - x[first], y - y[first]
    return (own_x[first] + dx * np.cos(turn) - dy * np.sin(turn), own_y[first] + dx * np.sin(turn) + dy * np.cos(turn))


def _torque(drive: Drive) -> Iterator[Figure]:
    largest = max((_largest(drive.column(f"{joint}_effort")) for joint in drive.joints), default=NAN)
    yield Figure("largest_torque", "N·m", "of any joint", largest)
    driving = drive.driving()
    saturated = drive.bits("command_reasons") & SATURATED != 0
    share = float(np.mean(saturated[driving])) if driving.any() else NAN
    yield Figure("saturated", "share", "of the time while driving: a joint's torque or speed is at its limit", share)
    battery = drive.column("battery_voltage")
    yield Figure("battery_least", "V", "lowest voltage", _percentile(battery, 0))


def _walking(drive: Drive) -> Iterator[Figure]:
    meaning = "mechanical work of all joints per weight and distance while a robot on legs walks"
    yield Figure("cost_of_transport", "", meaning, cost_of_transport(drive) if drive.kind.legged else NAN)


def _timing(drive: Drive) -> Iterator[Figure]:
    for latency in LATENCIES:
        values = durations_ns(drive.log, latency) / 1000
        for name, share, words in SHARES:
            yield Figure(f"{latency.name}_{name}", "µs", f"{latency.meaning}, {words}", _percentile(values, share))
    for counter, meaning in (
        ("missed", "ticks braked for want of a command"),
        ("held", "ticks on a command of an earlier cycle"),
        ("late_permits", "ticks on a permit of an earlier cycle"),
        ("overruns", "ticks that ended after the next deadline"),
    ):
        yield Figure(counter, "", meaning, drive.count(counter))


PARTS = (_log, _safety, _tracking, _estimate, _torque, _walking, _timing)
