"""Parameters of the running diff_drive_controller that set_parameters changes, as it publishes them."""

from __future__ import annotations

import rospy
from dynamic_reconfigure.msg import Config

from robot_control.common.roles import CONTROLLER


class LiveParameters:
    """The newest parameters; there are none until a message arrives."""

    def __init__(self) -> None:
        self._values: dict[str, float] = {}
        rospy.Subscriber(f"{CONTROLLER}/parameter_updates", Config, self._receive, queue_size=1)

    def value(self, name: str, default: float) -> float:
        """The value in force, or `default` if it is not known."""
        return self._values.get(name, default)

    @property
    def command_timeout(self) -> float:
        """s of silence after which a command has ended; 0: never, or not known."""
        return self.value("cmd_vel_timeout", 0.0)

    def _receive(self, message: Config) -> None:
        self._values = self._values | {parameter.name: float(parameter.value) for parameter in message.doubles}
