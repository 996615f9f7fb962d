"""The robot_description of this moment as a Model; it is read again when a page asks for it."""

from __future__ import annotations

from typing import Any

import rospkg
import rospy

from robot_control.common.server_values import ServerValueError, server_description
from robot_control.console.model import Model, ModelError


class Models:
    """The newest model."""

    def __init__(self) -> None:
        self._model: Model | None = None

    def tree(self) -> dict[str, Any]:
        """For the page. Raises ModelError."""
        try:
            description = server_description()
        except (ServerValueError, OSError, rospy.ROSException) as error:
            raise ModelError(f"robot_description: {error}") from None
        if not description:
            raise ModelError("there is no robot_description yet")
        self._model = Model(description, _folder)
        return self._model.tree

    def mesh(self, key: str) -> bytes:
        """Raises KeyError, ModelError, OSError: as Model.mesh."""
        if self._model is None:
            raise KeyError(key)
        return self._model.mesh(key)


def _folder(package: str) -> str:
    try:
        path: str = rospkg.RosPack().get_path(package)
    except rospkg.ResourceNotFound:
        raise ModelError(f"there is no ROS package {package}") from None
    return path
