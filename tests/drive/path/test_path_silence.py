"""A path whose program stands still while the robot brakes: the robot stops at the end of the path all the same."""

from pathlib import Path
from types import SimpleNamespace

import pytest
import rospy
import yaml
from nav_msgs.msg import Odometry
from robot_control.drive.path.follower import PERIOD, Follower, Motion
from robot_control.drive.path.pieces import route
from robot_control.drive.path.run import Drive
from robot_control.drive.path.waypoints import Waypoint
from robot_control.installed_files import share_file
from robot_control.loop.closed_loop import ClosedLoop
from robot_control.robot.pose import Pose

LENGTH = 1.0
"""m"""
SOURCES = yaml.safe_load(Path(share_file("config/command_sources.yaml")).read_text())["topics"]
TIMEOUT = next(each["timeout"] for each in SOURCES if each["name"] == "path_vel")
"""s from its stamp on for which a command of a path is in force"""


def overshoot(left, silence):
    """m beyond the end, after the program stood still for `silence` s from `left` m before the end on."""
    loop = ClosedLoop()
    follower = Follower(route([Waypoint(0.0, 0.0), Waypoint(LENGTH, 0.0)]))
    log = loop.run(seconds=0.5, command=(0.0, 0.0))
    command, stamp, silent_at = Motion(), loop.time, None
    while not follower.over:
        pose = Pose(*(log[f"estimate_{name}"][-1] for name in ("x", "y", "yaw")))
        motion = Motion(log["estimate_linear"][-1], log["estimate_angular"][-1])
        if silent_at is None and LENGTH - pose.x < left:
            silent_at = loop.time
        if silent_at is None or not 0 < loop.time - silent_at < silence:
            command, stamp = follower.step(pose, motion), loop.time
        live = loop.time - stamp < TIMEOUT
        log = loop.run(seconds=PERIOD, command=(command.linear, command.angular) if live else (0.0, 0.0))
    return log["estimate_x"][-1] - LENGTH


@pytest.mark.parametrize("silence", [0.3, 0.7])
@pytest.mark.parametrize("left", [0.02, 0.05, 0.1, 0.2, 0.4])
def test_the_robot_stops_at_the_end_of_a_path_whose_program_stands_still(left, silence):
    assert overshoot(left, silence) < 0.01


def test_a_command_is_as_old_as_the_odometry_that_it_answers():
    sent = []
    odometry = Odometry()
    odometry.header.stamp, odometry.pose.pose.orientation.w = rospy.Time(7, 5), 1.0
    robot = SimpleNamespace(masked_by="", speed_limit=1.0)
    topic = SimpleNamespace(send=lambda _command, stamp: sent.append(stamp))
    frame = SimpleNamespace(pose=lambda pose, _now: pose)
    follower = Follower(route([Waypoint(0.0, 0.0), Waypoint(1.0, 0.0)]))
    Drive(robot, topic, follower, frame, 0.0)._step(odometry)
    assert sent == [rospy.Time(7, 5)]
