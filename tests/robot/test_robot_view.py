"""The one view of the robot: newest message, silence and refusal of each topic."""

from __future__ import annotations

import math

import pytest
import rospy
from nav_msgs.msg import Odometry
from robot_control.msg import DriveState, LegState
from robot_control.robot.boundary import boundary
from robot_control.robot.view import SILENCES, View
from support.topics import Topics


@pytest.fixture
def topics(monkeypatch: pytest.MonkeyPatch) -> Topics:
    monkeypatch.setattr(rospy, "get_name", lambda: "/pad")
    return Topics(monkeypatch)


def test_a_topic_is_silent_after_its_own_time(topics: Topics) -> None:
    view = View("odom", "drive_state")
    assert view.newest("odom") == (None, -math.inf)
    topics.send("odom", Odometry())
    topics.send("drive_state", DriveState())
    for topic in ("odom", "drive_state"):
        message, at = view.newest(topic)
        assert view.fresh(topic, at + 0.99 * SILENCES[topic]) is message
        assert view.fresh(topic, at + SILENCES[topic]) is None
    assert SILENCES["odom"] < SILENCES["drive_state"]


@pytest.mark.parametrize("place", ["pose.pose.position.x", "twist.twist.linear.x", "twist.twist.angular.z"])
def test_odometry_that_is_no_place_or_speed_does_not_replace_the_newest(topics: Topics, place: str) -> None:
    view, dropped = View("odom"), boundary.dropped.get("odom", 0)
    topics.send("odom", Odometry(child_frame_id="base_link"))
    wrong = Odometry()
    *path, name = place.split(".")
    part = wrong
    for each in path:
        part = getattr(part, each)
    known = view.newest("odom")
    setattr(part, name, 1.1e6)
    topics.send("odom", wrong)
    assert view.newest("odom") == known
    assert boundary.dropped["odom"] == dropped + 1


def test_the_newest_state_of_either_kind_of_robot_says_whether_the_controller_refuses(topics: Topics) -> None:
    view = View("drive_state", "leg_state")
    assert not view.refused
    topics.send("drive_state", DriveState(revoked=["/pad"]))
    assert view.refused
    topics.send("leg_state", LegState(revoked=["/teleop"]))
    assert not view.refused
