"""The kind of the running robot, as its driver publishes it on the latched topic robot_kind (msg/RobotKind.msg)."""

from functools import cache

from robot_control.loop.roles import Kind, refuse_legs
from robot_control.msg import RobotKind
from robot_control.robot.boundary import Latest, next_message

PATIENCE = 1.0
"""s to wait for the topic, which is latched"""
ROLES = ("driver", "estimator", "controller", "monitor")


def kind_of(message: RobotKind) -> Kind:
    """The content of a message. A role that it does not name keeps the node of a robot on wheels."""
    nodes = {role: node for role, node in zip(message.roles, message.nodes, strict=False) if role in ROLES and node}
    fault_components = tuple(message.fault_components)
    return Kind(name=message.kind, **nodes, fault_components=fault_components, fault_kinds=tuple(message.fault_kinds))


class _Running:
    """The kind of the running robot, converted once per message."""

    def __init__(self) -> None:
        self._topic = Latest("robot_kind", RobotKind)
        self._message: RobotKind | None = None
        self._kind = Kind()

    def kind(self) -> Kind:
        message = self._topic.message
        if message is not self._message:
            self._message, self._kind = message, kind_of(message)
        return self._kind


@cache
def _running() -> _Running:
    """One subscription for all parts of a process."""
    return _Running()


forget = _running.cache_clear
"""Makes the next call of `running_kind` subscribe again."""


def refuse_running_legs(tool: str) -> None:
    """Refuses for `tool`, which works on wheels only, a running robot on legs.

    A robot whose kind does not come within PATIENCE is not refused: its nodes do not run, which the tool reports.

    Raises:
        WheelsOnlyError: it is one.
    """
    message = next_message("robot_kind", RobotKind, PATIENCE)
    if message is not None:
        refuse_legs(kind_of(message), tool)


def running_kind() -> Kind:
    """The kind that was received last; before, one without a name."""
    return _running().kind()
