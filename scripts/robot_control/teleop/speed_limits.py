"""The robot's max_linear_speed, max_angular_speed and min_linear_speed: those in force, which diff_drive_controller
publishes latched; until they are received, those of the installed parameter file.
"""

from pathlib import Path

import rospy
import yaml  # type: ignore[import-untyped]
from dynamic_reconfigure.msg import Config

from robot_control.installed_files import share_file
from robot_control.parameter_layers import DEFAULTS
from robot_control.teleop.operator import Limits

CONTROLLER = "diff_drive_controller"
NAMES = ("max_linear_speed", "max_angular_speed", "min_linear_speed")


class SpeedLimits:
    """The newest ones."""

    def __init__(self) -> None:
        defaults = yaml.safe_load(Path(share_file(DEFAULTS)).read_text())[CONTROLLER]
        self._values = {name: float(defaults[name]) for name in NAMES if name in defaults}
        rospy.Subscriber(f"{CONTROLLER}/parameter_updates", Config, self._receive, queue_size=1)

    def newest(self) -> Limits:
        """Where min_linear_speed is left out, the robot is as fast backwards as forwards."""
        linear, angular = self._values["max_linear_speed"], self._values["max_angular_speed"]
        return Limits(linear, angular, reverse=min(linear, -self._values.get("min_linear_speed", -linear)))

    def _receive(self, message: Config) -> None:
        values = {parameter.name: parameter.value for parameter in message.doubles if parameter.name in NAMES}
        self._values = self._values | values
