"""A robot as the C++ reader understood it: plain values, SI units, base axes (x forward, y left, z up)."""

from collections.abc import Mapping
from os import PathLike
from typing import Any

from robot_control import _robot_control
from robot_control.settings.parameter_layers import layered

Description = dict[str, Any]  # keys: python/bindings/describe.h


def describe(urdf: str | PathLike[str], params: str | PathLike[str] | Mapping[str, Any] | None = None) -> Description:
    """Reads a URDF or .xacro file with the `robot:` block of a YAML file, or of a nested dict, laid over it.

    Raises:
        RobotError: it cannot be driven, and why.
        ParameterError: the YAML file is wrong.
    """
    return _robot_control.describe(*layered(params, urdf))


def mjcf(urdf: str | PathLike[str], params: str | PathLike[str] | None = None) -> str:
    """The MJCF text of robot and scene, as `mujoco-simulate` opens it.

    Raises:
        RobotError, ParameterError: as `describe`.
        DriverError: the scene does not compile.
    """
    return _robot_control.mjcf(*layered(params, urdf))


def stand(urdf: str | PathLike[str], params: str | PathLike[str] | None = None) -> dict[str, Any]:
    """Starts a loop with the robot, as `ClosedLoop` does, and returns its rest in the scene, brakes on.

    `lean` is its tilt [rad], `carried` the part of its weight on the drive wheels, or on the legs. `unloaded` names the
    wheels without load and the links that touch the ground instead, "" if there are none.

    Raises:
        RobotError, ParameterError, DriverError: as `ClosedLoop`.
    """
    return _robot_control.stand(*layered(params, urdf))
