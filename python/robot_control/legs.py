"""Kinematics of the legs of a quadruped, in closed form, as the controller computes them.

Joints are ordered front left, front right, rear left, rear right, each from the body outwards; feet likewise.
"""

from functools import lru_cache
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robot_control import _robot_control
from robot_control.settings.parameter_layers import layered

Array = NDArray[np.float64]
Robot = str | PathLike[str]
"""path of a URDF or .xacro file"""


def forward(robot: Robot, angles: ArrayLike) -> Array:
    """Centres of the feet in the axes of the base, m, shape (4, 3), for joint angles of shape (12,), rad.

    Raises:
        RobotError: the robot does not stand on four legs, and why.
        ValueError: the angles have another shape, or are not finite.
    """
    return np.asarray(_model(str(robot)).forward(_checked(angles, (12,), "angles")), dtype=np.float64)


def inverse(robot: Robot, feet: ArrayLike) -> tuple[Array, list[str]]:
    """Joint angles of shape (12,), rad, that bring the feet to `feet`, shape (4, 3), m, in the axes of the base.

    There is one word per foot. With "beyond reach" the lengths of its leg do not allow it. With "beyond range" the
    ranges of its joints do not. The angles are then those of the nearest point within the ranges. Every other
    foot is "reached".

    Raises:
        RobotError, ValueError: as `forward`.
    """
    angles, reach = _model(str(robot)).inverse(_checked(feet, (4, 3), "feet"))
    return np.asarray(angles, dtype=np.float64), list(reach)


def jacobian(robot: Robot, angles: ArrayLike) -> Array:
    """Derivatives of each foot's centre by the three angles of its leg, m/rad, shape (4, 3, 3): leg, axis, joint.

    Raises:
        RobotError, ValueError: as `forward`.
    """
    return np.asarray(_model(str(robot)).jacobian(_checked(angles, (12,), "angles")), dtype=np.float64)


def _model(robot: str) -> _robot_control.LegModel:
    path = Path(robot).absolute()
    try:
        state = path.stat()
    except OSError:  # reading it says why
        return _robot_control.legs(*layered(None, path))
    return _model_of(path, state.st_mtime_ns, state.st_size)


@lru_cache(maxsize=8)
def _model_of(path: Path, _changed_ns: int, _size: int) -> _robot_control.LegModel:
    return _robot_control.legs(*layered(None, path))


def _checked(values: ArrayLike, shape: tuple[int, ...], name: str) -> Array:
    array = np.asarray(values, dtype=np.float64)
    if array.shape != shape:
        raise ValueError(f"{name} must have the shape {shape}; they have {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite; they are {array.tolist()}")
    return array
