"""A gyro or an encoder is wrong for a while: the pose error stays within its covariance, or the robot stops."""

from dataclasses import dataclass
from itertools import product

import numpy as np
import pytest
from robot_control import ClosedLoop, Estimator

from bench.odometry.program import PERIOD, Program

SENSORS = ("gyro", "left_encoder")
KINDS = ("off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent")
DURATIONS = (0.5, 1.0, 3.0)  # s
COMBINATIONS = tuple(product(SENSORS, KINDS, DURATIONS))
BEGIN = 5.0  # s, of the fault: two seconds after the robot set off
RECOVERED = 1.0  # s
EVERY = 10  # cycles between two rows of the estimate


@dataclass(frozen=True)
class Outcome:
    """Errors at the end of the drive over their standard deviations; `stopped`: the monitor braked before. `speed`:
    m/s, error of the forward speed RECOVERED s after the sensor is right again.
    """

    position: float
    yaw: float
    stopped: bool
    speed: float


def outcome(sensor: str, kind: str, duration: float, seed: int) -> Outcome:
    """Outcome of one drive in curves to either side, with a rest at the end."""
    program = Program()
    program.stand(3.0)
    program.drive(0.5, 0.3, 5.0)
    program.drive(0.4, -0.4, 5.0)
    program.drive(0.5, 0.0, 4.0)
    program.stand(3.0)
    begin, end = round(BEGIN / PERIOD), round((BEGIN + duration) / PERIOD)
    loop = ClosedLoop(seed=seed)
    parts = [loop.record(program.commands[:begin])]
    loop.inject_fault(sensor, kind)
    parts.append(loop.record(program.commands[begin:end]))
    loop.inject_fault(sensor, "ok")
    parts.append(loop.record(program.commands[end:]))
    log = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    time, wheels = PERIOD * np.arange(len(log["gyro"])), log["wheel_position"]
    out = Estimator().process(time, wheels[:, 0].copy(), wheels[:, 1].copy(), log["gyro"], log["accel"], every=EVERY)
    off = np.array([out["x"][-1], out["y"][-1]]) - log["position"][-1, :2]
    x, y, z, w = log["orientation"][-1]
    yaw = out["yaw"][-1] - np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    covariance = out["pose_covariance"][-1]
    row = round((BEGIN + duration + RECOVERED) / PERIOD / EVERY)
    return Outcome(
        position=float(np.sqrt(off @ np.linalg.solve(covariance[:2, :2] + 1e-6 * np.eye(2), off))),
        yaw=float(abs(np.remainder(yaw + np.pi, 2 * np.pi) - np.pi) / np.sqrt(covariance[5, 5])),
        stopped=bool(log["stopped"][round(0.5 / PERIOD) :].any()),
        speed=float(abs(out["linear"][row, 0] - log["linear"][row * EVERY, 0])),
    )


QUICK = {("gyro", "wrong", 3.0, 0), ("gyro", "stuck", 3.0, 0), ("left_encoder", "stuck", 0.5, 0)}
SPEED = 0.02  # m/s, slip below which is none (Tuning::kMinSlipSpeed)
CASES = [(*each, seed) for seed in range(4) for each in COMBINATIONS]


@pytest.mark.parametrize(
    ("sensor", "kind", "duration", "seed"),
    [pytest.param(*case, marks=() if case in QUICK else pytest.mark.nightly) for case in CASES],
)
def test_a_lying_sensor_leaves_the_pose_within_four_deviations_or_the_robot_stops(sensor, kind, duration, seed):
    found = outcome(sensor, kind, duration, seed)
    assert found.stopped or max(found.position, found.yaw) <= 4


@pytest.mark.parametrize("seed", [pytest.param(seed, marks=pytest.mark.nightly if seed else ()) for seed in range(12)])
def test_a_second_after_a_gyro_read_backwards_the_speed_is_right_and_the_heading_within_four_deviations(seed):
    found = outcome("gyro", "wrong", 3.0, seed)
    assert found.speed <= SPEED
    assert found.stopped or found.yaw <= 4
