"""The robot's max_linear_speed and max_angular_speed: those in force, which diff_drive_controller publishes latched;
until they are received, those of the installed parameter file.
"""

from pathlib import Path

import rospy
import yaml  # type: ignore[import-untyped]
from dynamic_reconfigure.msg import Config

from robot_control.installed_files import share_file
from robot_control.parameter_layers import DEFAULTS
from robot_control.teleop.operator import Command

CONTROLLER = "diff_drive_controller"


class SpeedLimits:
    """The newest ones."""

    def __init__(self) -> None:
        defaults = yaml.safe_load(Path(share_file(DEFAULTS)).read_text())[CONTROLLER]
        self._limits = Command(float(defaults["max_linear_speed"]), float(defaults["max_angular_speed"]))
        rospy.Subscriber(f"{CONTROLLER}/parameter_updates", Config, self._receive, queue_size=1)

    def newest(self) -> Command:
        """m/s, rad/s."""
        return self._limits

    def _receive(self, message: Config) -> None:
        values = {parameter.name: parameter.value for parameter in message.doubles}
        self._limits = Command(
            values.get("max_linear_speed", self._limits.linear), values.get("max_angular_speed", self._limits.angular)
        )
