"""Each kind of fault of each sensor lasts 20 ms … 3 s, and leaves no error of speed and path after 20 s of rest.

A gyro or accelerometer that fails in motion may leave a tilt: one rest shows only its sum with the bias.

One drive in lockstep is recorded, and its samples are spoiled afterwards. The controllers use no pose, so the sensors'
data do not depend on the estimate. The reference is the same drive with healthy sensors.
"""

from itertools import product

import numpy as np
import pytest
from robot_control import ClosedLoop, Estimator

from bench.odometry.program import PERIOD, Program

SENSORS = ("gyro", "accelerometer", "left encoder", "both encoders")
DURATIONS = (0.02, 0.3, 1.0, 3.0)  # s
BEGIN = 7.0  # s, of the fault: two seconds after the robot set off
STOPPED, SETTLED, AGAIN = 12.5, 14.5, 32.0  # s: at rest, 2 s later, before it sets off again
GYRO, FORCE = 5.0, 30.0  # rad/s, m/s²: size of the wrong values
ANGLE = 5.0  # rad, of an encoder
TILTS = {"gyro": 4.0, "accelerometer": 2.0}  # °; the accelerometer's bias of 0.39 m/s² makes 2.3

# of the values, the size of a wrong one and a generator of random numbers
KINDS = {
    "garbage": lambda values, size, random: random.uniform(-size, size, values.shape),
    "stuck": lambda values, size, random: np.broadcast_to(values[0], values.shape),
    "offset": lambda values, size, random: values + size / 5,
    "zero": lambda values, size, random: np.zeros_like(values),
    "absent": lambda values, size, random: np.full_like(values, np.nan),
}
COMBINATIONS = tuple(product(KINDS, SENSORS, DURATIONS))


def drive():
    """Measured samples s, rad, rad, rad/s, m/s², and the true path in m, m, rad, with the errors of a data sheet."""
    program = Program()
    program.stand(5.0)
    program.drive(0.5, 0.3, 6.0)
    program.stand(22.0)
    program.drive(0.4, -0.2, 10.0)
    program.drive(0.5, 0.3, 4.0)
    program.stand(2.0)
    params = {"mujoco_plant": {"sensor_errors": "data_sheet"}}
    log = ClosedLoop(params=params).record(program.commands)
    x, y, z, w = log["orientation"].T
    yaw = np.unwrap(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
    wheels = log["wheel_position"]
    samples = {"left": wheels[:, 0], "right": wheels[:, 1], "gyro": log["gyro"], "accel": log["accel"]}
    return PERIOD * np.arange(len(wheels)), samples, np.column_stack([log["position"][:, :2], yaw])


def estimate(sound, kind=None, sensor="", duration=0.0):
    """Estimate of the drive with that fault."""
    time, samples = sound[0], {name: values.copy() for name, values in sound[1].items()}
    if kind is not None:
        rows = slice(*np.searchsorted(time, (BEGIN, BEGIN + duration)))
        sizes = {"gyro": GYRO, "accel": FORCE, "left": ANGLE, "right": ANGLE}
        spoiled = {"gyro": ["gyro"], "accelerometer": ["accel"], "left encoder": ["left"]}.get(
            sensor, ["left", "right"]
        )
        random = np.random.default_rng([len(kind), len(sensor), round(1000 * duration)])
        for name in spoiled:
            samples[name][rows] = KINDS[kind](samples[name][rows], sizes[name], random)
    return Estimator().process(time, *samples.values(), every=10, covariance=False)


def judge(sound, plain, spoiled, tilt=0.5):
    """The bounds that do not hold. Speed and tilt are those two seconds after the rest began. The drive that follows
    counts with the worst second of the forward speed over the wheels', and with its end. The path of the undisturbed
    estimate `plain` bounds it. `tilt` is in degrees.
    """
    time, true = sound[0][::10], sound[2][::10]
    settled, again = np.searchsorted(time, (SETTLED, AGAIN))
    apart = float(np.rad2deg(np.arccos(np.clip(_vertical(spoiled["attitude"][settled]), -1.0, 1.0))))
    moves = np.abs(spoiled["wheel_linear"]) > 0.1
    moves[:again] = False
    off = np.where(moves, np.abs(spoiled["linear"][:, 0] / np.where(moves, spoiled["wheel_linear"], 1) - 1), 0)
    worst = max(float(np.mean(off[i : i + 100])) for i in range(again, len(off) - 100, 100))
    steps = np.hypot(*np.diff(true[again:, :2], axis=0).T)
    errors = [float(np.hypot(*(_relative(_path(out), again) - _relative(true, again)))) for out in (plain, spoiled)]
    speed = float(np.hypot(*spoiled["linear"][settled, :2]))
    allowed = max(2 * errors[0], 0.005 * steps.sum())
    bounds = [
        ("speed at rest", speed, 0.002),
        ("tilt", apart, tilt),
        ("speed", worst, 0.05),
        ("path", errors[1], allowed),
    ]
    return [f"{name} {value:.4f}, allowed {bound:.4f}" for name, value, bound in bounds if not value <= bound]


def _path(out):
    return np.column_stack([out["x"], out["y"], out["yaw"]])


def _relative(path, begin):
    """m: the last row in the axes of row `begin`."""
    dx, dy = path[-1, :2] - path[begin, :2]
    cos, sin = np.cos(path[begin, 2]), np.sin(path[begin, 2])
    return np.array([cos * dx + sin * dy, cos * dy - sin * dx])


def _vertical(attitude):
    """Vertical component of the robot's z axis."""
    x, y, _, _ = attitude
    return float(1 - 2 * (x * x + y * y))


QUICK = {
    ("garbage", "gyro", 0.02),
    ("garbage", "accelerometer", 0.02),
    ("stuck", "left encoder", 1.0),
    ("absent", "left encoder", 1.0),
}


@pytest.fixture(scope="module")
def sound():
    return drive()


@pytest.fixture(scope="module")
def undisturbed(sound):
    return estimate(sound)


def test_sound_sensors_leave_nothing_behind_either(sound, undisturbed):
    assert not judge(sound, undisturbed, undisturbed)


@pytest.mark.parametrize(
    "combination",
    [
        pytest.param(one, id="-".join(str(word) for word in one), marks=() if one in QUICK else pytest.mark.nightly)
        for one in COMBINATIONS
    ],
)
def test_a_short_fault_is_forgotten_after_a_rest(sound, undisturbed, combination):
    tilt = TILTS.get(combination[1], 0.5)
    assert not judge(sound, undisturbed, estimate(sound, *combination), tilt)
