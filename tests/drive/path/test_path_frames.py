"""Paths in frames other than odometry's, and what ends a path: without ROS."""

import math
import time
from types import SimpleNamespace

import pytest
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from nav_msgs.msg import Path as PathMessage
from robot_control.drive.path.frames import PathFrame, Transform, located
from robot_control.drive.path.robot import Robot
from robot_control.drive.path.run import points_of
from robot_control.drive.path.waypoints import PathError, Waypoint
from robot_control.msg import SafetyStatus
from robot_control.robot.pose import Pose

OWN = ("odom", "base_link")
POINTS = [Waypoint(0.0, 0.0), Waypoint(1.0, 0.0, yaw=0.5)]


class FakeTf:
    """`known`: (target, source) → transform."""

    def __init__(self, known):
        self.known = known

    def lookup(self, target, source):
        if (target, source) not in self.known:
            raise PathError(f"tf does not connect {target} and {source}")
        return self.known[target, source]


def moving(x=0.0, y=0.0, yaw=0.0, stamp=1.0):
    return Transform(Pose(x, y, yaw), stamp)


def test_a_path_in_odometrys_frame_needs_no_tf():
    points, frame = located(POINTS, "/odom", OWN, FakeTf({}))
    assert points == POINTS
    assert frame.pose(Pose(1.0, 2.0, 3.0), 0.0) == Pose(1.0, 2.0, 3.0)


def test_a_path_in_a_frame_that_moves_against_odometry_stays_there_and_the_pose_is_led_over():
    tf = FakeTf({("base_link", "map"): moving(), ("map", "odom"): moving(10.0, 0.0, math.pi / 2)})
    points, frame = located(POINTS, "map", OWN, tf)
    assert (points, frame.name) == (POINTS, "map")
    pose = frame.pose(Pose(1.0, 0.0, 0.5), 0.0)
    assert (pose.x, pose.y, pose.yaw) == pytest.approx((10.0, 1.0, 0.5 + math.pi / 2))
    tf.known["map", "odom"] = moving(11.0, 0.0, math.pi / 2, stamp=2.0)
    assert frame.pose(Pose(1.0, 0.0, 0.5), 0.1).x == pytest.approx(11.0)


@pytest.mark.parametrize("frame", ["base_link", "laser"])
def test_a_path_in_a_frame_that_is_fixed_to_the_robot_is_taken_where_it_is_at_the_start(frame):
    tf = FakeTf({("base_link", "laser"): moving(0.2, stamp=0.0), ("odom", frame): moving(3.0, 4.0, math.pi / 2)})
    points, driven = located(POINTS, frame, OWN, tf)
    assert driven.name == "odom"
    assert (points[1].x, points[1].y, points[1].yaw) == pytest.approx((3.0, 5.0, 0.5 + math.pi / 2))


@pytest.mark.parametrize(("frame", "words"), [("mars", "tf does not connect"), ("", "has no frame")])
def test_an_unknown_frame_is_refused(frame, words):
    with pytest.raises(PathError, match=words):
        located(POINTS, frame, OWN, FakeTf({}))


def test_tf_that_falls_silent_ends_the_path_and_a_fixed_transform_never_does():
    tf = FakeTf({("map", "odom"): moving(stamp=1.0)})
    frame = PathFrame("map", "odom", tf)
    frame.pose(Pose(0.0, 0.0, 0.0), 0.0)
    tf.known["map", "odom"] = moving(stamp=1.5)
    frame.pose(Pose(0.0, 0.0, 0.0), 0.5)
    frame.pose(Pose(0.0, 0.0, 0.0), 1.4)
    with pytest.raises(PathError, match="tf from 'odom' to 'map' is silent for 1 s"):
        frame.pose(Pose(0.0, 0.0, 0.0), 1.6)
    fixed = PathFrame("site", "odom", FakeTf({("site", "odom"): moving(stamp=0.0)}))
    fixed.pose(Pose(0.0, 0.0, 0.0), 0.0)
    fixed.pose(Pose(0.0, 0.0, 0.0), 1000.0)


def test_poses_of_several_frames_are_refused():
    path = PathMessage()
    path.header.frame_id = "map"
    path.poses = [PoseStamped(), PoseStamped()]
    assert len(points_of(path)) == 2
    path.poses[1].header.frame_id = "odom"
    with pytest.raises(PathError, match="poses of the path lie in odom, and the path in 'map'"):
        points_of(path)


@pytest.fixture
def robot(monkeypatch):
    """A robot with fresh messages of all topics: (robot, now)."""
    monkeypatch.setattr(rospy, "Subscriber", lambda *_, **__: None)
    robot = Robot()
    receive(robot)
    robot.watch.receive(SafetyStatus(state_name="DRIVE"))
    return robot, robot.odometry[1]


def receive(robot, age=0.0):
    robot._view._topics["odom"]._newest = Odometry(), time.monotonic() - age


def test_nothing_is_against_driving_while_all_speak(robot):
    assert robot[0].against_driving(robot[1] + 0.4) == ""


def test_odometry_that_falls_silent_ends_the_path(robot):
    assert robot[0].against_driving(robot[1] + 0.6) == "odom is silent for 0.5 s"


def test_a_path_does_not_begin_on_odometry_from_before_a_gap(robot, monkeypatch):
    """A program that was suspended takes a goal before the odometry that waits beside it."""
    robot[0].commands = True
    receive(robot[0], age=10.0)
    monkeypatch.setattr("robot_control.drive.path.robot.PATIENCE", 0.3)
    sent = []
    topic = SimpleNamespace(connected=True, send=lambda *_: sent.append(None))

    def begin() -> str:
        return robot[0].await_drivable(topic, lambda: True, time.monotonic())

    assert begin() == "odom is silent for 0.5 s"
    sent.clear()
    topic.send = lambda *_: (sent.append(None), receive(robot[0]))
    assert begin() == ""
    assert len(sent) == 1


def test_a_safety_monitor_that_falls_silent_ends_the_path(robot):
    receive(robot[0], age=-10.0)
    assert robot[0].against_driving(robot[1] + 4.0) == "safety_status is silent for 3 s"


def test_a_stop_ends_the_path_with_its_sentence(robot):
    robot[0].watch.receive(SafetyStatus(state_name="STOPPED", sentences=["e_stop was called"]))
    words = robot[0].against_driving(robot[1])
    assert words == "STOPPED: e_stop was called. Call e_stop_reset, then start the path again"


def test_a_path_whose_requests_the_controller_refuses_since_a_stop_ends(robot, monkeypatch):
    monkeypatch.setattr(rospy, "get_name", lambda: "/drive_path")
    for revoked, commands in ((["/planner"], True), (["/planner", "/drive_path"], False)):
        robot[0]._receive_state(SimpleNamespace(sources=[], revoked=revoked))
        assert robot[0].commands is commands
        robot[0].refused_at -= 10.0
        assert ("refuses what was requested before a stop" in robot[0].against_driving(robot[1])) is not commands
