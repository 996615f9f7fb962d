"""Paths driven by the closed loop, in virtual time: the distances from the path and from its end."""

import math

import pytest
from robot_control.drive.path.shapes import SHAPES
from robot_control.drive.path.waypoints import Waypoint
from robot_control.installed_files import share_file
from simulation.path_drive import assert_ends_at, driven


@pytest.mark.parametrize(("shape", "size"), [("square", 4.0), ("circle", 3.0), ("eight", 5.0)])
def test_a_shape_at_half_a_metre_per_second(shape, size):
    follower, ends, true_error = driven(SHAPES[shape](size))
    end = ends["estimate"]
    true_end = ends["truth"]
    print(
        f"{shape} {size:g} m: cross-track {1000 * follower.worst_cross_track_error:.1f} mm "
        f"(true {1000 * true_error:.1f}), end {1000 * math.hypot(end.x, end.y):.1f} mm, "
        f"{math.degrees(end.yaw):.2f} deg; true end {1000 * math.hypot(true_end.x, true_end.y):.1f} mm, "
        f"{math.degrees(true_end.yaw):.2f} deg"
    )
    assert follower.worst_cross_track_error <= 0.03
    assert_ends_at(end, 0.0, 0.0, 0.0)


def test_backwards_where_the_poses_point_against_the_path():
    points = [Waypoint(0.0, 0.0, 0.0), Waypoint(1.0, 0.0, 0.0), Waypoint(0.0, 0.0, 0.0)]
    follower, ends, _ = driven(points)
    assert follower.worst_cross_track_error <= 0.03
    assert_ends_at(ends["estimate"], 0.0, 0.0, 0.0)


def test_a_path_of_ten_thousand_points():
    points = [Waypoint(4.0 * n / 10_000, 0.3 * math.sin(2 * math.pi * n / 10_000)) for n in range(10_001)]
    follower, ends, _ = driven(points)
    assert follower.worst_cross_track_error <= 0.03
    end = ends["estimate"]
    assert math.hypot(end.x - 4.0, end.y) <= 0.02


@pytest.mark.nightly
@pytest.mark.parametrize(
    "world",
    [
        {"scene": share_file("urdf/scenes/slope_5deg.xml")},
        {"scene": share_file("urdf/scenes/low_friction_patch.xml")},
        {"params": {"mujoco_plant": {"payload": 6.0, "payload_x": 0.1}}},
    ],
    ids=["slope", "low_friction_patch", "payload"],
)
def test_a_square_elsewhere(world):
    follower, ends, true_error = driven(SHAPES["square"](2.0), **world)
    end = ends["estimate"]
    print(
        f"{world}: cross-track {1000 * follower.worst_cross_track_error:.1f} mm "
        f"(true {1000 * true_error:.1f}), end {1000 * math.hypot(end.x, end.y):.1f} mm, "
        f"true {1000 * math.hypot(ends['truth'].x, ends['truth'].y):.1f} mm"
    )
    assert follower.worst_cross_track_error <= 0.1
