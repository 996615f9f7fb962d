"""Receives the messages of the robot and the answers of the master, as facts for a diagnosis."""

import threading
import time
from collections.abc import Callable, Sequence
from typing import Any
from urllib.parse import urlsplit

import rospy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry

from robot_control.msg import SafetyStatus
from robot_control.robot.boundary import Latest, boundary
from robot_control.robot.diagnosis.facts import below, nodes_of, other_robots, safety_of
from robot_control.robot.diagnosis.lateness import busy, load_in_words
from robot_control.robot.diagnosis.recent import Diagnostics, values_of
from robot_control.robot.diagnosis.state import SILENCE, Facts, Report, Safety, Speeds
from robot_control.robot.live_parameters import LiveParameters
from robot_control.robot.robot_kind import running_kind
from robot_control.robot.ros_master import Master, senders_of

MASTER_PERIOD = 1.0
"""s between two queries of the master"""


class Listener:
    """The last message of each topic."""

    def __init__(self) -> None:
        self.namespace = rospy.get_namespace().rstrip("/") or "/"
        self.master = Master(rospy.get_name())
        self._state: Sequence[Any] | None = None
        self._queried_at = 0.0
        self._refused = ""
        self._registered = True  # with the present master, by all of its topics
        self._safety = Latest("safety_status", SafetyStatus, check=lambda message: safety_of(message, 0.0, 0.0))
        self._reports = Diagnostics()
        self._limited, self._measured = Latest("cmd_vel_out", TwistStamped), Latest("odom", Odometry)
        self._parameters = LiveParameters()

    def query_master(self) -> None:
        """Queries the master at most every MASTER_PERIOD; waits up to ros_master.TIMEOUT.

        A master that was started again does not know this program. The node is registered again, and its connections
        stay. Over them it still reaches the nodes that the new master does not know either.
        """
        now = time.monotonic()
        if now - self._queried_at < MASTER_PERIOD:
            return
        self._queried_at = now
        self._state = self.master.state()
        silent = self._state is not None and self._safety.fresh(now, SILENCE) is None
        self._refused = self.master.text(rospy.resolve_name("start_refused")) if silent else ""
        if self._state is not None and not (self._registered and rospy.get_name() in nodes_of(self._state)):
            self._registered = self.master.register_again()

    def follow_master(self, then: Callable[[], None] = lambda: None) -> None:
        """Queries the master in a thread of its own from now on; `then` is called after each query."""

        def work() -> None:
            while True:
                with boundary.crossing("the master"):
                    self.query_master()
                    then()
                time.sleep(MASTER_PERIOD)

        threading.Thread(target=work, daemon=True).start()

    def complete(self) -> bool:
        """True if every node of the loop has reported."""
        facts = self.facts()
        return facts.safety is not None and all(facts.there(node) for node in facts.loop)

    def services(self) -> set[str]:
        """Services of this namespace that the master lists, by their relative names."""
        start = self.namespace.rstrip("/") + "/"
        listed = self._state[2] if self._state else []
        return {name.removeprefix(start) for name, _ in listed if name.startswith(start)}

    def facts(self) -> Facts:
        """The present facts."""
        now = time.monotonic()
        state = self._state or ([], [], [])
        kind, limited, measured = running_kind(), self._limited.fresh(now, SILENCE), self._measured.fresh(now, SILENCE)
        newest = self._reports.items(now).items()
        local = urlsplit(self.master.uri).hostname in {"localhost", "127.0.0.1"}
        reports = {name: Report(status.message, values_of(status), now - at) for name, (at, status) in newest}
        return Facts(
            master=self.master.uri,
            master_answers=self._state is not None,
            namespace=self.namespace,
            refused=self._refused,
            kind=kind,
            safety=self.safety(now),
            reports={below(self.namespace, name): report for name, report in reports.items()},
            registered=frozenset(below(self.namespace, name) for name in nodes_of(state)),
            elsewhere=other_robots(self.namespace, reports),
            senders=senders_of(state[0], map(rospy.resolve_name, kind.request_topics), rospy.get_name()),
            clearance_senders=senders_of(state[0], [rospy.resolve_name("clearance")], rospy.get_name()),
            limited=None if limited is None else speeds_of(limited.twist),
            measured=None if measured is None else speeds_of(measured.twist.twist),
            command_timeout=self._parameters.command_timeout,
            load=load_in_words() if local else "",
            busy=local and busy(),
        )

    def safety(self, now: float) -> Safety | None:
        """The last status of the monitor."""
        message, at = self._safety.newest
        if message is None:
            return None
        held = max(0.0, (rospy.Time.now() - message.since).to_sec()) if message.since else 0.0
        return safety_of(message, held, now - at)


def speeds_of(twist: Twist) -> Speeds:
    """Those of a message."""
    return (twist.linear.x, twist.angular.z, twist.linear.y)
