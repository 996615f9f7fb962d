"""The robot of a URDF as a tree for the page, and the meshes that it names. Pure but for reading files.

A mesh has an id, made of its name; the page asks for the id, and only files of this list are served.
"""

from __future__ import annotations

import hashlib
import math
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import unquote
from xml.parsers import expat

from robot_control.common.files import InputFileError, check_input

MAX_DESCRIPTION, MAX_LINKS, MAX_MESH = 4 << 20, 2000, 64 << 20
"""bytes, links, bytes"""
PIECE = 1 << 16
"""bytes"""
FORMATS = {".stl": "stl", ".dae": "dae", ".obj": "obj"}

Tree = dict[str, Any]


class ModelError(ValueError):
    """The description cannot be shown; the message says why."""


class Model:
    """Links, joints and shapes; and the mesh of each id."""

    def __init__(self, description: str, package: Callable[[str], str]) -> None:
        """`package`: the folder of a ROS package. Raises ModelError."""
        self._package = package
        self._meshes: dict[str, str] = {}  # id → name in the URDF
        if len(description) > MAX_DESCRIPTION or "<!" in description.replace("<!--", ""):
            raise ModelError("robot_description is too long, or has declarations of its own (<!DOCTYPE, <!ENTITY)")
        try:
            root = ET.fromstring(description)
        except ET.ParseError as error:
            raise ModelError(f"robot_description is no XML: {error}") from None
        links, joints = root.findall("link"), root.findall("joint")
        if not links or len(links) + len(joints) > MAX_LINKS:
            raise ModelError("robot_description has no link, or too many")
        self._colours = {each.get("name"): _colour(each) for each in root.findall("material")}
        self.tree: Tree = {
            "name": root.get("name", ""),
            "links": [{"name": link.get("name", ""), "visuals": self._visuals(link)} for link in links],
            "joints": [_joint(joint) for joint in joints],
        }

    def mesh(self, key: str) -> bytes:
        """Content of the mesh with this id.

        Raises:
            KeyError: there is none in the list.
            ModelError, OSError: it cannot be read.
        """
        name = self._meshes[key]
        path = self._path(name)
        try:
            check_input(path, MAX_MESH)
        except InputFileError as error:
            raise ModelError(str(error)) from None
        content = path.read_bytes()
        if path.suffix.lower() == ".dae":
            _check_xml(content)
        return content

    def _path(self, name: str) -> Path:
        if name.startswith("package://"):
            package, _, rest = name.removeprefix("package://").partition("/")
            path = Path(self._package(package), unquote(rest))
        else:
            path = Path(unquote(name.removeprefix("file://")))
        if not path.is_absolute() or path.suffix.lower() not in FORMATS:
            raise ModelError(f"{name}: must be an absolute path, file:// or package://, of STL, DAE or OBJ")
        return path

    def _visuals(self, link: ET.Element) -> list[Tree]:
        shapes = link.findall("visual") or link.findall("collision")
        return [shape for each in shapes if (shape := self._visual(each)) is not None]

    def _visual(self, visual: ET.Element) -> Tree | None:
        geometry = visual.find("geometry")
        shape = next(iter(geometry), None) if geometry is not None else None
        if shape is None:
            return None
        material = visual.find("material")
        own = None if material is None else _colour(material) or self._colours.get(material.get("name"))
        tree: Tree = {"shape": shape.tag, "colour": own, **_origin(visual)}
        if shape.tag == "mesh":
            name = shape.get("filename", "")
            key = hashlib.sha256(name.encode()).hexdigest()[:16]
            self._meshes[key] = name
            kind = FORMATS.get(Path(name).suffix.lower(), "")
            scale = _numbers(shape.get("scale"), 3, 1.0)
            tree |= {"mesh": key, "file": Path(name).name, "format": kind, "scale": scale}
        tree |= {"size": _numbers(shape.get("size"), 3, 0.1)} if shape.tag == "box" else {}
        return tree | {key: _numbers(shape.get(key), 1, 0.05)[0] for key in ("radius", "length") if key in shape.attrib}


def _check_xml(content: bytes) -> None:
    """Raises ModelError for what is no XML: a browser reports that with a style that the page's policy forbids.

    It is read in pieces, so that the server's other thread goes on.
    """
    parser = expat.ParserCreate()
    try:
        for at in range(0, len(content), PIECE):
            parser.Parse(content[at : at + PIECE], False)  # noqa: FBT003 (positional in expat)
        parser.Parse(b"", True)  # noqa: FBT003
    except expat.ExpatError as error:
        raise ModelError(f"is no XML: {error}") from None


def _joint(joint: ET.Element) -> Tree:
    parent, child, axis = joint.find("parent"), joint.find("child"), joint.find("axis")
    return {
        "name": joint.get("name", ""),
        "type": joint.get("type", "fixed"),
        "parent": "" if parent is None else parent.get("link", ""),
        "child": "" if child is None else child.get("link", ""),
        "axis": [1.0, 0.0, 0.0] if axis is None else _numbers(axis.get("xyz"), 3, 0.0),
        **_origin(joint),
    }


def _origin(element: ET.Element) -> Tree:
    origin = element.find("origin")
    given = {} if origin is None else origin.attrib
    return {name: _numbers(given.get(name), 3, 0.0) for name in ("xyz", "rpy")}


def _colour(material: ET.Element) -> list[float] | None:
    colour = material.find("color")
    return None if colour is None else _numbers(colour.get("rgba"), 4, 1.0)


def _numbers(text: str | None, count: int, default: float) -> list[float]:
    """As many finite numbers; the default for each where there are others."""
    try:
        numbers = [float(word) for word in (text or "").split()]
    except ValueError:
        numbers = []
    return numbers if len(numbers) == count and all(map(math.isfinite, numbers)) else [default] * count
