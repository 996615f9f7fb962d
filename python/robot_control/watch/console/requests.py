"""The request of motion in force: what the robot was asked for, and by which node, by any sender."""

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import-untyped]
from geometry_msgs.msg import Twist, TwistStamped

from robot_control.installed_files import share_file
from robot_control.robot.boundary import Latest
from robot_control.robot.diagnosis.listener import speeds_of
from robot_control.robot.diagnosis.state import Speeds

SOURCES = "config/command_sources.yaml"
VALID = 1.25
"""s for which a request counts, as cmd_vel_timeout's default"""


class Requests:
    """The newest request on each topic that takes one. Another list of command sources keeps the shipped names."""

    def __init__(self) -> None:
        rows = yaml.safe_load(Path(share_file(SOURCES)).read_text(encoding="utf-8"))["topics"]
        kinds = {row["name"]: TwistStamped if row.get("stamped") else Twist for row in rows}
        self._topics = {name: Latest(name, kind) for name, kind in (kinds | {"cmd_vel_stamped": TwistStamped}).items()}

    def in_force(self, commander: str | None) -> tuple[Speeds, str] | None:
        """The speeds and the node of the newest request. `commander`: the source that commands, empty if none does;
        None where the robot has no list of sources.
        """
        names: Sequence[str] = ("cmd_vel", "cmd_vel_stamped") if commander is None else (commander,)
        topics = [self._topics[name] for name in names if name in self._topics]
        now = time.monotonic()
        newest: Any = max((topic.newest for topic in topics), key=lambda newest: newest[1], default=(None, 0.0))
        if newest[0] is None or now - newest[1] > VALID:
            return None
        message = newest[0]
        sender = message._connection_header.get("callerid", "")  # noqa: SLF001 (rospy has no other way to it)
        return speeds_of(getattr(message, "twist", message)), sender
