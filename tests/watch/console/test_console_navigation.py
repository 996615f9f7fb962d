"""Scans and grids as the page shows them."""

import base64
import math
from types import SimpleNamespace

import numpy as np
import pytest
from nav_msgs.msg import OccupancyGrid
from robot_control.robot.pose import Pose
from robot_control.watch.console.calls import CALLS, check_call
from robot_control.watch.console.messages import MessageError
from robot_control.watch.console.navigation import MAX_SIDE, NavigationView, NoGridError, points_of
from sensor_msgs.msg import LaserScan


def view_of(message):
    view = NavigationView.__new__(NavigationView)
    view._grids = {"map": SimpleNamespace(message=message, newest=(message, 0.0))}
    return view


def grid(width, height, data):
    message = OccupancyGrid(data=data)
    message.info.width, message.info.height, message.info.resolution = width, height, 0.05
    message.info.origin.orientation.w = 1.0
    return message


def test_rays_that_hit_are_points_in_the_frame_of_the_laser():
    scan = LaserScan(angle_min=0.0, angle_increment=math.pi / 2, range_min=0.1, range_max=8.0)
    scan.ranges = [1.0, math.inf, math.nan, 0.05]
    assert points_of(scan, Pose(1.0, 2.0, math.pi / 2)) == [(1.0, 3.0)]


def test_a_large_grid_has_coarser_cells_and_keeps_its_walls():
    side = 2 * MAX_SIDE
    cells = np.full((side, side), -1, dtype=np.int8)
    cells[7, 5] = 100
    sent = view_of(grid(side, side, cells.ravel().tolist())).grid("map")
    seen = np.frombuffer(base64.b64decode(sent["cells"]), dtype=np.int8).reshape(-1, sent["columns"])
    assert seen.shape == (MAX_SIDE, MAX_SIDE)
    assert sent["resolution"] == pytest.approx(0.1)
    assert np.argwhere(seen == 100).tolist() == [[3, 2]]


@pytest.mark.parametrize("name", ["map", "costmap", "../etc/passwd"])
def test_a_grid_that_is_none_is_not_sent(name):
    with pytest.raises(NoGridError):
        view_of(grid(3, 3, [0])).grid(name)


@pytest.mark.parametrize("name", ["goal", "place"])
@pytest.mark.parametrize("bad", [math.inf, 1e7, "1", None])
def test_a_goal_is_three_finite_numbers(name, bad):
    with pytest.raises(MessageError):
        check_call(name, {"x": bad, "y": 0.0, "yaw": 0.0})
    assert CALLS[name].role.name == "OPERATE"
