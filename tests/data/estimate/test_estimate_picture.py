"""Every item in the legends of an estimate's picture is visible, or its size is readable."""

import numpy as np
import pytest
from robot_control import Estimator
from robot_control.data.estimate import picture as estimate_picture
from robot_control.data.estimate.picture import Picture

SECONDS, STEP = 12.0, 0.01


@pytest.fixture
def panels(monkeypatch, tmp_path):
    """Panels of a second of rest, a ramp and a curve, with or without an IMU; axes: path, yaw, speeds, gyro bias."""

    def draw(*, imu):
        time = np.arange(0, SECONDS, STEP)
        speed = 5 * np.clip(time - 1, 0, 1)  # rad/s of the wheels' mean, a ramp of a second
        angle = np.cumsum(speed) * STEP  # rad
        gyro = np.zeros((time.size, 3))
        gyro[:, 2] = speed * 0.1 * 0.2 / 0.5
        accel = np.tile([0, 0, 9.81], (time.size, 1))
        accel[:, 0] = np.where((time > 1) & (time <= 2), 0.5, 0)
        accel[:, 1] = 0.1 * speed * gyro[:, 2]
        estimator = Estimator(wheel_radius=0.1, wheel_base=0.5)
        out = estimator.process(time, 0.9 * angle, 1.1 * angle, gyro if imu else None, accel if imu else None)
        picture = Picture(time.size)
        picture.add(np.round(time * 1e9).astype(np.int64), out)
        figures = []
        monkeypatch.setattr(estimate_picture.plt, "close", figures.append)
        picture.draw(tmp_path / "estimate.png", "title")
        monkeypatch.undo()
        estimate_picture.plt.close(figures[-1])
        return figures[-1].axes

    return draw


def labels(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def test_wheels_and_estimate_can_be_distinguished_where_they_agree(panels):
    for axes in panels(imu=True)[:2]:
        width = {line.get_label(): line.get_linewidth() for line in axes.lines}
        assert width["wheels alone"] > 2 * width["estimate"]


def test_an_uncertainty_too_small_to_see_is_said_as_a_number(panels):
    path, yaw, *_ = panels(imu=True)
    assert any(label.startswith("95 %, at the end ± 0.") and label.endswith(" m") for label in labels(path))
    assert any(label.startswith("± 2 σ, at the end ± ") and label.endswith("°") for label in labels(yaw))


def test_without_a_gyro_its_panel_says_so_and_is_empty(panels):
    bias = panels(imu=False)[3]
    assert "no gyro in the recording" in bias.texts[0].get_text()
    assert not bias.lines
    assert not bias.collections


def test_a_bias_is_drawn_from_when_it_is_known(panels):
    bias = panels(imu=True)[3]
    for line in bias.lines:
        values = line.get_ydata()
        assert np.isnan(values[0])
        assert np.isfinite(values[-1])


def test_speeds_from_wheels_alone_show_the_motion_and_not_the_counts():
    time_ns = np.arange(0, 2_000_000_000, 1_000_000)
    noisy = np.zeros((time_ns.size, 3))
    noisy[:, 2] = 0.2 + np.where(np.arange(time_ns.size) % 2 == 0, 0.3, -0.3)  # rad/s
    mean = estimate_picture._mean_of_neighbours(noisy, time_ns)
    assert np.abs(mean[100:-100, 2] - 0.2).max() < 0.01
    slow = np.arange(6.0).reshape(2, 3)
    assert estimate_picture._mean_of_neighbours(slow, np.array([0, 10**9])) is slow
