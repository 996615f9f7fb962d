"""The robot_description of this moment for the page, and the meshes that it names.

A mesh has an id, made of its name; the page asks for the id, and only files of this list are served.
"""

import hashlib
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import unquote
from xml.parsers import expat

import rospkg
import rospy

from robot_control.files.files import InputFileError, check_input
from robot_control.robot.server_values import ServerValueError

MAX_DESCRIPTION, MAX_PARTS, MAX_MESH = 4 << 20, 2000, 64 << 20
"""bytes, links and joints, bytes"""
PIECE = 1 << 16
"""bytes"""
FORMATS = {".stl", ".dae"}


class ModelError(ValueError):
    """The description or a mesh cannot be shown; the message says why."""


class Model:
    """The newest description."""

    def __init__(self, description: Callable[[], str]) -> None:
        """`description`: returns the URDF of this moment."""
        self._description = description
        self._meshes: dict[str, str] = {}  # id → name in the URDF

    def read(self) -> dict[str, Any]:
        """The URDF, and the id of each mesh's name. Raises ModelError."""
        try:
            description = self._description()
        except (ServerValueError, OSError, rospy.ROSException) as error:
            raise ModelError(f"robot_description: {error}") from None
        if not description:
            raise ModelError("there is no robot_description yet")
        if len(description) > MAX_DESCRIPTION or "<!" in description.replace("<!--", ""):
            raise ModelError("robot_description is too long, or has declarations of its own (<!DOCTYPE, <!ENTITY)")
        try:
            root = ET.fromstring(description)
        except ET.ParseError as error:
            raise ModelError(f"robot_description is not XML: {error}") from None
        if root.find("link") is None or len(root) > MAX_PARTS:
            raise ModelError("robot_description has no link, or too many parts")
        names = {each.get("filename", "") for each in root.iter("mesh")}
        self._meshes = {hashlib.sha256(name.encode()).hexdigest()[:16]: name for name in names}
        return {"urdf": description, "meshes": {name: key for key, name in self._meshes.items()}}

    def mesh(self, key: str) -> bytes:
        """Content of the mesh with this id. Raises ModelError, OSError."""
        if key not in self._meshes:
            raise ModelError("mesh not found")
        path = _path(self._meshes[key])
        try:
            check_input(path, MAX_MESH)
        except InputFileError as error:
            raise ModelError(str(error)) from None
        content = path.read_bytes()
        if path.suffix.lower() == ".dae":
            _check_xml(content)
        return content


def _path(name: str) -> Path:
    path = Path(unquote(name.removeprefix("file://")))
    if name.startswith("package://"):
        package, _, rest = name.removeprefix("package://").partition("/")
        try:
            path = Path(rospkg.RosPack().get_path(package), unquote(rest))
        except rospkg.ResourceNotFound:
            raise ModelError(f"there is no ROS package {package}") from None
    if not path.is_absolute() or path.suffix.lower() not in FORMATS:
        raise ModelError(f"{name}: must be an absolute path, file:// or package://, of STL or DAE")
    return path


def _check_xml(content: bytes) -> None:
    """Raises ModelError for what is not XML: a browser reports that with a style that the page's policy forbids.

    It is read in pieces, so that the server's other thread goes on.
    """
    parser = expat.ParserCreate()
    try:
        for at in range(0, len(content), PIECE):
            parser.Parse(content[at : at + PIECE], False)  # noqa: FBT003 (positional in expat)
        parser.Parse(b"", True)  # noqa: FBT003
    except expat.ExpatError as error:
        raise ModelError(f"is not XML: {error}") from None
