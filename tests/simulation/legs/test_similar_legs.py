"""Robots of like shape walk alike, whatever their size: no law of legs has a length or a mass of its own."""

from math import sqrt
from pathlib import Path
from xml.etree import ElementTree

import pytest
from robot_control import ClosedLoop
from robot_control.installed_files import share_file

POWERS = {"mass": 3, "inertia": 5, "effort": 4, "velocity": -0.5, "radius": 1, "length": 1, "size": 1, "xyz": 1}
"""of the scale: of an element's numbers, else of an attribute's; times change with its root"""


def scaled(scale: float, folder: Path) -> Path:
    """The quadbot `scale` times as large, of the same density; its motors are as strong for its weight."""
    tree = ElementTree.parse(share_file("urdf/quadbot.urdf"))
    for element in tree.iter():
        for name, text in element.attrib.items():
            power = POWERS.get(element.tag, POWERS.get(name))
            if power is not None and element.tag != "axis":
                element.set(name, " ".join(repr(float(value) * scale**power) for value in text.split()))
    path = folder / "scaled.urdf"
    tree.write(path)
    return path


@pytest.mark.parametrize("scale", [0.5, 2.0])
def test_a_robot_of_another_size_walks_as_the_quadbot(scale, tmp_path):
    loop = ClosedLoop(urdf=str(scaled(scale, tmp_path)))
    speed = 0.8 * sqrt(scale)
    loop.run(1.0)
    walk = loop.run(7.0 * sqrt(scale), (speed, 0.2 / sqrt(scale)))
    assert not walk["permit_causes"].any()
    assert walk["truth_linear"][-int(2000 * sqrt(scale)) :].mean() == pytest.approx(speed, rel=0.03)
