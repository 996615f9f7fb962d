"""robot_status.py's ROS side: listens to the nodes of its namespace, publishes robot_status."""

from __future__ import annotations

import argparse
import math
import sys
import time
import xml.etree.ElementTree as ET

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from robot_control.common.robot_kind import running_kind
from robot_control.common.ros_node import running_node
from robot_control.installed_files import share_file
from robot_control.msg import DriveState, LegState, RobotStatus, SafetyStatus
from robot_control.status.report import Reports, changed, status_of
from robot_control.why.facts import below
from robot_control.why.state import SILENCE

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
        self._safety: SafetyStatus | None = None
        self._safety_at = self._drive_at = self._legs_at = self._published_at = -math.inf
        # Parsed once per look: 50 of them come per second.
        self._drive: rospy.AnyMsg | None = None
        self._legs: rospy.AnyMsg | None = None
        self._reports: dict[str, tuple[float, DiagnosticStatus]] = {}
        self._published = RobotStatus()
        self._publisher = rospy.Publisher("robot_status", RobotStatus, queue_size=1, latch=True)
        rospy.Subscriber("safety_status", SafetyStatus, self._receive_safety, queue_size=1)
        rospy.Subscriber("drive_state", rospy.AnyMsg, self._receive_drive, queue_size=1)
        rospy.Subscriber("leg_state", rospy.AnyMsg, self._receive_legs, queue_size=1)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._receive_diagnostics)

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
        return Reports(
            safety=self._safety if now - self._safety_at < SILENCE else None,
            diagnostics={name: report for name, (at, report) in dict(self._reports).items() if now - at < SILENCE},
            kind=running_kind(),
            commander=self._commander() if now - self._drive_at < SILENCE else "",
            posture=self._posture() if now - self._legs_at < SILENCE else "",
        )

    def _commander(self) -> str:
        if self._drive is None:
            return ""
        commander: str = DriveState().deserialize(self._drive._buff).commander  # noqa: SLF001 (all that AnyMsg has)
        return commander

    def _posture(self) -> str:
        if self._legs is None:
            return ""
        posture: str = LegState().deserialize(self._legs._buff).posture  # noqa: SLF001 (all that AnyMsg has)
        return posture

    def _receive_safety(self, message: SafetyStatus) -> None:
        self._safety, self._safety_at = message, time.monotonic()

    def _receive_drive(self, message: rospy.AnyMsg) -> None:
        self._drive, self._drive_at = message, time.monotonic()

    def _receive_legs(self, message: rospy.AnyMsg) -> None:
        self._legs, self._legs_at = message, time.monotonic()

    def _receive_diagnostics(self, message: DiagnosticArray) -> None:
        for report in message.status:
            name = below(self._namespace, "/" + report.name.lstrip("/"))
            if name:
                self._reports[name] = time.monotonic(), report


def main() -> None:
    """Entry point of scripts/robot_status.py."""
    argparse.ArgumentParser(
        prog="robot_status.py",
        description="Publishes the robot's state for a host on robot_status (robot_control/RobotStatus): latched, once "
        "per second and on every change. sim.launch and backend.launch start it.",
    ).parse_args(rospy.myargv(sys.argv)[1:])
    with running_node("robot_status") as signals:
        status = Status()
        while signals.going_on():
            status.poll(time.monotonic())
            time.sleep(POLL_PERIOD)
