"""The wheels or legs of the robot that is shown."""

from typing import Any

from robot_control import _robot_control
from robot_control._robot_control import ParameterError, RobotError
from robot_control.robot.server_values import ServerValueError, described_robot
from robot_control.settings.parameter_layers import layered
from robot_control.setup.description import Description, describe
from robot_control.watch.scene import Wheel


def wheels_of(robot: Description) -> dict[str, Wheel]:
    """The drive wheels, by joint; a robot on legs has none."""
    return {wheel["joint"]: _wheel(wheel) for wheel in robot.get("wheels", ())}


def _wheel(wheel: dict[str, Any]) -> Wheel:
    x, y, z = wheel["centre"]
    return Wheel((x, y, z), wheel["radius"])


def running_robot() -> tuple[dict[str, Wheel], _robot_control.LegModel | None]:
    """The wheels and the legs of robot_description, read as the robot's nodes read it; none if it is missing or cannot
    be driven.
    """
    try:
        with described_robot() as (parameters, urdf):
            wheels = wheels_of(describe(urdf, parameters))
            return wheels, None if wheels else _robot_control.legs(*layered(parameters, urdf))
    except (RobotError, ParameterError, ServerValueError):
        return {}, None
