"""robot_status.py's ROS side: listens to the nodes of its namespace, publishes robot_status."""

import argparse
import math
import time
import xml.etree.ElementTree as ET

import rospy

from robot_control.installed_files import share_file
from robot_control.msg import RobotStatus
from robot_control.robot.boundary import boundary
from robot_control.robot.diagnosis.facts import below
from robot_control.robot.diagnosis.lateness import busy
from robot_control.robot.diagnosis.recent import Diagnostics
from robot_control.robot.robot_kind import running_kind
from robot_control.robot.ros_node import running_node
from robot_control.robot.view import View
from robot_control.watch.status.report import Reports, changed, status_of

POLL_PERIOD = 0.05
"""s between two looks for a change"""
PERIOD = 1.0
"""s between two messages of an unchanged state"""


class Status:
    """Publishes the robot's status from the last message of each topic."""

    def __init__(self) -> None:
        self._namespace = rospy.get_namespace()
        self._began = time.monotonic()
        self._version = ET.parse(share_file("package.xml")).findtext("version", "")
        self._published_at = -math.inf
        self._view = View("safety_status", "drive_state", "leg_state")
        self._reports = Diagnostics()
        self._published = RobotStatus()
        self._publisher = rospy.Publisher("robot_status", RobotStatus, queue_size=1, latch=True)

    def poll(self, now: float) -> None:
        """Publishes if a message is due."""
        status = status_of(self._reports_of_now(now))
        status.software_version = self._version
        status.uptime = now - self._began
        if now - self._published_at < PERIOD and not changed(status, self._published):
            return
        status.header.stamp = rospy.Time.now()
        self._published, self._published_at = status, now
        self._publisher.publish(status)

    def _reports_of_now(self, now: float) -> Reports:
        drive, legs = (self._view.fresh(topic, now) for topic in ("drive_state", "leg_state"))
        newest = {below(self._namespace, name): report for name, (_, report) in self._reports.items(now).items()}
        return Reports(
            safety=self._view.fresh("safety_status", now),
            diagnostics={name: report for name, report in newest.items() if name},
            kind=running_kind(),
            commander="" if drive is None else drive.commander,
            posture="" if legs is None else legs.posture,
            busy=busy(),
        )


def main() -> None:
    """Entry point of scripts/robot_status.py."""
    argparse.ArgumentParser(
        prog="robot_status.py",
        description="Publishes the robot's state for a host on robot_status (RobotStatus): latched, once "
        "per second and on every change. sim.launch and robot.launch start it.",
    ).parse_args(rospy.myargv()[1:])
    with running_node("robot_status") as signals:
        status = Status()
        while signals.going_on():
            with boundary.crossing("the reports"):
                status.poll(time.monotonic())
            time.sleep(POLL_PERIOD)
