"""The model that is simulated, made to be looked at: colours, light, the path driven, a keyframe per picture. Pure."""

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from robot_control.data.render.run import Moment

STEP = 0.05
"""m between two points of the path driven"""
MAX_POINTS = 1500
DEGREES_OF_FREEDOM = {"free": 7, "ball": 4, "slide": 1, "hinge": 1}
"""numbers in qpos per type of joint"""
UNCOLOURED, MARK = "0.6 0.65 0.7 1", "0.85 0.86 0.88 1"
THING, PATH = "0.72 0.55 0.36 1", "0.10 0.39 0.86 1"
"""colours: red, green, blue, opacity; the first one of a link without material, as in the console"""
SHAPE = re.compile("robot_control/shape/[0-9]+/(.+)")
"""name of a shape, which holds that of its link"""
UNTOUCHABLE = {"contype": "0", "conaffinity": "0"}
HIDDEN = "5"
"""group of shapes that are not drawn"""

Vector = tuple[float, float, float]


def colours_of(urdf: str) -> dict[str, str]:
    """Link → colour of the material of its first shape that is seen, by the rules of URDF."""
    robot = ET.fromstring(urdf)
    named = {each.get("name"): each.find("color") for each in robot.iterfind("material")}
    colours = {}
    for link in robot.iterfind("link"):
        material = link.find("visual/material")
        if material is None:
            continue
        own = material.find("color")
        colour = named.get(material.get("name")) if own is None else own
        if colour is not None:
            colours[link.get("name", "")] = colour.get("rgba", UNCOLOURED)
    return colours


