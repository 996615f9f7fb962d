"""Summarises the end of an estimate in a few lines."""

import math
from collections.abc import Iterator

import numpy as np

from robot_control._robot_control import slip_detection
from robot_control.data.estimate.samples import IntArray, Robot, Samples
from robot_control.files.files import escaped_lines
from robot_control.loop.estimator import DEGRADED_REASONS, FLAGS, SENSORS, SLIP_REASONS, Estimate

DEGREE = math.pi / 180


class Summary:
    """Durations of the states, and the last row."""

    def __init__(self) -> None:
        self.seconds = {"slip": 0.0, "standstill": 0.0, "degraded": 0.0, "invalid": 0.0}
        self.reasons = 0
        self.degraded = 0
        self.last: Estimate = {}
        self._before: float | None = None  # s

    def add(self, _time_ns: IntArray, estimate: Estimate) -> None:
        """Adds rows; each counts for the time since the one before."""
        time = estimate["time"]
        steps = np.diff(time, prepend=time[0] if self._before is None else self._before)
        flags = estimate["flags"]
        for name in ("slip", "standstill", "degraded"):
            self.seconds[name] += float(steps[flags & FLAGS[name] != 0].sum())
        self.degraded |= int(np.bitwise_or.reduce(estimate["degraded"]))
        self.seconds["invalid"] += float(steps[~estimate["valid"]].sum())
        self.reasons |= int(np.bitwise_or.reduce(estimate["slip"]))
        self.last = {name: values[-1] for name, values in estimate.items()}
        self._before = float(time[-1])

    def report(self, samples: Samples, robot: Robot) -> str:
        """The report for a user."""
        warnings, notes = (("warning", text) for text in samples.warnings), (("note", text) for text in samples.notes)
        lines = (*warnings, *self._lines(samples, robot), *notes)
        return escaped_lines(f"{name:<16}{text}" for name, text in lines)

    def _lines(self, samples: Samples, robot: Robot) -> Iterator[tuple[str, str]]:
        last, seconds = self.last, self.seconds
        x, y, yaw = np.sqrt(np.maximum(np.diagonal(last["pose_covariance"]), 0))[[0, 1, 5]].tolist()
        rates = ", ".join(f"{name} {rate:.4g} Hz" for name, rate in samples.rates().items())
        yield "recording", f"{samples.duration:.3f} s, {samples.time_ns.size} rows; {rates}"
        yield "robot", _robot(robot)
        yield "distance", f"{last['distance']:.3f} m"
        end = f"x {last['x']:.3f} ± {x:.3f} m, y {last['y']:.3f} ± {y:.3f} m"
        yield "end pose", f"{end}, yaw {last['yaw'] / DEGREE:.2f} ± {yaw / DEGREE:.2f}°"
        wheels = f"x {last['wheel_x']:.3f} m, y {last['wheel_y']:.3f} m"
        yield "by wheels only", f"{wheels}, yaw {last['wheel_yaw'] / DEGREE:.2f}°"
        bias = zip(last["gyro_bias"] / DEGREE, last["gyro_bias_deviation"] / DEGREE, strict=True)
        yield "gyro bias", f"{', '.join(f'{b:.3f} ± {s:.3f}' for b, s in bias)} °/s about x, y, z"
        ratio, deviation = float(last["radius_ratio"]), float(last["radius_ratio_deviation"])
        yield "wheel radii", _calibrated("right/left", ratio, deviation)
        yield "wheel base", _base(robot, last)
        yield "standing", f"{seconds['standstill']:.1f} s"
        yield "slip", self._slip()
        yield "slip detection", slip_detection(float(last["residual_level"]))
        yield "rejected", _rejected(last, samples)
        if self.degraded:
            names = [name for name, bit in DEGRADED_REASONS.items() if self.degraded & bit]
            yield "degraded", f"{seconds['degraded']:.1f} s ({', '.join(names)})"
        if seconds["invalid"] > 0:
            yield "not valid", f"{seconds['invalid']:.1f} s"

    def _slip(self) -> str:
        names = [name for name, bit in SLIP_REASONS.items() if self.reasons & bit]
        return f"{self.seconds['slip']:.1f} s" + (f" ({', '.join(names)})" if names else "")


def _robot(robot: Robot) -> str:
    radii = sorted({wheel["radius"] for wheel in robot["wheels"]})
    text = f"{robot['source']}: {len(robot['wheels'])} wheels of {' and '.join(f'{radius:.6g}' for radius in radii)} m"
    return f"{text}, effective wheel base {robot['effective_wheel_base']:.6g} m"


def _calibrated(what: str, value: float, deviation: float) -> str:
    return f"{what} {value:.5f} ± {deviation:.5f} of what was given" if deviation > 0 else f"{what} as given"


def _base(robot: Robot, last: Estimate) -> str:
    text = _calibrated("×", float(last["wheel_base_factor"]), float(last["wheel_base_deviation"]))
    if last["wheel_base_deviation"] <= 0:
        return "as given"
    return f"{text}: {robot['effective_wheel_base'] * last['wheel_base_factor']:.4f} m effective"


def _rejected(last: Estimate, samples: Samples) -> str:
    some = [f"{name} {count}" for name, count in zip(SENSORS, last["rejected"].tolist(), strict=True) if count]
    return (", ".join(some) or "none") + f" of {samples.time_ns.size} rows"
