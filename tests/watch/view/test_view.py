"""Tests the markers for RViz, without RViz."""

import math
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
import rospy
import yaml
from geometry_msgs.msg import Point as Position
from geometry_msgs.msg import Pose, Quaternion
from robot_control.setup.description import describe
from robot_control.watch.scene import (
    AMBER,
    GREEN,
    MAX_LINES,
    MAX_POINTS,
    RED,
    WIDTH,
    Trail,
    force_arrows,
    limits_of,
    status_text,
)
from robot_control.watch.view.feet import METRES_PER_NEWTON, Swings, in_odom, load_arrows
from robot_control.watch.view.wheels import running_robot, wheels_of

ROOT = Path(__file__).parents[3]
URDF = ROOT / "urdf/diffbot.urdf"


def test_the_wheels_of_our_robot_are_found_where_they_are():
    wheels = wheels_of(describe(URDF))
    assert set(wheels) == {"left_wheel_joint", "right_wheel_joint"}
    assert wheels["left_wheel_joint"].position == (0.0, 0.25, 0.0)
    assert wheels["left_wheel_joint"].radius == 0.1


@pytest.mark.parametrize("text", ["", "<robot", "<robot/>", "<robot><joint name='a' type='continuous'/></robot>"])
def test_a_description_without_wheels_shows_none(monkeypatch, text):
    monkeypatch.setattr(rospy, "get_param", {"robot_description": text}.get)
    assert running_robot() == ({}, None)


def test_the_wheels_of_a_running_robot_are_read_as_its_nodes_read_them(monkeypatch):
    robot = {"left_wheel_joints": ["left_wheel_joint"], "right_wheel_joints": ["right_wheel_joint"], "bus": ""}
    server = {"robot_description": URDF.read_text(), "robot": robot}
    monkeypatch.setattr(rospy, "get_param", server.get)
    assert running_robot() == (wheels_of(describe(URDF)), None)


def test_an_arrow_is_as_long_as_its_force_and_points_where_it_pushes():
    wheels = wheels_of(describe(URDF))
    arrows = force_arrows(wheels, ["left_wheel_joint", "right_wheel_joint", "other"], [1.0, -2.0, 3.0])
    lengths = [end[0] - begin[0] for begin, end in arrows]
    assert lengths == pytest.approx([0.2, -0.4])
    assert force_arrows(wheels, ["left_wheel_joint"], [math.nan]) == []


def test_a_healthy_robot_is_green_a_limited_one_amber_a_stopped_one_red():
    assert status_text("DRIVE", [], [], [], math.inf).colour == GREEN
    limited = status_text("DRIVE", [], [], ["a wheel is at its torque limit"], 0.3)
    assert limited.colour == AMBER
    assert limited.text == "DRIVE\nlimit: 0.30 m/s\nlimited: a wheel is at its torque limit"
    stopped = status_text("STOPPED", ["the robot hit something"], ["hot"], ["the permit brakes"], math.inf)
    assert stopped.colour == RED
    assert stopped.text == "STOPPED\ncause: the robot hit something"
    assert status_text("", [], [], [], math.inf).text == "no safety_status"


def test_a_robot_of_which_nothing_is_asked_is_not_limited():
    assert limits_of(["holding", "saturated", "timed_out"], ["it stands", "at its limit", "silent"]) == ["at its limit"]


def test_a_text_stays_small():
    text = status_text("STOPPED", ["words " * 50] * 9, [], [], math.inf).text
    assert len(text.splitlines()) == MAX_LINES
    assert max(map(len, text.splitlines())) <= WIDTH


def test_the_path_driven_is_bounded_and_begins_again_after_a_jump():
    trail = Trail()
    assert trail.add(0.0, 0.0)
    assert not trail.add(0.01, 0.0)
    for number in range(3 * MAX_POINTS):
        trail.add(0.06 * number, 0.0)
    assert MAX_POINTS / 4 < len(trail.points) <= MAX_POINTS
    trail.add(-500.0, 0.0)
    assert trail.points == [(-500.0, 0.0, 0.0)]


def test_every_part_of_our_robot_that_is_seen_has_a_material():
    visuals = ET.fromstring(URDF.read_text()).findall("link/visual")
    assert visuals
    assert all(visual.find("material") is not None for visual in visuals)


def test_rviz_shows_topics_that_are_published():
    displays = yaml.safe_load((ROOT / "config/view.rviz").read_text())["Visualization Manager"]["Displays"]
    topics = {display.get("Topic") or display.get("Marker Topic") for display in displays} - {None}
    sources = "\n".join(path.read_text() for path in [*ROOT.glob("python/**/*.py"), *ROOT.glob("src/ros/**/*.cpp")])
    assert topics == {"odom", "ground_truth/odom", "path_wanted", "view/path_driven", "view/markers"}
    assert all(f'"{topic}"' in sources for topic in topics)


def test_the_force_of_a_foot_is_an_arrow_upwards_where_it_bears():
    places = np.array([[0.2, 0.1, -0.3], [0.2, -0.1, -0.3], [-0.2, 0.1, -0.3], [-0.2, -0.1, -0.3]])
    arrows = load_arrows(places, [True, False, True, True], [50.0, 50.0, 0.0, math.nan])
    assert arrows == [((0.2, 0.1, -0.3), (0.2, 0.1, -0.3 + 50 * METRES_PER_NEWTON))]


def test_the_way_of_a_swing_stays_until_the_next_one_begins():
    swings = Swings(1)
    for x, bears in ((0.0, True), (0.1, False), (0.2, False), (0.3, True)):
        swings.add(np.array([[x, 0.0, 0.0]]), [bears])
    assert swings.ways == [[(0.1, 0.0, 0.0), (0.2, 0.0, 0.0)]]
    swings.add(np.array([[0.5, 0.0, 0.0]]), [False])
    assert swings.ways == [[(0.5, 0.0, 0.0)]]


def test_places_of_the_base_are_turned_and_moved_into_odometry():
    half = math.radians(45)
    pose = Pose(Position(1.0, 2.0, 0.3), Quaternion(0.0, 0.0, math.sin(half), math.cos(half)))
    assert in_odom(np.array([[0.2, 0.0, -0.3]]), pose).tolist()[0] == pytest.approx([1.0, 2.2, 0.0])


def test_the_legs_of_a_running_quadruped_are_found(monkeypatch):
    text = (ROOT / "urdf/quadbot.urdf").read_text()
    monkeypatch.setattr(rospy, "get_param", lambda name, *_, **__: text if name == "robot_description" else {})
    wheels, legs = running_robot()
    assert wheels == {}
    assert np.shape(legs.forward(np.zeros(12))) == (4, 3)