class Scene:
    """An MJCF text of robot and world (exported_mjcf), to which pictures are added; `colours`: of colours_of."""

    def __init__(self, mjcf: str, colours: Mapping[str, str]) -> None:
        self._root, self._colours = ET.fromstring(mjcf), colours
        world = self._root.find("worldbody")
        robots = [body for body in self._root.iter("body") if body.find("joint[@type='free']") is not None]
        if world is None or not robots:
            raise ValueError("the model holds no robot")
        self._world, self._robot = world, robots[0]
        self._start = _numbers(self._robot.get("pos"), (0.0, 0.0, 0.0))
        w, x, y, z = _numbers(self._robot.get("quat"), (1.0, 0.0, 0.0, 0.0))
        self._attitude = Rotation.from_quat((x, y, z, w))

    @property
    def size(self) -> float:
        """m from the robot's origin to its farthest shape."""
        reach = [0.2]
        for body in self._robot.iter("body"):
            at = _numbers(body.get("pos"), (0.0,)) if body is not self._robot else (0.0,)
            for geom in body.findall("geom"):
                sizes = _numbers(geom.get("size"), (0.0,))
                reach.append(math.hypot(*at) + math.hypot(*_numbers(geom.get("pos"), (0.0, 0.0, 0.0))) + max(sizes))
        return max(reach)

    def place(self, moment: Moment) -> Vector:
        """Place of the robot's origin in the world, m."""
        x, y, z = (self._start + self._attitude.apply((moment.x, moment.y, moment.z))).tolist()
        return x, y, z

    def written(self, moments: Sequence[Moment], width: int, height: int) -> str:
        """The MJCF with everything; keyframe i shows moment i."""
        self._add_keyframes(moments)
        self._add_looks(width, height)
        self._add_path(moments)
        return ET.tostring(self._root, encoding="unicode")

    def _add_keyframes(self, moments: Sequence[Moment]) -> None:
        frames = ET.SubElement(self._root, "keyframe")
        for moment in moments:
            turned = Rotation.from_euler("xyz", (moment.roll, moment.pitch, moment.yaw))
            x, y, z, w = (self._attitude * turned).as_quat()
            numbers: list[float] = []
            for joint in self._root.iter("joint"):
                kind = joint.get("type", "hinge")
                if kind == "free":
                    numbers += [*self.place(moment), w, x, y, z]
                elif DEGREES_OF_FREEDOM[kind] == 1:
                    numbers.append(moment.joints.get(joint.get("name", ""), 0.0))
                else:
                    numbers += [1.0, 0.0, 0.0, 0.0]
            ET.SubElement(frames, "key", qpos=" ".join(f"{number:.6g}" for number in numbers))

    def _add_looks(self, width: int, height: int) -> None:
        visual = _child(self._root, "visual")
        _child(visual, "global").attrib.update(offwidth=str(width), offheight=str(height))
        _child(visual, "quality").attrib.update(offsamples="8", shadowsize="4096")
        _child(visual, "headlight").attrib.update(ambient="0.35 0.35 0.35", diffuse="0.35 0.35 0.35", specular="0 0 0")
        assets, floor = _child(self._root, "asset"), "robot_control/floor"
        sky = {"type": "skybox", "builtin": "gradient", "rgb1": "0.86 0.90 0.94", "rgb2": "0.45 0.55 0.68"}
        tiles = {"type": "2d", "builtin": "checker", "rgb1": "0.62 0.64 0.66", "rgb2": "0.54 0.56 0.58"}
        ET.SubElement(assets, "texture", sky, name="robot_control/sky", width="256", height="1536")
        ET.SubElement(assets, "texture", tiles, name=floor, width="256", height="256")
        ET.SubElement(assets, "material", name=floor, texture=floor, texrepeat="1 1", texuniform="true")
        for light in self._world.findall("light"):
            self._world.remove(light)
        # Light that is equally bright everywhere; it moves with the robot, so that its shadow stays sharp.
        sun = {"pos": "-1 1 3", "dir": "0.3 -0.3 -1", "diffuse": "0.55 0.55 0.55", "specular": "0.1 0.1 0.1"}
        ET.SubElement(self._robot, "light", sun, mode="trackcom", directional="true", castshadow="true")
        self._colour_world(floor)
        self._colour_robot()

    def _colour_world(self, floor: str) -> None:
        """Colours the shapes that have no colour of their own."""
        robot = set(self._robot.iter("geom"))
        for geom in self._root.iter("geom"):
            if geom in robot or geom.get("material") is not None or geom.get("rgba") is not None:
                continue
            if geom.get("type") == "plane":
                geom.set("material", floor)
            else:
                geom.set("rgba", THING)

    def _colour_robot(self) -> None:
        for site in self._robot.iter("site"):
            site.set("group", HIDDEN)
        for body in self._robot.iter("body"):
            for geom in body.findall("geom"):
                name = geom.get("name") or ""
                shape = SHAPE.fullmatch(name)
                geom.set("rgba", self._colours.get(shape[1] if shape else body.get("name", ""), UNCOLOURED))
                if name.startswith("robot_control/wheel/"):
                    _make_wheel(body, geom)

    def _add_path(self, moments: Sequence[Moment]) -> None:
        ground = self._ground()
        on_ground = moments if ground is not None else [replace(moment, z=0.0) for moment in moments]
        places = [self.place(moment) for moment in on_ground]
        points = [places[0]]
        step = max(STEP, sum(math.dist(a, b) for a, b in pairwise(places)) / MAX_POINTS)
        for place in places[1:]:
            if math.dist(place, points[-1]) > step:
                points.append(place)
        under = self._attitude.apply((0.0, 0.0, -self._start[2] if ground is None else ground))
        for ends in pairwise(points + under):
            fromto = " ".join(f"{number:.4f}" for number in np.ravel(ends))
            ET.SubElement(self._world, "geom", UNTOUCHABLE, type="capsule", size="0.008", fromto=fromto, rgba=PATH)

    def _ground(self) -> float | None:
        """m below the robot's origin, by its wheels; None on legs, whose path is drawn at the height 0 of the world."""
        lows = [
            _numbers(body.get("pos"), (0.0, 0.0, 0.0))[2] - _numbers(geom.get("size"), (0.0,))[0]
            for body in self._robot.iter("body")
            for geom in body.findall("geom")
            if (geom.get("name") or "").startswith("robot_control/wheel/")
        ]
        return min(lows, default=None)


def _make_wheel(body: ET.Element, geom: ET.Element) -> None:
    """Draws a wheel, which is simulated as an ellipsoid, as a cylinder with a mark that shows its turning."""
    sizes = _numbers(geom.get("size"), (0.0,))
    if geom.get("type") != "ellipsoid" or len(sizes) != 3 or abs(sizes[0] - sizes[1]) > 1e-9:
        return
    radius, _, half = sizes
    geom.attrib.update(type="cylinder", size=f"{radius:.6g} {half:.6g}")
    mark = {"type": "box", "size": f"{0.8 * radius:.6g} {0.12 * radius:.6g} {1.04 * half:.6g}", "rgba": MARK}
    for name in ("pos", "quat"):
        if geom.get(name) is not None:
            mark[name] = str(geom.get(name))
    ET.SubElement(body, "geom", UNTOUCHABLE | mark, mass="0")


def _child(parent: ET.Element, tag: str) -> ET.Element:
    found = parent.find(tag)
    return ET.SubElement(parent, tag) if found is None else found


def _numbers(text: str | None, default: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(float(part) for part in text.split()) if text else default
