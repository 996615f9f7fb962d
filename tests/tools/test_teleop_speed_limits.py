"""The robot's limits of speed, as teleop.py takes them."""

from pathlib import Path
from types import SimpleNamespace

import pytest
import rospy
import yaml
from robot_control.installed_files import share_file
from robot_control.teleop.operator import Command
from robot_control.teleop.speed_limits import SpeedLimits


@pytest.fixture
def subscribed(monkeypatch):
    callbacks = {}
    monkeypatch.setattr(rospy, "Subscriber", lambda topic, _, callback, **__: callbacks.update({topic: callback}))
    return callbacks


def config(**values):
    return SimpleNamespace(doubles=[SimpleNamespace(name=name, value=value) for name, value in values.items()])


def test_until_the_controller_reports_its_limits_those_of_the_file_hold(subscribed):
    controller = yaml.safe_load(Path(share_file("config/robot_params.yaml")).read_text())["diff_drive_controller"]
    assert SpeedLimits().newest() == Command(controller["max_linear_speed"], controller["max_angular_speed"])


def test_what_the_controller_reports_holds(subscribed):
    limits = SpeedLimits()
    receive = subscribed["diff_drive_controller/parameter_updates"]
    receive(config(pid_kp=9.0, max_linear_speed=0.3, max_angular_speed=0.7))
    assert limits.newest() == Command(0.3, 0.7)
    receive(config(max_linear_speed=0.4))
    assert limits.newest() == Command(0.4, 0.7)
