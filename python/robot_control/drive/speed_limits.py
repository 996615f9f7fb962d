"""The robot's max_linear_speed, max_lateral_speed, max_angular_speed and min_linear_speed. The controller of a robot on
wheels publishes them latched. Until they are received, those of the installed parameter file are used.
"""

from pathlib import Path

import yaml  # type: ignore[import-untyped]

from robot_control.drive.keys.operator import Limits
from robot_control.installed_files import share_file
from robot_control.robot.live_parameters import LiveParameters
from robot_control.settings.parameter_layers import DEFAULTS


class SpeedLimits:
    """The newest limits."""

    def __init__(self) -> None:
        self._defaults = yaml.safe_load(Path(share_file(DEFAULTS)).read_text())
        self._live = LiveParameters()

    def newest(self) -> Limits:
        """The limits; without min_linear_speed the robot is as fast backwards as forwards."""
        linear, angular = self._value("max_linear_speed"), self._value("max_angular_speed")
        reverse = min(linear, -self._value("min_linear_speed", -linear))
        return Limits(linear, angular, reverse, self._value("max_lateral_speed"))

    def _value(self, name: str, default: float = 0.0) -> float:
        known = self._defaults.get(self._live.controller, {})
        return self._live.value(name, float(known.get(name, default)))
