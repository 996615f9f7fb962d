"""Makes the factsheet of the running robot from robot_description, its limits in force and the settings."""

import time
import xml.etree.ElementTree as ET

import numpy as np

from robot_control.drive.path.follower import FollowParameters
from robot_control.drive.speed_limits import SpeedLimits
from robot_control.fleet.settings import Settings
from robot_control.fleet.v2.state import Machine
from robot_control.installed_files import share_file
from robot_control.robot.live_parameters import LiveParameters
from robot_control.robot.server_values import described_robot, server_description
from robot_control.setup.description import Description, describe
from robot_control.setup.shapes import triangles_in_base

PATIENCE = 5.0
"""s until robot_description is set"""


def running_description() -> Description:
    """robot_description as the robot's nodes read it.

    Raises:
        RobotError, ParameterError, ServerValueError: it is missing or cannot be driven.
    """
    end = time.monotonic() + PATIENCE
    while not server_description() and time.monotonic() < end:
        time.sleep(0.1)
    with described_robot() as (parameters, urdf):
        return describe(urdf, parameters)


def size_of(robot: Description) -> tuple[float, float, float]:
    """m: length, width and height; the height of a robot on legs is that with stretched ones."""
    corners = [corner for shape in robot["shapes"] for corner in triangles_in_base(shape).reshape(-1, 3)]
    corners += [
        np.array((*leg["hip"][:2], leg["hip"][2] - leg["length"] - leg["foot_radius"])) for leg in robot.get("legs", ())
    ]
    size = np.ptp(np.asarray(corners), axis=0) if corners else np.zeros(3)
    return float(size[0]), float(size[1]), float(size[2])


def machine_of(robot: Description, settings: Settings) -> Machine:
    """The machine of a robot; the smaller limit of follow_path and of the controller holds."""
    law, limits, live = FollowParameters(), SpeedLimits().newest(), LiveParameters()
    length, width, height = size_of(robot)
    return Machine(
        series=robot["name"],
        length=length,
        width=width,
        height=height,
        speed=min(settings.speed, limits.linear),
        slowest=law.slowest,
        acceleration=live.value("max_linear_acceleration", law.deceleration),
        deceleration=law.deceleration,
        wheels=tuple((w["centre"][0], w["centre"][1], 2 * w["radius"], w["width"]) for w in robot.get("wheels", ())),
        software=ET.parse(share_file("package.xml")).findtext("version", ""),
        actions=settings.kinds,
        visualization_period=1 / settings.visualization_rate if settings.visualization_rate else 0.0,
    )
