"""state_publisher.py: waits for robot_description, then becomes robot_state_publisher.

Debian's robot_state_publisher ends if robot_description is not set yet. It also warns about every root link with an
inertia, which moves no transform. A robot that is free to move it fixes to its world. It is given the description
without either, as a parameter of its own.
"""

import os
import sys
import time
import xml.etree.ElementTree as ET

import roslib.packages
import rospkg
import rospy

from robot_control.files.files import one_message
from robot_control.robot.ros_master import require_master
from robot_control.robot.ros_node import begin_node
from robot_control.robot.server_values import ServerValueError, server_description
from robot_control.robot.topic_sender import ended_by_signals

POLL_PERIOD = 0.2
"""s between two looks at the parameter server"""
PROGRAM = "robot_state_publisher"
PACKAGE = "ros-robot-state-publisher"


def for_transforms(urdf: str) -> str:
    """The same robot for readers of its joints alone. A text that is no URDF is returned unchanged.

    The inertia of the root link is left out. So is a floating or planar joint with its parent, which the nodes accept
    for the world alone (machine/description/markup/free_root.h).
    """
    try:
        robot = ET.fromstring(urdf)
    except ET.ParseError:
        return urdf
    for joint in robot.findall("joint"):
        if joint.get("type") in ("floating", "planar"):
            parent = joint.find("parent")
            robot.remove(joint)
            for link in robot.findall("link"):
                if parent is not None and link.get("name") == parent.get("link"):
                    robot.remove(link)
    children = {child.get("link") for child in robot.findall("joint/child")}
    for link in robot.findall("link"):
        if link.get("name") not in children:
            for inertial in link.findall("inertial"):
                link.remove(inertial)
    return ET.tostring(robot, encoding="unicode")


def program() -> str:
    """Raises SystemExit: it is not installed."""
    try:
        found = roslib.packages.find_node(PROGRAM, PROGRAM)
    except rospkg.ResourceNotFound:
        found = []
    if not found:
        sys.exit(f"state_publisher.py: needs the package {PACKAGE} (apt install {PACKAGE})")
    return str(found[0])


def await_description() -> str:
    """The description; empty if a signal came first, also while the node was ended.
    Raises ServerValueError: it is no text.
    """
    description = ""
    with ended_by_signals() as signals:
        while signals.going_on() and not (description := server_description()):
            time.sleep(POLL_PERIOD)
    return "" if signals.came else description


def main() -> None:
    """Entry point of scripts/state_publisher.py."""
    path = program()
    require_master()
    begin_node(PROGRAM)
    own, name = rospy.resolve_name("~robot_description"), rospy.resolve_name("robot_description")
    with one_message("state_publisher.py", ServerValueError):
        description = await_description()
    if not description:
        return
    rospy.set_param(own, for_transforms(description))
    os.execv(path, [path, *sys.argv[1:], f"{name}:={own}"])
