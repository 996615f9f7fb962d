"""Mapping and localisation in virtual time, on a short drive in the scene `room`."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from robot_control.installed_files import share_file

from bench.navigation.moved import distances
from bench.navigation.scene_map import read_scene
from bench.navigation.tour import LASER, drive, errors, new_loop
from bench.navigation.trajectories import composed

mrpt = pytest.importorskip("robot_control._mrpt", reason="built without MRPT: scripts/setup --navigation")

ROUND = ((2.0, 0.0), (0.0, 0.0), (2.0, 0.0))  # m, in the corridor
KNOWN = np.diag([0.01, 0.01, 0.003])  # m², m², rad²


@pytest.fixture(scope="module")
def sights():
    return list(drive(new_loop("room", 3), ROUND))


def mapped(sights, mapper):
    poses = []
    for sight in sights:
        mapper.update(sight.scan, LASER, sight.odometry, sight.covariance)
        poses.append(mapper.pose)
    return np.array(poses)


@pytest.fixture(scope="module")
def grid(sights):
    mapper = mrpt.Mapper()
    mapped(sights, mapper)
    return mapper.map


def test_the_map_shows_the_true_walls_and_the_pose_in_it(sights):
    mapper = mrpt.Mapper()
    off = errors(sights, mapped(sights, mapper))
    assert np.sqrt(np.mean(off[:, 0] ** 2 + off[:, 1] ** 2)) < 0.03
    x, y, resolution, cells = mapper.map
    rows, columns = np.nonzero(cells >= 65)
    walls = np.column_stack((x + (columns + 0.5) * resolution, y + (rows + 0.5) * resolution))
    assert len(walls) > 200
    away = distances(read_scene(Path(share_file("urdf/scenes/room.xml"))), walls)
    assert np.sqrt(np.mean(away**2)) < 0.05
    assert np.mean(away > 0.1) < 0.05


def test_a_map_begins_with_the_first_wall_in_sight(sights):
    mapper = mrpt.Mapper()
    nothing = dict(sights[0].scan, ranges=np.full(len(sights[0].scan["ranges"]), np.inf, dtype=np.float32))
    mapper.update(nothing, LASER, sights[0].odometry, sights[0].covariance)
    mapped(sights[:20], mapper)
    assert len(mapper.nodes) == 1
    assert mapper.reason == ""


def test_what_is_seen_again_adds_little(sights):
    mapper = mrpt.Mapper()
    mapped(sights, mapper)
    once = len(mapper.nodes)
    for _ in range(4):
        mapped(sights[::-1], mapper)
        mapped(sights, mapper)
    assert len(mapper.nodes) < 1.3 * once


def test_a_saved_map_goes_on_where_the_robot_is(sights, grid):
    """The odometry begins again, at another place of the map."""
    again = sights[len(sights) // 2 :]
    mapper = mrpt.Mapper(grid)
    mapper.set_pose(again[0].truth)
    off = errors(again, mapped(again, mapper))
    assert np.max(np.hypot(off[:, 0], off[:, 1])) < 0.08


def test_a_saved_map_with_its_graph_goes_on_as_if_it_had_not_been_saved(sights, tmp_path):
    first, rest = sights[: len(sights) // 2], sights[len(sights) // 2 :]
    mapper = mrpt.Mapper()
    mapped(first, mapper)
    mapper.save(str(tmp_path / "house.yaml"))
    again = mrpt.Mapper.load(str(tmp_path / "house.yaml"))
    assert again.nodes == mapper.nodes
    again.set_pose(mapper.pose)
    off = errors(rest, mapped(rest, again))
    assert np.max(np.hypot(off[:, 0], off[:, 1])) < 0.05
    assert len(again.nodes) < 1.3 * len(mapper.nodes)


def test_a_robot_whose_odometry_jumps_is_found_in_its_own_map(sights):
    half = len(sights) // 2
    mapper = mrpt.Mapper()
    mapped(sights[:half], mapper)
    jump = np.array([0.8, 0.7, 0.3])
    for sight in sights[half:]:
        mapper.update(sight.scan, LASER, composed(jump, sight.odometry), sight.covariance)
    assert mapper.reason == ""
    assert np.hypot(*(np.array(mapper.pose) - sights[-1].truth)[:2]) < 0.1


def test_a_scan_of_another_place_does_not_change_the_map(sights, grid):
    mapper = mrpt.Mapper(grid)
    ranges = np.full(len(sights[0].scan["ranges"]), 0.5, dtype=np.float32)
    mapped([replace(sight, scan=dict(sight.scan, ranges=ranges)) for sight in sights[:20]], mapper)
    assert "drive on in a mapped area" in mapper.reason
    assert np.array_equal(mapper.map[3] >= 65, grid[3] >= 65)


def followed(localizer, sights):
    states = []
    for sight in sights:
        localizer.update(sight.scan, LASER, sight.odometry, sight.covariance)
        states.append(localizer.state)
    return states


def test_a_robot_is_followed_in_the_map_and_its_ellipse_is_true(sights, grid):
    localizer = mrpt.Localizer(grid, 1)
    assert localizer.state == "no pose"
    assert "initialpose" in localizer.reason
    localizer.set_pose(sights[0].truth, KNOWN)
    assert set(followed(localizer, sights)) == {"localized"}
    pose, covariance = localizer.pose
    off = errors(sights[-1:], np.array([pose]))[0]
    assert np.hypot(off[0], off[1]) < 0.05
    assert off @ np.linalg.solve(covariance, off) < 11.3  # 99 % in three dimensions


def test_a_pose_that_is_set_holds_from_the_next_scan_on(sights, grid):
    """Only the scan says where the odometry was; until then no correction may be read from a pose."""
    localizer = mrpt.Localizer(grid, 1)
    for place in (0, len(sights) // 2):
        localizer.set_pose(sights[place].truth, KNOWN)
        assert localizer.state == "no pose"
        assert "no scan was used since" in localizer.reason
        assert followed(localizer, sights[place : place + 1]) == ["localized"]
        assert localizer.reason == ""
        assert np.hypot(*(np.array(localizer.pose[0]) - sights[place].truth)[:2]) < 0.05


def test_a_map_whose_origin_lies_within_a_cell_keeps_its_walls_and_places(sights, grid):
    """Maps of other programs begin anywhere."""
    x, y, resolution, cells = grid
    shift = np.array([0.5 * resolution, -0.3 * resolution, 0.0])
    moved = (x + shift[0], y + shift[1], resolution, cells)
    assert np.array_equal(mrpt.Mapper(moved).map[3] >= 65, cells >= 65)
    localizer, given = mrpt.Localizer(moved, 1), mrpt.Localizer(grid, 1)
    localizer.set_pose(sights[0].truth + shift, KNOWN)
    given.set_pose(sights[0].truth, KNOWN)
    followed(localizer, sights)
    followed(given, sights)
    assert localizer.pose[0] == pytest.approx(given.pose[0] + shift, abs=0.01)


def test_the_same_seed_gives_the_same_pose(sights, grid):
    """Whatever another localizer has drawn before."""

    def last(count: int) -> list[float]:
        localizer = mrpt.Localizer(grid, 7)
        localizer.set_pose(sights[0].truth, KNOWN)
        followed(localizer, sights[:count])
        return localizer.pose[0]

    assert [last(20) for before in range(4) if last(before + 1)] == [last(20)] * 4


def test_a_robot_in_another_house_is_lost_and_says_why(sights, grid):
    localizer = mrpt.Localizer(grid, 1)
    localizer.set_pose(sights[0].truth, KNOWN)
    states = followed(localizer, list(drive(new_loop("loop", 3), ROUND))[:60])
    assert states.index("lost") < 50  # 5 s
    assert "of the scan matches the map there" in localizer.reason


def test_a_search_finds_the_place_while_the_robot_drives(sights, grid):
    localizer = mrpt.Localizer(grid, 1)
    localizer.search()
    assert followed(localizer, sights[:1]) == ["searching"]
    assert "drive on" in localizer.reason
    assert followed(localizer, sights[1:])[-1] == "localized"
    off = errors(sights[-1:], np.array([localizer.pose[0]]))[0]
    assert np.hypot(off[0], off[1]) < 0.1


def test_a_map_without_walls_is_refused():
    with pytest.raises(ValueError, match="no occupied cell"):
        mrpt.Localizer((0.0, 0.0, 0.05, np.zeros((10, 10), np.int8)), 1)
