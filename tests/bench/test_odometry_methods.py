"""The odometries for comparison, on drives whose result is known by formula."""

import dataclasses

import numpy as np
import pytest
from support.recordings.synthetic_odometry import PERIOD, drive

from bench.odometry.errors import GYRO_BIAS, Errors, draw_errors
from bench.odometry.methods import (
    GYRO_NOISE,
    GYRO_WALK,
    METHODS,
    STILL,
    bias,
    calibrated_wheels,
    gyro_without_bias,
    raw_wheels,
    simple_odometry,
    standing,
)
from bench.odometry.truth import truth_of

STAND, ARC, LINE = (0.0, 0.0, 3.0), (0.5, 0.4, 10.0), (0.4, 0.0, 10.0)
JUMPS = 3 * 0.5 * PERIOD * 0.4  # rad: the trapezoid smears each of three jumps of 0.4 rad/s over a cycle
ROUNDING = 1e-9


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS.keys())
def test_a_robot_without_any_error_is_where_each_says(method):
    recording = drive(STAND, ARC, LINE)
    true, path = truth_of(recording).ground, method(recording)
    assert np.abs(path.yaw - true.yaw).max() <= JUMPS
    assert np.hypot(path.x - true.x, path.y - true.y).max() <= JUMPS * 9  # m, of way


def test_raw_wheels_turn_by_the_nominal_base():
    recording = drive(ARC, errors=Errors(0.0, 0.0, 0.02, 0.0))
    assert raw_wheels(recording).yaw[-1] == pytest.approx(1.02 * 4.0, abs=ROUNDING)
    assert calibrated_wheels(recording).yaw[-1] == pytest.approx(4.0, abs=ROUNDING)


def test_raw_wheels_bend_a_line_where_the_radii_differ():
    """Both wheels roll 4 m; the left one, larger by e, turns less: Δθ = 4 m (1/(1−e) − 1/(1+e))/b."""
    error = 0.005
    recording = drive(LINE, errors=Errors(error, -error, 0.0, 0.0))
    expected = 4.0 * (1 / (1 - error) - 1 / (1 + error)) / 0.5
    assert raw_wheels(recording).yaw[-1] == pytest.approx(expected, abs=ROUNDING)
    assert calibrated_wheels(recording).yaw[-1] == pytest.approx(0.0, abs=ROUNDING)


def test_the_gyro_as_it_is_drifts_by_its_bias():
    recording = drive(STAND, LINE, bias=0.002)
    assert gyro_without_bias(recording).yaw[-1] == pytest.approx(0.002 * 13.0, abs=ROUNDING)


def test_the_simple_odometry_keeps_what_its_filter_could_not_learn():
    """Of a bias b there remains (1 − K) b, K = P/(P + σ²/T); nothing while it stands."""
    recording = drive(STAND, LINE, bias=0.002)
    still = standing(recording)
    used = (still.sum() - 2 * round(STILL / PERIOD)) * PERIOD
    first = int(np.argmax(still))
    variance = GYRO_BIAS**2 + GYRO_WALK**2 * first * PERIOD
    rest = 1 - variance / (variance + GYRO_NOISE**2 / used)
    expected = 0.002 * first * PERIOD + rest * 0.002 * (13.0 - (first + still.sum()) * PERIOD)
    assert simple_odometry(recording).yaw[-1] == pytest.approx(expected, abs=2 * 0.002 * PERIOD)


def test_a_second_standstill_teaches_what_has_changed():
    recording = drive(STAND, LINE, STAND, LINE)
    recording.gyro[10_000:, 2] += 0.001
    estimated = bias(recording, standing(recording))
    assert abs(estimated[12_000]) < 1e-12
    assert 0.0001 < estimated[-1] < 0.001


def test_it_stands_only_while_wheels_and_gyro_are_quiet():
    recording = drive(STAND, LINE, STAND)
    still = standing(recording)
    assert still[200:3000].all()
    assert not still[3200:13_000].any()
    assert still[13_200:].all()
    turned = dataclasses.replace(recording, gyro=recording.gyro + 0.02)
    assert not standing(turned).any(), "wheels stand, the robot is turned by hand"


def test_errors_are_drawn_from_the_stated_priors():
    """Relative deviation of a standard deviation from n values: 1/√(2n); of a mean: 1/√n. Bounds: five of them."""
    count = 2000
    drawn = [draw_errors(seed) for seed in range(count)]
    left, base, scale = (
        np.array([getattr(each, name) for each in drawn]) for name in ("left_radius", "wheel_base", "gyro_scale")
    )
    assert all(each.left_radius == -each.right_radius for each in drawn)
    for values, deviation in ((left, 0.005), (base, 0.02), (scale, 0.001 / np.sqrt(3))):
        assert values.std() / deviation == pytest.approx(1, abs=5 / np.sqrt(2 * count))
        assert abs(values.mean()) < 5 * deviation / np.sqrt(count)
    assert np.abs(scale).max() <= 0.001
    assert draw_errors(7) == draw_errors(7)
