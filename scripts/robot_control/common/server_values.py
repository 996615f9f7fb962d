"""Values of the ROS parameter server, which any node can set to any type."""

from __future__ import annotations

from typing import Any

import rospy

from robot_control.common.files import printable


class ServerValueError(ValueError):
    """A value of a type that no reader of it takes; the message names it, its value, the rule and the remedy."""


def server_text(name: str, rule: str) -> str:
    """The text that is set as `name`; "" where nothing is. `rule`: what it has to be.

    Raises:
        ServerValueError: it is of another type.
    """
    value = rospy.get_param(name, "")
    if not isinstance(value, str):
        raise _wrong_type(name, value, f"a text, {rule}")
    return value


def server_tree(name: str) -> dict[str, Any]:
    """All parameters below `name`, by their names; none where nothing or "" is set.

    Raises:
        ServerValueError: a single value is set as `name`.
    """
    value = rospy.get_param(name, "") or {}
    if not isinstance(value, dict):
        raise _wrong_type(name, value, "a group of parameters")
    return value


def _wrong_type(name: str, value: object, rule: str) -> ServerValueError:
    full = rospy.resolve_name(name)
    return ServerValueError(
        f"{full} = {printable(str(value))}: must be {rule}; set it, or remove it: `rosparam delete {full}`"
    )
