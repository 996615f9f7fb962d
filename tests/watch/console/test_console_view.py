"""The page shows what a robot is asked for and by which node, nothing that is silent, and what is broken."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Quaternion, Twist, TwistStamped
from nav_msgs.msg import Odometry
from robot_control.msg import DriveState
from robot_control.robot.boundary import boundary
from robot_control.robot.diagnosis.answer import THEN_RESET, Answer, Verdict
from robot_control.robot.diagnosis.state import Facts
from robot_control.watch.console import requests, view
from robot_control.watch.console.view import View, six_of
from support.topics import graph


@pytest.fixture
def topics(monkeypatch):
    """A graph whose clock the case sets."""
    with graph(monkeypatch) as made:
        made.view, made.now = View(), 100.0
        for module in (view, requests):
            monkeypatch.setattr(module.time, "monotonic", lambda: made.now)
        yield made


def twist(linear):
    message = Twist()
    message.linear.x = linear
    return message


def test_what_any_node_asks_for_is_shown_with_its_name_until_it_times_out(topics):
    topics.send("cmd_vel", twist(0.3), sender="/move_base")
    assert topics.view.fast()["asked"][0] == pytest.approx(0.3)
    assert topics.view.slow(Facts(master=""))["asked_by"] == "/move_base"
    topics.now += requests.VALID + 0.1
    assert topics.view.fast()["asked"] is None


def test_of_several_sources_the_one_that_commands_is_shown(topics):
    stamped = TwistStamped(twist=twist(0.2))
    topics.send("key_vel", stamped, sender="/teleop")
    topics.send("cmd_vel", twist(0.9), sender="/planner")
    topics.send(
        "drive_state", DriveState(commander="key_vel", sources=["key_vel: commands", "cmd_vel: masked by key_vel"])
    )
    assert topics.view.fast()["asked"][0] == pytest.approx(0.2)
    assert topics.view.slow(Facts(master=""))["asked_by"] == "/teleop"
    topics.now += 0.1
    topics.send("drive_state", DriveState(commander="", sources=["key_vel: silent"]))
    assert topics.view.fast()["asked"] is None


def test_the_values_of_a_silent_topic_are_not_shown(topics):
    odometry = Odometry()
    odometry.pose.pose.orientation.w = 1.0
    topics.send("odom", odometry)
    topics.send("drive_state", DriveState(name=["left"], error=[0.1], effort=[1.0]))
    values = topics.view.fast()
    assert values["measured"] == [0.0, 0.0, 0.0]
    assert values["driven"][0]["effort"] == 1.0
    topics.now += view.SILENCE + 0.1
    values = topics.view.fast()
    assert {"pose", "measured", "driven"}.isdisjoint(values)
    assert values["limited"] is None


def test_limits_are_named_where_motion_is_asked_for_alone(topics, monkeypatch):
    monkeypatch.setattr(Facts, "reasons", lambda *_: {"ramp": "the acceleration is limited"})
    assert topics.view.slow(Facts(master=""))["limits"] == []
    topics.send("cmd_vel", twist(0.3))
    topics.view.fast()
    assert topics.view.slow(Facts(master=""))["limits"] == ["the acceleration is limited"]


def test_a_source_of_which_a_message_was_dropped_is_named_for_some_seconds(topics, monkeypatch):
    monkeypatch.setattr(boundary, "dropped", {})
    topics.send_bytes("odom", b"cut")
    topics.view.fast()
    assert topics.view.slow(Facts(master=""))["broken"] == {"odom": 1}
    topics.now += view.BROKEN + 0.1
    assert topics.view.slow(Facts(master=""))["broken"] == {}


@pytest.mark.parametrize(("roll", "pitch", "yaw"), [(0.0, 0.0, 1.0), (0.3, -0.4, 2.0), (1.6, 0.2, -3.0)])
def test_a_pose_has_all_six_coordinates(roll, pitch, yaw):
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.position.z = 1.0, 0.3
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a / 2), math.sin(a / 2)) for a in (roll, pitch, yaw))
    message.pose.pose.orientation = Quaternion(
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
    assert six_of(message) == pytest.approx((1.0, 0.0, 0.3, roll, pitch, yaw))


def test_an_answer_has_a_part_for_the_operator_and_one_for_the_integrator():
    actions = (("operator", "set it upright"), ("technician", "check the encoder"), ("operator", THEN_RESET))
    answer = Answer(Verdict.STOPPED, "Stopped: tilt.", actions)
    assert answer.sentence == "Stopped: tilt."
    assert Answer(Verdict.IDLE, "Ready: no command: cmd_vel is old.").sentence == "Ready: no command."
    assert answer.steps == ("set it upright",)
    assert answer.integrator == (("technician", "check the encoder"),)
