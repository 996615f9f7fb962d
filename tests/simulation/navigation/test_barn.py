"""Fields of cylinders by the rule of BARN, and a robot that crosses one without a map."""

import json
import math

import numpy as np
import pytest

from bench.navigation import barn


def cells_of(*rows):
    return np.array([[cell == "#" for cell in row] for row in rows])


def test_a_lone_cell_is_emptied_and_a_hole_is_filled():
    given = cells_of(".......", ".......", ".......", ".#.....", ".......", ".......", ".......")
    assert not barn.smoothed(given)[3, 1]
    given = cells_of(".......", ".......", "...###.", "...#.#.", ".......", ".......", ".......")
    assert barn.smoothed(given)[3, 4]
    assert barn.smoothed(given)[2, 3]


def test_a_row_at_the_wall_stays_and_one_at_the_open_side_shrinks():
    given = np.zeros((7, 7), bool)
    given[0] = True
    assert barn.smoothed(given)[0].all()
    given = np.zeros((7, 7), bool)
    given[3] = True
    assert barn.smoothed(given)[3].tolist() == [False, *[True] * 5, False]


@pytest.mark.parametrize("seed", range(12))
def test_a_world_has_walls_and_a_way(seed):
    world = barn.generated(seed)
    assert world == barn.generated(seed)
    places = np.array(world.cylinders)
    assert places[:, 0].min() == pytest.approx(-2.925)
    assert places[:, 0].max() == pytest.approx(6.525)
    assert (places[:, 1].min(), places[:, 1].max()) == pytest.approx((-1.925, 2.425))
    assert math.hypot(*barn.GOAL[:2]) - barn.CELL < world.length < 20
    assert min(math.hypot(x, y) for x, y in world.cylinders) > 1.5


def test_a_way_is_as_wide_as_five_cells():
    cells = np.zeros((barn.ROWS, barn.COLUMNS), bool)
    cells[:, 40] = True
    assert math.isinf(barn.shortest(cells))
    cells[11:15, 40] = False
    assert math.isinf(barn.shortest(cells))
    cells[15, 40] = False
    assert barn.shortest(cells) == pytest.approx((86 - 20) * barn.CELL)


def test_public_worlds_are_read_from_their_folder(tmp_path):
    (tmp_path / "10.json").write_text(json.dumps({"cyl": [[1.0, 2.0]], "path": [], "length": 11.5}))
    (tmp_path / "9.json").write_text(json.dumps({"cyl": [[3.0, 2.0]], "path": [], "length": 12.5}))
    assert barn.public(tmp_path) == [barn.World("9", ((3.0, 2.0),), 12.5), barn.World("10", ((1.0, 2.0),), 11.5)]
    with pytest.raises(RuntimeError, match=r"no worlds of BARN there, files N\.json"):
        barn.public(tmp_path / "none")


def test_a_robot_without_a_map_crosses_a_field():
    drive = barn.drive((barn.generated(0), "none", 0.5, False))
    assert drive.arrived, drive.trip.reason
    assert drive.trip.air > 0
    assert not drive.trip.doubts
