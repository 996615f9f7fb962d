"""calibrate.py finds hidden errors in virtual time: its pilot drives the closed loop."""

import math

import numpy as np
import pytest
import yaml
from robot_control import ClosedLoop
from robot_control.robot.pose import Pose
from robot_control.setup.calibrate.evaluation import evaluate, wheels_of
from robot_control.setup.calibrate.law import Square, Straight, Truth, fit, largest_mean_return_error
from robot_control.setup.calibrate.moves import Pilot, square, straight

LEFT, RIGHT, BASE = 0.012, 0.004, 0.02
HIDDEN = {
    "sensor_errors": "data_sheet",  # these tests judge the fit
    "left_radius_error": LEFT,
    "right_radius_error": RIGHT,
    "wheel_base_error": BASE,
}
CYCLES = 20  # between two commands: the 50 Hz of wheel_odom
SIDE = 4.0  # m
WAYS = (True, False)


def pose_of(log, name):
    return Pose(*(float(log[f"{name}_{part}"][-1]) for part in ("x", "y", "yaw")))


def drive(loop, moves, speed=0.3):
    """(n, 3) path by wheel odometry; the true end and the estimated one, seen from the start."""
    pilot = Pilot(moves, speed, turn_speed=0.6)
    loop.command(0.0, 0.0)
    log = loop.step(1000)  # at rest: a moment in which the gyro's bias is learned
    start = {name: pose_of(log, name) for name in ("truth", "estimate")}
    path = [pose_of(log, "wheel_odom")]
    while not pilot.done:
        loop.command(*pilot.command(path[-1], loop.time))
        log = loop.step(CYCLES)
        path.append(pose_of(log, "wheel_odom"))
    ends = {name: pose_of(log, name).seen_from(start[name]) for name in start}
    return np.array([(p.x, p.y, p.yaw) for p in path]), ends["truth"], ends["estimate"]


def drive_squares(loop):
    """Drives squares both ways; returns m by which the estimate's mean return errs in the worse direction as well."""
    squares, wrong = [], []
    for clockwise in WAYS:
        path, truth, estimate = drive(loop, square(SIDE, clockwise=clockwise))
        squares.append(Square(path, truth, clockwise))
        wrong.append(math.dist(truth, estimate))
    return squares, max(wrong)


@pytest.fixture(scope="module")
def before():
    """Loop, straight drives, squares and error of the estimate: uncalibrated, without a gyro."""
    parameters = {"mujoco_plant": HIDDEN, "state_estimator": {"self_calibration": False}}
    loop = ClosedLoop(parameters, seed=1)
    loop.inject_fault("gyro", "off")  # a gyro would correct the wheels' errors
    straights = []
    for _ in range(2):
        path, truth, _ = drive(loop, straight(3.0))
        straights.append(Straight(path, math.hypot(*truth)))
    squares, wrong = drive_squares(loop)
    return loop, straights, squares, wrong


@pytest.fixture(scope="module")
def outcome(before):
    loop, straights, squares, _ = before
    return evaluate(loop.robot, straights, squares, SIDE)


def test_finds_the_hidden_wheels(before):
    loop, straights, squares, _ = before
    truth = fit(straights, squares, wheels_of(loop.robot))
    assert truth.scale == pytest.approx(1 + (LEFT + RIGHT) / 2, rel=0.002)
    assert truth.ratio == pytest.approx((1 + RIGHT) / (1 + LEFT), rel=0.001)
    assert truth.base == pytest.approx(1 + BASE, rel=0.005)


def test_makes_the_odometry_of_squares_ten_times_better(before, outcome):
    """The squares have another seed; wheel odometry is replayed, and the estimator drives them without a gyro."""
    parameters = yaml.safe_load(outcome.yaml)
    parameters["state_estimator"] |= {"self_calibration": False}
    loop = ClosedLoop({**parameters, "mujoco_plant": HIDDEN}, seed=2)
    loop.inject_fault("gyro", "off")
    squares, wrong = drive_squares(loop)
    _, _, uncalibrated, wrong_before = before
    nominal = wheels_of(before[0].robot)
    ratio = Truth(ratio=parameters["state_estimator"]["radius_ratio"])
    raw = largest_mean_return_error(uncalibrated, nominal, Truth())
    calibrated = largest_mean_return_error(squares, wheels_of(loop.robot), ratio)
    print(
        f"raw {1000 * raw:.0f} mm → {1000 * calibrated:.1f} mm; estimate {1000 * wrong_before:.0f} → {1000 * wrong:.1f}"
    )
    assert calibrated < raw / 10
    assert wrong < wrong_before / 10
