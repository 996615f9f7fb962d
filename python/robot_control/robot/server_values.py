"""Values of the ROS parameter server, which any node can set to any type."""

import contextlib
import tempfile
from collections.abc import Iterator
from typing import Any

import rospy

from robot_control.files.files import printable


class ServerValueError(ValueError):
    """A value has a type that no reader accepts; the message names it, its value, the rule and the remedy."""


def server_text(name: str, rule: str) -> str:
    """The text that is set as `name`; "" where nothing is. `rule`: what it has to be.

    Raises:
        ServerValueError: it is of another type.
    """
    value = rospy.get_param(name, "")
    if not isinstance(value, str):
        raise _wrong_type(name, value, f"a text, {rule}")
    return value


def server_description() -> str:
    """The robot_description; "" where none is set.

    Raises:
        ServerValueError: it is of another type.
    """
    return server_text("robot_description", "the text of a URDF")


def server_tree(name: str) -> dict[str, Any]:
    """All parameters below `name`, by their names; none where nothing is set.

    An empty text counts as nothing, as for the nodes: launch files set every argument, and the one that was not given
    is "".

    Raises:
        ServerValueError: a single value is set as `name`.
    """
    value = rospy.get_param(name, "") or {}
    if not isinstance(value, dict):
        raise _wrong_type(name, value, "a group of parameters")
    return _without_empty_texts(value)


@contextlib.contextmanager
def described_robot() -> Iterator[tuple[dict[str, Any], str]]:
    """The parameters of the robot, and a file with its robot_description, which lives as long as the block.

    Raises:
        ServerValueError: one of them is of another type.
    """
    robot = {key: value for key, value in server_tree("robot").items() if key != "urdf"}
    with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
        file.write(server_description())
        file.flush()
        yield {"robot": robot}, file.name


def _without_empty_texts(tree: dict[str, Any]) -> dict[str, Any]:
    return {
        key: _without_empty_texts(value) if isinstance(value, dict) else value
        for key, value in tree.items()
        if value != ""
    }


def _wrong_type(name: str, value: object, rule: str) -> ServerValueError:
    full = rospy.resolve_name(name).rstrip("/")
    why = f"{full} = {printable(str(value))}: must be {rule}; set it, or remove it: `rosparam delete {full}`"
    return ServerValueError(why)
