"""How the odometry of robots on legs is judged on a recording."""

from __future__ import annotations

import numpy as np
import pytest

from bench.odometry.recorded_walks import judge, sensors_of

TIME = np.arange(0, 10, 0.005)
WAY = np.column_stack([0.3 * TIME, 0.05 * np.sin(TIME), 0.01 * np.cos(TIME)])
EULER = np.column_stack([0.02 * np.sin(TIME), 0.03 * np.cos(TIME), 0.1 * TIME])


def estimate_of(way, turns=EULER, deviation=0.02):
    """Rows of bench_legs_recording with these positions and roll, pitch, yaw."""
    half = turns / 2
    (cr, cp, cy), (sr, sp, sy) = np.cos(half).T, np.sin(half).T
    x, y = sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy
    z, w = cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy
    covariance = np.tile((deviation**2 * np.eye(6)).ravel(), (len(way), 1))
    return np.column_stack([way, x, y, z, w, np.zeros_like(way), covariance, way])


def test_an_exact_estimate_has_no_error():
    judged = judge(TIME, estimate_of(WAY), WAY, EULER)
    assert judged.rms == pytest.approx(0, abs=1e-12)
    assert judged.height == pytest.approx(0, abs=1e-12)
    assert judged.nees == pytest.approx(0, abs=1e-9)
    assert judged.slope == pytest.approx(1)


def test_a_way_that_is_short_is_seen_in_the_slope_and_the_rms():
    judged = judge(TIME, estimate_of(0.9 * WAY), WAY, EULER)
    assert judged.slope == pytest.approx(0.9)
    assert judged.rms == judged.plain_rms
    assert judged.rms == pytest.approx(0.1 * np.sqrt((0.3 * TIME) ** 2).max() / np.sqrt(3), rel=0.05)


def test_the_first_row_is_laid_on_the_truth_with_its_heading():
    cos, sin = np.cos(0.7), np.sin(0.7)
    turned = WAY @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]]) + [3, 4, 5]
    judged = judge(TIME, estimate_of(turned, EULER + np.array([0, 0, 0.7])), WAY, EULER)
    assert judged.rms == pytest.approx(0, abs=1e-9)
    assert judged.nees == pytest.approx(0, abs=1e-9)


def test_the_nees_is_that_of_the_deviations():
    off = WAY + np.concatenate([np.zeros((1, 3)), np.full((len(TIME) - 1, 3), 0.02)])
    assert judge(TIME, estimate_of(off), WAY, EULER).nees == pytest.approx(0.5, rel=0.01)


def test_feet_in_contact_share_the_weight():
    data = {
        name: np.zeros((2, width))
        for name, width in (("gyro", 3), ("accel", 3), ("joint_angle", 12), ("joint_rate", 12))
    }
    data["contact"] = np.array([[1, 1, 0, 0], [0, 0, 0, 0]])
    assert sensors_of(data, "asked")[:, 30:].tolist() == [[0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0], [0] * 8]
    assert sensors_of(data, "sensed")[0, 34:].tolist() == [0] * 4
