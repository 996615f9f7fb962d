"""The ROS master, with a time limit for its answers, and what its list of publishers says."""

import sys
from collections.abc import Iterable, Sequence
from typing import Any

import rosgraph
import rospy

from robot_control.robot.timed_proxy import NO_ANSWER, timed_proxy

TIMEOUT = 1.0
"""s for an answer of the master, which may hang"""


def require_master() -> None:
    """Ends the program with a message where no ROS master answers."""
    if not rosgraph.is_master_online():
        what = f"no ROS master at {rosgraph.get_master_uri()}"
        sys.exit(f"{what}: start the robot first, for instance with roslaunch robot_control sim.launch")


def process_of(node: str) -> int | None:
    """The process, on its computer, of a node of this name (absolute) that is known to the master and answers."""
    try:
        master: Any = timed_proxy(rosgraph.get_master_uri(), TIMEOUT)
        known, _, uri = master.lookupNode(node, node)
        if known != 1:
            return None
        itself: Any = timed_proxy(uri, TIMEOUT)
        code, _, process = itself.getPid(node)
        return int(process) if code == 1 else None
    except NO_ANSWER:
        return None


def living(node: str) -> bool:
    """True if a node of this name (absolute) is known to the master and answers."""
    return process_of(node) is not None


class Master:
    """The ROS master, asked with a time limit."""

    def __init__(self, own: str) -> None:
        self.uri = rosgraph.get_master_uri()
        self._own = own
        self._proxy = timed_proxy(self.uri, TIMEOUT)

    def state(self) -> Sequence[Any] | None:
        """Publishers, subscribers and servers; None if the master does not answer."""
        try:
            answer: Any = self._proxy.getSystemState(self._own)
        except NO_ANSWER:
            return None
        code, _, state = answer
        return state if code == 1 else None

    def text(self, name: str) -> str:
        """The text that the server holds as `name` (absolute); "" if it holds none."""
        try:
            answer: Any = self._proxy.getParam(self._own, name)
        except NO_ANSWER:
            return ""
        return answer[2] if answer[0] == 1 and isinstance(answer[2], str) else ""

    def register_again(self) -> bool:
        """Registers this node with a master that was started again; its living connections stay. True if it is done.

        The node itself knows its topics and takes their publishers as from the master (Slave API of ROS).
        """
        uri = rospy.get_node_uri()
        itself: Any = timed_proxy(uri, TIMEOUT)
        try:
            for topic, kind in itself.getPublications(self._own)[2]:
                self._proxy.registerPublisher(self._own, topic, kind, uri)
            for topic, kind in itself.getSubscriptions(self._own)[2]:
                answer: Any = self._proxy.registerSubscriber(self._own, topic, kind, uri)
                itself.publisherUpdate("/master", topic, answer[2])
        except NO_ANSWER:
            return False
        return True


def senders_of(published: Sequence[tuple[str, Sequence[str]]], topics: Iterable[str], own: str) -> tuple[str, ...]:
    """Nodes but `own` that publish any of these topics (absolute), by the master's list."""
    wanted = set(topics)
    return tuple(sorted({node for topic, nodes in published if topic in wanted for node in nodes} - {own}))
