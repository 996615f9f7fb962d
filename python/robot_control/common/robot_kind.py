"""The kind of the running robot, as its driver publishes it on the latched topic robot_kind (msg/RobotKind.msg)."""

from __future__ import annotations

from functools import cache

from robot_control.common.boundary import next_message, subscribe
from robot_control.common.roles import Kind, refuse_legs
from robot_control.msg import RobotKind

PATIENCE = 1.0
"""s to wait for the topic, which is latched"""
ROLES = ("driver", "estimator", "controller", "monitor")


def kind_of(message: RobotKind) -> Kind:
    """The content of a message. A role that it does not name keeps the node of a robot on wheels."""
    nodes = {role: node for role, node in zip(message.roles, message.nodes, strict=False) if role in ROLES and node}
    return Kind(
        name=message.kind,
        **nodes,
        fault_components=tuple(message.fault_components),
        fault_kinds=tuple(message.fault_kinds),
    )


class _Topic:
    def __init__(self) -> None:
        self.newest = Kind()
        subscribe("robot_kind", RobotKind, self._receive, queue_size=1)

    def _receive(self, message: RobotKind) -> None:
        self.newest = kind_of(message)


@cache
def _topic() -> _Topic:
    """One subscription for all parts of a process."""
    return _Topic()


forget = _topic.cache_clear
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
    return _topic().newest
