"""A robot on legs stands up and walks on a slope, in every direction to it."""

from math import radians, tan

import pytest
from robot_control import ClosedLoop
from robot_control.installed_files import share_file

SLOPE = radians(10)
"""docs/legs.md; uphill is ahead"""


@pytest.mark.parametrize("command", [(0.5, 0.0, 0.0), (-0.5, 0.0, 0.0), (0.0, 0.3, 0.0)], ids=["up", "down", "across"])
def test_it_walks_up_down_and_across_ten_degrees(command):
    loop = ClosedLoop({"mujoco_plant": {"slope": SLOPE}}, urdf=share_file("urdf/quadbot.urdf"))
    loop.run(0.5)  # it lies, and measures how
    start = loop.run(4.0, command)
    walk = loop.run(6.0, command)
    distance = [walk[axis][-1] - start[axis][-1] for axis in ("truth_x", "truth_y")]
    assert not walk["permit_causes"].any()
    assert walk["slope_ahead"][-500:].mean() == pytest.approx(tan(SLOPE), abs=0.05), "its accelerometer errs by 0.037"
    assert walk["slope_left"][-500:].mean() == pytest.approx(0.0, abs=0.05)
    assert distance[0] == pytest.approx(6.0 * command[0], abs=0.2)
    assert distance[1] == pytest.approx(6.0 * command[1], abs=0.2)
