"""The robot as a path's program sees it: odometry, permit, and whether its commands reach the joints."""

import math
import time
from collections.abc import Callable

import rospy
from nav_msgs.msg import Odometry

from robot_control.loop.roles import ESTIMATOR, MONITOR
from robot_control.msg import DriveState, LegState, SafetyStatus
from robot_control.robot.boundary import subscribe
from robot_control.robot.command import Command
from robot_control.robot.command_topic import CommandTopic
from robot_control.robot.safety_states import DRIVABLE, STOPPED
from robot_control.robot.safety_watch import SafetyWatch
from robot_control.robot.view import SILENCES, View

SOURCE = "path_vel"
PATIENCE = 10.0
"""s to wait for odometry and the permit to drive"""
ZERO_PERIOD = 0.02
"""s between two zeros before a path begins; with a list of sources it begins when one of them commands"""
CAUSE_DELAY = 0.3
"""s by which the cause of a stop may follow the refusal that it leads to: they come from two nodes"""


def in_words(safety: SafetyStatus) -> str:
    """Why the robot may not drive."""
    why = "; ".join(safety.sentences) or "it is not ready"
    return f"{safety.state_name}: {why}. Call e_stop_reset, then start the path again"


class Robot:
    """The permit and the newest odometry, and what the controller does with the commands of this program."""

    def __init__(self, *, attended: bool = False) -> None:
        """`attended`: a thread that never plans calls `watch` all the time, so that every gap is a suspension."""
        self._attended = attended
        self.watch = SafetyWatch()
        self.commands = False  # true if the commands of this program reach the joints
        self.refused_at = math.inf  # s, since when the controller awaits a zero from this program after a stop
        self.masked_by = ""
        self._view = View("odom")
        subscribe("drive_state", DriveState, self._receive_state, queue_size=1, tcp_nodelay=True)
        subscribe("leg_state", LegState, self._receive_refusal, queue_size=1, tcp_nodelay=True)

    @property
    def frames(self) -> tuple[str, str]:
        """Frames of odometry and of the robot; empty before the first odometry."""
        odometry, _ = self.odometry
        return (odometry.header.frame_id, odometry.child_frame_id) if odometry is not None else ("", "")

    @property
    def odometry(self) -> tuple[Odometry | None, float]:
        """The newest odometry and when it came, s, monotonic; None, minus infinity without one."""
        return self._view.newest("odom")

    @property
    def safety(self) -> SafetyStatus | None:
        """The newest safety_status."""
        return self.watch.message

    @property
    def drivable(self) -> bool:
        """True if the monitor permits to drive."""
        return self.safety is not None and self.safety.state_name in DRIVABLE

    @property
    def stopped(self) -> bool:
        """True if only a reset ends the stop."""
        return self.safety is not None and self.safety.state_name in STOPPED

    @property
    def speed_limit(self) -> float:
        """m/s, of safety_status: `clearance` and warnings."""
        return math.inf if self.safety is None else float(self.safety.speed_limit)

    def revoked(self, requested: float, *, waited: bool) -> str:
        """Why a path that was requested at `requested` s (monotonic) may not be driven any more; empty if it may.
        `waited`: the path was not driven since the last look.
        """
        why = self.watch.revoked(requested, waited=waited and not self._attended)
        return why and f"{why}: an earlier path does not start or continue by itself. Start the path again"

    def against_driving(self, now: float) -> str:
        """Why a path that is driven has to end; empty if it goes on."""
        if silence := self._silence(now):
            return silence
        if not self.drivable:
            return in_words(self.safety)
        refused = now - self.refused_at > CAUSE_DELAY
        return "the controller refuses what was requested before a stop" if refused else ""

    def await_drivable(self, topic: CommandTopic, going_on: Callable[[], bool], requested: float) -> str:
        """Sends zeros until the robot may drive; returns why it may not within PATIENCE, or an empty text.

        It does not wait for the end of a stop: a path that was requested before a reset does not begin with it.
        """
        end = time.monotonic() + PATIENCE
        while going_on() and time.monotonic() < end:
            against = in_words(self.safety) if self.stopped else self.revoked(requested, waited=True)
            if against:
                return against
            speaks = not self._silence(time.monotonic())
            if speaks and self.drivable and topic.connected and self.commands:
                return ""
            topic.send(Command())
            time.sleep(ZERO_PERIOD)
        if not going_on():
            return "interrupted"
        if silence := self._silence(time.monotonic()):
            return silence
        if not self.drivable:
            return in_words(self.safety)
        return f"{SOURCE} is {self.masked_by}" if self.masked_by else "the controller does not take commands"

    def _silence(self, now: float) -> str:
        """Which topic is silent; empty if both come."""
        safety = self.watch.message, self.watch.received_at
        for topic, (message, at), node in (("odom", self.odometry, ESTIMATOR), ("safety_status", safety, MONITOR)):
            if message is None:
                return f"no {topic}: {node} does not run"
            if now - at > SILENCES[topic]:
                return f"{topic} is silent for {SILENCES[topic]:g} s"
        return ""

    def _receive_state(self, message: DriveState) -> None:
        states = {name: state for name, _, state in (text.partition(": ") for text in message.sources)}
        state = states.get(SOURCE, "")
        self.masked_by = state if state.startswith(("masked", "locked")) else ""
        self._receive_refusal(message, chosen=state in {"", "commands"})

    def _receive_refusal(self, message: DriveState | LegState, *, chosen: bool = True) -> None:
        refused = rospy.get_name() in message.revoked
        self.refused_at = min(self.refused_at, time.monotonic()) if refused else math.inf
        self.commands = chosen and not refused
