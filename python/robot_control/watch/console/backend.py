"""The ROS side of the console: commands out, reports in. Used by one thread; calls are made in others."""

import asyncio
import math
import time
from typing import Any

import rospy
from std_msgs.msg import Empty

from robot_control.drive.speed_limits import SpeedLimits
from robot_control.robot.command import Pace
from robot_control.robot.command_topic import CommandTopic
from robot_control.robot.diagnosis.listener import Listener
from robot_control.robot.diagnosis.state import Facts
from robot_control.robot.robot_kind import running_kind
from robot_control.robot.safety_watch import SafetyWatch
from robot_control.robot.server_values import server_description
from robot_control.robot.services import AGAIN, E_STOP, Answer, Services, in_words
from robot_control.watch.console.authority import Authority, Page, RefusedError
from robot_control.watch.console.calls import CALLS, RESET_WINDOW, Calls, against
from robot_control.watch.console.settings import Settings
from robot_control.watch.console.view import View, rounded

SOURCE = "console_vel"
HEARTBEAT_PERIOD = 0.1
"""s"""
E_STOP_LIMIT, E_STOP_LOOK = 3.0, 0.02
"""s within which an emergency stop is answered, whatever the robot does; s between two looks for the answer"""
NOT_ANSWERED = Answer(E_STOP, accepted=False, text="the console could not send it. Press the button on the robot")


class Backend:
    """One robot, and the pages that look at it."""

    live = True  # a page may command

    def __init__(self, settings: Settings) -> None:
        self.authority = Authority(settings)
        self.listener, self.view = Listener(), View()
        self.calls = Calls(self.view.pose, self.view.navigation.frame)
        self.said: list[str] = []  # for all pages, and taken by the server
        self.available: set[str] | None = set()  # services of the robot; None: the master does not know the robot
        self._watch, self._limits = SafetyWatch(), SpeedLimits()
        self._services = Services(self._watch)
        self._e_stop, self._e_stop_at = NOT_ANSWERED, -math.inf  # the last answer, and when it came, s
        self._topic, self._age = CommandTopic(SOURCE), 0.0
        self._heartbeat = rospy.Publisher("heartbeat", Empty, queue_size=1, tcp_nodelay=True)
        self._pace = Pace(lambda command: self._topic.send(command, rospy.Time.now() - rospy.Duration(self._age)))
        self._beat_at = -math.inf
        self.listener.follow_master(self._note_services)

    def step(self) -> None:
        """One pass: receives what the robot reports, and sends the command."""
        now = time.monotonic()
        answers = self._services.poll()
        for answer in answers:
            if answer.service == E_STOP:
                self._e_stop, self._e_stop_at = answer, now
        if why := self._watch.interrupted():
            self.authority.interrupt(now, why)
        if self.view.revoked(rospy.get_name()):
            self.authority.refuse(now)
        self.authority.permit(self._watch.drivable(), legged=running_kind().legged)
        command, self._age = self.authority.command(self._limits.newest(), now)
        self._pace.step(command, now)
        commander = self.authority.commander
        beats = commander is not None and commander.heartbeat and commander.dead_man.alive(now)
        if beats and now - self._beat_at >= HEARTBEAT_PERIOD:
            self._beat_at = now
            self._heartbeat.publish(Empty())
        self.said += [_line(answer, self.listener.facts()) for answer in answers]

    async def e_stop(self) -> Answer:
        """Requests the emergency stop; whether the robot has confirmed it, or why not."""
        pressed = time.monotonic()
        self._services.e_stop()
        while self._e_stop_at < pressed - AGAIN:
            if time.monotonic() > pressed + E_STOP_LIMIT:
                return NOT_ANSWERED
            await asyncio.sleep(E_STOP_LOOK)
        return self._e_stop

    def reset(self) -> None:
        """Requests the reset; the answer comes in `said`."""
        self._e_stop_at = -math.inf
        self.authority.rest(time.monotonic() + RESET_WINDOW)
        self._services.reset()

    def fast(self) -> dict[str, Any]:
        """The values that every page shows in each frame."""
        return self.view.fast()

    def slow(self) -> dict[str, Any]:
        """The robot's state for every page."""
        return self.view.slow(self.listener.facts())

    def play(self, at: float, speed: float) -> None:
        """Only a recording plays. Raises RefusedError."""
        raise RefusedError(f"only a recording plays: this robot does not play from {at:g} s at {speed:g} times")

    def description(self) -> str:
        """The URDF of the running robot. Raises ServerValueError, OSError, ROSException."""
        return server_description()

    def authority_of(self, page: Page) -> dict[str, Any]:
        """The values that this page shows of itself and of the others."""
        now, commander = time.monotonic(), self.authority.commander
        dead_man, limits = page.dead_man, self._limits.newest()
        return rounded(
            {
                **self.authority.seen_by(page),
                "against": {
                    name: against(name, page, self.authority, self.available, running_kind()) for name in CALLS
                },
                "dead_man": dead_man.state(now) if commander is page else "",
                "link": {
                    "last": dead_man.round_trips.last(),
                    "p95": dead_man.round_trips.percentile95(now),
                    "gaps": dead_man.gaps,
                    "late": dead_man.late,
                    "replayed": dead_man.replayed,
                    "cap": page.cap,
                },
                "chosen": (page.chosen.linear, page.chosen.angular, page.chosen.lateral),
                "limits": (limits.linear, limits.angular, limits.lateral),
                "heartbeat": page.heartbeat,
            }
        )

    def _note_services(self) -> None:
        self.available = None if self.listener.facts().forgotten else self.listener.services()


def _line(answer: Answer, facts: Facts) -> str:
    """The answer for an operator, who has a button for the reset."""
    stopped = answer.service == E_STOP and answer.accepted
    return "emergency stop confirmed" if stopped else in_words(answer, facts)
