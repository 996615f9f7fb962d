"""The robot's limits of speed, as teleop.py takes them."""

from functools import partial
from pathlib import Path

import pytest
import yaml
from dynamic_reconfigure.msg import Config, DoubleParameter
from robot_control.drive.keys.operator import Limits
from robot_control.drive.speed_limits import SpeedLimits
from robot_control.installed_files import share_file
from robot_control.msg import RobotKind
from robot_control.robot import robot_kind
from support.topics import Topics


@pytest.fixture
def subscribed(monkeypatch):
    robot_kind.forget()
    yield Topics(monkeypatch)
    robot_kind.forget()


def config(**values):
    return Config(doubles=[DoubleParameter(name, value) for name, value in values.items()])


def test_until_the_controller_reports_its_limits_those_of_the_file_hold(subscribed):
    controller = yaml.safe_load(Path(share_file("config/robot_params.yaml")).read_text())["diff_drive_controller"]
    linear, angular = controller["max_linear_speed"], controller["max_angular_speed"]
    assert SpeedLimits().newest() == Limits(linear, angular, reverse=linear)


def test_what_the_controller_reports_holds(subscribed):
    limits = SpeedLimits()
    receive = partial(subscribed.send, "diff_drive_controller/parameter_updates")
    receive(config(pid_kp=9.0, max_linear_speed=0.3, max_angular_speed=0.7))
    assert limits.newest() == Limits(0.3, 0.7, reverse=0.3)
    receive(config(max_linear_speed=0.4))
    assert limits.newest() == Limits(0.4, 0.7, reverse=0.4)


def test_a_robot_on_legs_has_a_limit_sideways(subscribed):
    limits = SpeedLimits()
    assert limits.newest().lateral == 0.0
    subscribed.send("robot_kind", RobotKind(kind="quadruped", roles=["controller"], nodes=["leg_controller"]))
    file = yaml.safe_load(Path(share_file("config/robot_params.yaml")).read_text())["leg_controller"]
    assert limits.newest().lateral == file["max_lateral_speed"] > 0


def test_a_slower_reverse_is_a_limit_of_its_own_and_never_above_the_forward_one(subscribed):
    limits = SpeedLimits()
    receive = partial(subscribed.send, "diff_drive_controller/parameter_updates")
    receive(config(max_linear_speed=0.8, max_angular_speed=0.7, min_linear_speed=-0.2))
    assert limits.newest() == Limits(0.8, 0.7, reverse=0.2)
    receive(config(max_linear_speed=0.1))
    assert limits.newest().reverse == 0.1
    receive(config(min_linear_speed=0.0))
    assert limits.newest().reverse == 0.0
