"""data_return.py run: the sender beside the robot, with the lowest priority, and what it says."""

import os
import subprocess
import time
from datetime import datetime
from pathlib import Path

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from robot_control.data.data_return.plan import reason_to_wait
from robot_control.data.data_return.queue_file import QueueFile
from robot_control.data.data_return.remote import Remote
from robot_control.data.data_return.sender import Sender
from robot_control.data.data_return.settings import Settings
from robot_control.robot.boundary import boundary
from robot_control.robot.topic_sender import Signals
from robot_control.robot.view import View

PERIOD = 1.0
"""s of one pass without anything to send, and of /diagnostics"""
ROUTES = Path("/proc/net/route")


def lower_priority() -> None:
    """Runs only when no other program would, on the processor and on the disk; programs that it starts likewise."""
    os.nice(19)
    os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
    subprocess.run(["ionice", "-c", "3", "-p", str(os.getpid())], check=False, stderr=subprocess.DEVNULL)


class Node:
    """The sender and its topics."""

    def __init__(self, settings: Settings, queue: QueueFile, signals: Signals) -> None:
        self._settings, self._signals = settings, signals
        self._view = View("robot_status")
        self._sender = Sender(settings, queue, Remote(settings, self._why_not), rospy.logwarn)
        self._name = rospy.get_name().lstrip("/")
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=1)
        rospy.Timer(rospy.Duration(PERIOD), self._report, reset=True)

    def run(self) -> None:
        """Until a signal."""
        while self._signals.going_on():
            again = False
            with boundary.crossing("a pass"):
                again = self._sender.step(time.monotonic(), time.time(), self._why_not())
            if not again:
                time.sleep(PERIOD)

    def _why_not(self) -> str:
        if not self._signals.going_on():
            return "the program ends"
        status = self._view.fresh("robot_status", time.monotonic())
        mode = "" if status is None else status.mode
        return reason_to_wait(self._settings, datetime.now().astimezone(), mode, default_interfaces())

    def _report(self, _event: object) -> None:
        with boundary.crossing("a report"):  # an exception would end rospy's timer
            problem, values = self._sender.problem, [KeyValue("progress", self._sender.progress)]
            level = DiagnosticStatus.WARN if problem else DiagnosticStatus.OK
            report = DiagnosticArray(status=[DiagnosticStatus(level, self._name, problem or "ok", "", values)])
            report.header.stamp = rospy.Time.now()
            self._diagnostics.publish(report)


def default_interfaces(routes: Path = ROUTES) -> list[str]:
    """Names of the interfaces of the default routes."""
    try:
        lines = [line.split() for line in routes.read_text().splitlines()[1:]]
    except OSError:
        return []
    return [words[0] for words in lines if words[1:2] == ["00000000"]]
