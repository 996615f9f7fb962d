"""The ROS side of the desk: commands out, reports in. Used by one thread; calls are made in others."""

from __future__ import annotations

import logging
import threading
import time
from typing import Any

import rospy
from std_msgs.msg import Empty

from robot_control.common.command import Pace
from robot_control.common.command_topic import CommandTopic
from robot_control.console.calls import CALL_NAMES, Calls, against
from robot_control.console.desk import Desk, Page
from robot_control.console.settings import Settings
from robot_control.console.view import View, finite
from robot_control.safety.watch import SafetyWatch
from robot_control.teleop.services import VERDICTS, Services
from robot_control.teleop.speed_limits import SpeedLimits
from robot_control.why.diagnosis import SILENCE
from robot_control.why.listener import MASTER_PERIOD, Listener

SOURCE = "console_vel"
HEARTBEAT_PERIOD = 0.1
"""s"""
journal = logging.getLogger("console")


class Backend:
    """One robot, and the pages that look at it."""

    def __init__(self, settings: Settings) -> None:
        self.desk = Desk(settings)
        self.listener, self.view = Listener(), View()
        self.calls = Calls(self.view.pose)
        self.said: list[str] = []  # for all pages, and taken by the server
        self._watch, self._services, self._limits = SafetyWatch(), Services(), SpeedLimits()
        self._topic = CommandTopic(SOURCE)
        self._heartbeat = rospy.Publisher("heartbeat", Empty, queue_size=1, tcp_nodelay=True)
        self._age = 0.0
        self._pace = Pace(lambda linear, angular: self._topic.send(linear, angular, self._age))
        self._interruptions, self._beat_at = 0, float("-inf")
        self.available: set[str] = set()
        threading.Thread(target=self._query_master, daemon=True).start()

    def look(self) -> None:
        """One pass: takes what the robot reports, and sends the command."""
        now = time.monotonic()
        count, why = self._watch.interruptions()
        if count != self._interruptions:
            self._interruptions = count
            self.desk.interrupt(now, why)
        if self._refused():
            self.desk.refuse(now)
        self.desk.permit(self._watch.drivable(SILENCE))
        command, self._age = self.desk.command(self._limits.newest(), now)
        self._pace.look(command, now)
        commander = self.desk.commander
        if commander is not None and commander.heartbeat and commander.hold.alive(now):
            self._beat(now)
        for answer in self._services.look():
            word = "emergency stop" if answer.service == "e_stop_trigger" else "reset"
            self.said.append(f"{word} {VERDICTS[answer.accepted]}: {answer.text}")

    def e_stop(self) -> None:
        """Requests the emergency stop."""
        self._services.e_stop()

    def reset(self) -> None:
        """Requests the reset; the answer comes in `said`."""
        self._services.reset()

    def fast(self) -> dict[str, Any]:
        """The values that every page shows in each frame."""
        return self.view.fast(self._pace.last)

    def slow(self) -> dict[str, Any]:
        """The robot's state for every page."""
        return self.view.slow(self.listener.facts()) | {"topic": self._topic.name}

    def desk_of(self, page: Page) -> dict[str, Any]:
        """The values that this page shows of itself and of the others."""
        now, holder, hold = time.monotonic(), self.desk.commander, page.hold
        limits = self._limits.newest()
        values: dict[str, Any] = finite(
            {
                "type": "desk",
                "you": page.number,
                "role": page.role.name.lower(),
                "commander": None if holder is None else holder.number,
                "pages": [{"number": p.number, "name": p.name, "role": p.role.name.lower()} for p in self._pages()],
                "against": {name: against(name, page, self.desk, self.available) for name in CALL_NAMES},
                "hold": hold.state(now) if holder is page else "",
                "link": {
                    "last": hold.round_trips.last(),
                    "p95": hold.round_trips.percentile95(now),
                    "gaps": hold.gaps,
                    "late": hold.late,
                    "replayed": hold.replayed,
                    "cap": page.cap,
                },
                "chosen": (page.chosen.linear, page.chosen.angular),
                "limits": (limits.linear, limits.angular),
                "heartbeat": page.heartbeat,
            }
        )
        return values

    def _pages(self) -> list[Page]:
        return list(self.desk.pages.values())

    def _refused(self) -> bool:
        drive = self.view.drive_state
        return drive is not None and rospy.get_name() in drive.revoked and self.view.drive_is_fresh

    def _beat(self, now: float) -> None:
        if now - self._beat_at >= HEARTBEAT_PERIOD:
            self._beat_at = now
            self._heartbeat.publish(Empty())

    def _query_master(self) -> None:
        while True:
            self.listener.query_master()
            self.available = self.listener.services()
            time.sleep(MASTER_PERIOD)
