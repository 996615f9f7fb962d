"""The odometries for comparison, on drives whose result is known by formula."""

import dataclasses

import numpy as np
import pytest
from support.recordings.synthetic_odometry import PERIOD, drive

from bench.odometry.errors import GYRO_BIAS
from bench.odometry.methods import (
    GYRO_NOISE,
    GYRO_WALK,
    METHODS,
    STILL,
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


def test_it_stands_only_while_wheels_and_gyro_are_quiet():
    recording = drive(STAND, LINE, STAND)
    still = standing(recording)
    assert still[200:3000].all()
    assert not still[3200:13_000].any()
    assert still[13_200:].all()
    turned = dataclasses.replace(recording, gyro=recording.gyro + 0.02)
    assert not standing(turned).any(), "wheels stand, the robot is turned by hand"
