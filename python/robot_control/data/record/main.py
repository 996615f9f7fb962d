"""What `sim.launch record:=true` records, and where."""

import argparse
import os
import sys
from pathlib import Path

import rosgraph.names
import roslib.packages

from robot_control.files.files import given_path, in_words

REQUESTS = (
    *("cmd_vel", "cmd_vel_stamped", "joy_vel", "key_vel", "console_vel", "path_vel", "pause", "body_pose"),
    *("foot_target", "joint_trajectory", "e_stop", "heartbeat", "clearance", "joy", "imu/input", "initialpose"),
    "follow_path/velocity",
)
REPORTS = (
    *("joint_commands", "joint_targets", "joint_states", "odom", "wheel_odom", "tf", "tf_static", "imu/data_raw"),
    *("imu/data", "cmd_vel_out", "cmd_vel_requested", "battery_state", "drive_state", "leg_state", "path_wanted"),
    *("scan", "guard_state", "map", "map_metadata", "localization_state", "amcl_pose", "particlecloud"),
    *("view/markers", "view/path_driven"),
    *("robot_kind", "safety_status", "robot_status", "ground_truth/odom", "/diagnostics", "/clock", "/rosout"),
)
TOPICS = REQUESTS + REPORTS
"""The table of docs/interfaces.md, tf_static and /rosout; relative names belong to the namespace of the robot."""


def namespace_of(arguments: list[str], environment: dict[str, str]) -> str:
    """Namespace of this node: `__ns:=` on the command line, else ROS_NAMESPACE, else the root."""
    for argument in arguments:
        if argument.startswith("__ns:="):
            return rosgraph.names.make_global_ns(argument.removeprefix("__ns:="))
    return rosgraph.names.make_global_ns(environment.get("ROS_NAMESPACE", "/"))


def record_command(arguments: list[str], environment: dict[str, str]) -> list[str]:
    """The recorder of rosbag for `FOLDER` and the remappings that roslaunch appends. The command `rosbag record` is not
    used, for on SIGINT it ends before its recorder has closed the bag.

    Raises:
        SystemExit: no folder is named, or help is asked for.
    """
    about = "Records every topic of the interface table with rosbag; Ctrl-C ends it."
    parser = argparse.ArgumentParser(prog="record.py", description=about)
    parser.add_argument("folder", metavar="FOLDER", help="for the bag; made where it does not exist")
    folder = parser.parse_args([argument for argument in arguments if ":=" not in argument]).folder
    namespace = namespace_of(arguments, environment)
    names = [rosgraph.names.ns_join(namespace, topic) for topic in TOPICS]
    prefix = Path(given_path(folder), namespace.strip("/"), "robot_control")
    return [roslib.packages.find_node("rosbag", "record")[0], f"--output-prefix={prefix}", *names]


def main() -> None:
    """Makes the folder and becomes rosbag's recorder."""
    command = record_command(sys.argv[1:], dict(os.environ))
    folder = Path(command[1].partition("=")[2]).parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SystemExit(f"record.py: {in_words(error)}; set another folder") from None
    os.execv(command[0], command)
