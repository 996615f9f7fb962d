"""A sensor fails for a short time while the robot drives; then the robot stands for 20 s and drives again.

One drive in lockstep is recorded, and its samples are spoiled afterwards. The controllers use no pose, so the sensors'
data do not depend on the estimate. The reference is the same drive with healthy sensors.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
from robot_control import ClosedLoop, Estimator
from robot_control.loop.estimator import Estimate

from bench.odometry.program import PERIOD, Array, Program

SENSORS = ("gyro", "accelerometer", "left encoder", "both encoders")
DURATIONS = (0.02, 0.3, 1.0, 3.0)  # s
BEGIN = 7.0  # s, of the fault: two seconds after the robot set off
STOPPED, SETTLED, AGAIN = 12.5, 14.5, 32.0  # s: at rest, 2 s later, before it sets off again
GYRO, FORCE = 5.0, 30.0  # rad/s, m/s²: size of the wrong values
ANGLE = 5.0  # rad, of an encoder

Spoil = Callable[[Array, float, np.random.Generator], Array]


def _garbage(values: Array, size: float, random: np.random.Generator) -> Array:
    return np.asarray(random.uniform(-size, size, values.shape))


def _stuck(values: Array, _size: float, _random: np.random.Generator) -> Array:
    return np.asarray(np.broadcast_to(values[0], values.shape))


def _offset(values: Array, size: float, _random: np.random.Generator) -> Array:
    return np.asarray(values + size / 5)


def _zero(values: Array, _size: float, _random: np.random.Generator) -> Array:
    return np.zeros_like(values)


def _absent(values: Array, _size: float, _random: np.random.Generator) -> Array:
    return np.full_like(values, np.nan)


KINDS: dict[str, Spoil] = {
    "garbage": _garbage,
    "stuck": _stuck,
    "offset": _offset,
    "zero": _zero,
    "absent": _absent,
}
COMBINATIONS = tuple(product(KINDS, SENSORS, DURATIONS))


@dataclass(frozen=True)
class Drive:
    """(N,) s, rad, rad and (N, 3) rad/s, m/s² measured; `x`, `y` m and `yaw` rad true."""

    time: Array
    left: Array
    right: Array
    gyro: Array
    accel: Array
    x: Array
    y: Array
    yaw: Array

    def row(self, time: float) -> int:
        """Row of that time, s."""
        return int(np.searchsorted(self.time, time))


@dataclass(frozen=True)
class Verdict:
    """Verdict on one combination.

    Attributes:
        speed: m/s, two seconds after the rest began.
        tilt: degrees between up then and the true one: the floor is level.
        ratio: of the forward speed in the drive that follows, over the wheels'; the worst second.
        path: m, error at the end of that drive, beside what the undisturbed estimate has.
        plain: m, error of the undisturbed estimate.
        distance: m of that drive.
    """

    speed: float
    tilt: float
    ratio: float
    path: float
    plain: float
    distance: float

    def broken(self) -> list[str]:
        """The bounds that do not hold."""
        allowed = max(2 * self.plain, 0.005 * self.distance)
        found = []
        if not self.speed <= 0.002:
            found.append(f"speed at rest {self.speed:.4f} m/s")
        if not self.tilt <= 0.5:
            found.append(f"tilt {self.tilt:.2f}°")
        if not self.ratio <= 0.05:
            found.append(f"speed off by {100 * self.ratio:.0f} %")
        if not self.path <= allowed:
            found.append(f"path {self.path:.3f} m, allowed {allowed:.3f}")
        return found


def drive(seed: int = 0) -> Drive:
    """Drives with the errors of a data sheet."""
    program = Program()
    program.stand(5.0)
    program.drive(0.5, 0.3, 6.0)
    program.stand(22.0)
    program.drive(0.4, -0.2, 10.0)
    program.drive(0.5, 0.3, 4.0)
    program.stand(2.0)
    params = {"mujoco_plant": {"sensor_errors": "data_sheet"}}
    log = ClosedLoop(params=params, seed=seed).record(program.commands)
    x, y, z, w = log["orientation"].T
    yaw = np.unwrap(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
    wheels = log["wheel_position"]
    return Drive(
        PERIOD * np.arange(len(wheels)),
        wheels[:, 0].copy(),
        wheels[:, 1].copy(),
        log["gyro"],
        log["accel"],
        log["position"][:, 0],
        log["position"][:, 1],
        yaw,
    )


def estimate(sound: Drive, kind: str | None = None, sensor: str = "", duration: float = 0.0) -> Estimate:
    """Estimate of the drive with that fault."""
    samples = {
        "left": sound.left.copy(),
        "right": sound.right.copy(),
        "gyro": sound.gyro.copy(),
        "accel": sound.accel.copy(),
    }
    if kind is not None:
        rows = slice(sound.row(BEGIN), sound.row(BEGIN + duration))
        sizes = {"gyro": GYRO, "accel": FORCE, "left": ANGLE, "right": ANGLE}
        spoiled = {"gyro": ["gyro"], "accelerometer": ["accel"], "left encoder": ["left"]}.get(
            sensor, ["left", "right"]
        )
        random = np.random.default_rng([len(kind), len(sensor), round(1000 * duration)])
        for name in spoiled:
            samples[name][rows] = KINDS[kind](samples[name][rows], sizes[name], random)
    out: Estimate = Estimator().process(sound.time, *samples.values(), every=10, covariance=False)
    return out


def judge(sound: Drive, plain: Estimate, spoiled: Estimate) -> Verdict:
    """`plain`: the undisturbed estimate."""
    time = sound.time[::10]
    settled, again = (int(np.searchsorted(time, moment)) for moment in (SETTLED, AGAIN))
    apart = float(np.rad2deg(np.arccos(np.clip(_vertical(spoiled["attitude"][settled]), -1.0, 1.0))))
    moves = np.abs(spoiled["wheel_linear"]) > 0.1
    moves[:again] = False
    off = np.where(moves, np.abs(spoiled["linear"][:, 0] / np.where(moves, spoiled["wheel_linear"], 1) - 1), 0)
    worst = max(float(np.mean(off[i : i + 100])) for i in range(again, len(off) - 100, 100))
    true = np.column_stack([sound.x, sound.y, sound.yaw])[::10]
    steps = np.hypot(*np.diff(true[again:, :2], axis=0).T)
    errors = [float(np.hypot(*(_relative(_path(out), again) - _relative(true, again)))) for out in (plain, spoiled)]
    speed = float(np.hypot(*spoiled["linear"][settled, :2]))
    return Verdict(speed, apart, worst, errors[1], errors[0], float(steps.sum()))


def _path(out: Estimate) -> Array:
    return np.column_stack([out["x"], out["y"], out["yaw"]])


def _relative(path: Array, begin: int) -> Array:
    """m: the last row in the axes of row `begin`."""
    dx, dy = path[-1, :2] - path[begin, :2]
    cos, sin = np.cos(path[begin, 2]), np.sin(path[begin, 2])
    return np.array([cos * dx + sin * dy, cos * dy - sin * dx])


def _vertical(attitude: Array) -> float:
    """Vertical component of the robot's z axis."""
    x, y, _, _ = attitude
    return float(1 - 2 * (x * x + y * y))
