"""The kind of a robot, as tools take it from the topic robot_kind, and what they do with another kind's nodes."""

import re
from pathlib import Path

import pytest
import rosgraph
from dynamic_reconfigure.msg import Config, DoubleParameter
from robot_control.drive.speed_limits import SpeedLimits
from robot_control.loop.roles import LEGGED, LOOP, WHEELED, Kind, WheelsOnlyError
from robot_control.msg import RobotKind
from robot_control.robot import robot_kind, running_robot
from robot_control.robot.live_parameters import LiveParameters
from robot_control.watch.console.calls import CALLS, service_of
from support.topics import Topics

LEGS = RobotKind(
    robot="quadbot",
    kind="quadruped",
    roles=["driver", "estimator", "controller", "monitor"],
    nodes=["mujoco_plant", "state_estimator", "leg_controller", "safety_monitor"],
    joints=["hip"],
    joint_roles=["driven"],
    fault_components=["gyro", "hip_motor"],
    fault_kinds=["ok", "off"],
)


@pytest.fixture
def subscribed(monkeypatch):
    robot_kind.forget()
    yield Topics(monkeypatch)
    robot_kind.forget()


def test_the_message_names_the_nodes_and_what_can_fail():
    kind = robot_kind.kind_of(LEGS)
    assert kind.name == "quadruped"
    assert kind.loop == ("mujoco_plant", "state_estimator", "leg_controller", "safety_monitor")
    assert (kind.fault_components, kind.fault_kinds) == (("gyro", "hip_motor"), ("ok", "off"))


def test_the_words_for_requests_are_those_of_the_table_in_c_and_name_topics():
    table = (Path(__file__).parents[2] / "src" / "signals" / "robot_kinds.h").read_text(encoding="utf-8")
    for name, constant in ((WHEELED, "kWheeledKind"), (LEGGED, "kLeggedKind")):
        (request,) = re.findall(rf'{{{constant}, [^,]+, "([\w ]+)"', table)
        assert Kind(name).worded("cmd_vel") == request
        assert set(request.split(" or ")) <= set(Kind(name).request_topics)
    assert Kind().request_topics == Kind(WHEELED).request_topics


def test_a_role_that_is_not_known_or_without_a_node_changes_nothing():
    other = RobotKind(kind="boat", roles=["captain", "controller", "estimator"], nodes=["anna", ""])
    assert robot_kind.kind_of(other).loop == LOOP


def test_live_parameters_follow_the_controller_of_the_kind(subscribed):
    parameters = LiveParameters()
    assert "diff_drive_controller/parameter_updates" in subscribed
    subscribed.send("robot_kind", LEGS)
    assert parameters.command_timeout == 0.0
    assert "diff_drive_controller/parameter_updates" not in subscribed
    timeout = Config(doubles=[DoubleParameter("cmd_vel_timeout", 0.25)])
    subscribed.send("leg_controller/parameter_updates", timeout)
    assert parameters.command_timeout == 0.25


def test_a_kind_whose_block_is_not_in_the_file_has_the_limits_that_it_reports(subscribed):
    limits = SpeedLimits()
    subscribed.send("robot_kind", RobotKind(kind="boat", roles=["controller"], nodes=["rudder"]))
    assert limits.newest().linear == 0.0
    subscribed.send("rudder/parameter_updates", Config(doubles=[DoubleParameter("max_linear_speed", 0.2)]))
    assert limits.newest().linear == 0.2


def test_a_tool_for_wheels_refuses_a_running_robot_on_legs_alone(monkeypatch):
    def received(name, _, timeout):
        assert (name, timeout) == ("robot_kind", robot_kind.PATIENCE)
        return message

    monkeypatch.setattr(robot_kind, "next_message", received)
    for message in (None, RobotKind(kind=WHEELED), RobotKind(kind="boat")):  # noqa: B007 (received reads it)
        robot_kind.refuse_running_legs("calibrate.py")
    message = LEGS
    with pytest.raises(WheelsOnlyError, match=r"this robot is a quadruped: calibrate\.py works on wheels only"):
        robot_kind.refuse_running_legs("calibrate.py")


def test_a_tool_for_wheels_asks_for_the_kind(monkeypatch):
    monkeypatch.setattr(robot_kind, "next_message", lambda *_: LEGS)
    monkeypatch.setattr(rosgraph, "is_master_online", lambda: True)
    monkeypatch.setattr(running_robot, "begin_node", lambda *_, **__: None)
    with pytest.raises(WheelsOnlyError, match=r"calibrate\.py works on wheels only"):
        running_robot.running_settings("calibrate", "node", "", "").__enter__()


def test_the_calls_of_the_console_go_to_the_nodes_of_the_kind():
    kind = robot_kind.kind_of(LEGS)
    assert service_of(CALLS["set_parameters"], kind) == "leg_controller/set_parameter_map"
    assert service_of(CALLS["inject_fault"], kind) == "mujoco_plant/inject_fault"
    assert service_of(CALLS["reset_odometry"], kind) == "reset_odometry"
    assert service_of(CALLS["path_pause"], kind) == "follow_path/pause"
    assert service_of(CALLS["reset_asked"], kind) == "e_stop_reset"
