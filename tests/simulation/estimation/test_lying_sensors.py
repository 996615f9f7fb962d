"""A gyro or an encoder is wrong for a while: the pose error stays within its covariance, or the robot stops."""

import pytest

from bench.odometry.lying_sensors import COMBINATIONS, outcome

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
