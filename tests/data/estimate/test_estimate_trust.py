"""estimate.py reports if its result cannot be trusted, and which sensor it did not use."""

import math

import numpy as np
import pytest
from robot_control.data.estimate.samples import Samples
from robot_control.data.estimate.trust import Trust
from robot_control.loop.estimator import FLAGS

ROWS = 101
TIME = np.arange(ROWS) * 100_000_000  # ns: 10 s at 10 Hz


@pytest.fixture
def estimate():
    """A healthy estimate: 10 m, the yaw known to 1°."""
    covariance = np.zeros((ROWS, 6, 6))
    covariance[:, 5, 5] = math.radians(1) ** 2
    return {
        "time": (TIME - TIME[0]) / 1e9,
        "flags": np.full(ROWS, FLAGS["valid"]),
        "distance": np.linspace(0, 10, ROWS),
        "pose_covariance": covariance,
    }


@pytest.fixture
def samples():
    return Samples(TIME, np.zeros(ROWS), np.zeros(ROWS), np.zeros((ROWS, 3)), np.zeros((ROWS, 3)))


def doubts(estimate, samples, pieces=1):
    trust = Trust()
    for rows in np.array_split(np.arange(ROWS), pieces):
        trust.add(TIME[rows], {name: values[rows] for name, values in estimate.items()})
    return trust.doubts(samples)


def test_a_healthy_estimate_leaves_no_doubt(estimate, samples):
    assert doubts(estimate, samples) == []


def test_a_yaw_that_is_not_known_is_said(estimate, samples):
    estimate["pose_covariance"][:, 5, 5] = math.radians(36) ** 2
    assert doubts(estimate, samples) == ["not to be trusted: the last yaw is known to ± 36°"]


@pytest.mark.parametrize("pieces", [1, 7])
def test_slip_on_much_of_the_distance_is_said_but_not_on_a_part_of_it(estimate, samples, pieces):
    estimate["flags"][1:16] |= FLAGS["slip"]
    assert doubts(estimate, samples, pieces) == []
    estimate["flags"][1:31] |= FLAGS["slip"]
    (said,) = doubts(estimate, samples, pieces)
    assert said.startswith("not to be trusted: slip on 30 % of the distance")


def test_slip_at_rest_is_no_distance(estimate, samples):
    estimate["distance"] = np.concatenate([np.zeros(60), np.linspace(0, 10, ROWS - 60)])
    estimate["flags"][1:60] |= FLAGS["slip"]
    assert doubts(estimate, samples) == []


def test_a_sensor_that_is_there_and_was_not_used_is_said(estimate, samples):
    estimate["flags"] |= FLAGS["no_accelerometer"]
    (said,) = doubts(estimate, samples)
    assert said.startswith("the accelerometer was not used during 100 % of the time: its samples come at 10 Hz")
    samples.accel = None
    assert doubts(estimate, samples) == []
