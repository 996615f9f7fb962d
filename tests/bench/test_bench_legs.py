"""How scripts/bench legs judges its figures."""

import pytest

from bench import legs, markdown
from bench.rows import plain


def measured(name, value):
    return plain(name, value, "m")


@pytest.mark.parametrize(
    ("figure", "value", "ratio"),
    [
        ("tilt with foot front_left", 0.02, 0.5),
        ("tilt, swaying", 0.3, 2),
        ("stops", 0, 0),
        ("stops", 1, 2),
        ("mass matrix against MuJoCo", 5e-10, 0.5),
        ("NEES of the pose, eight", 1, 0.5),
        ("NEES of the pose, eight", 0.4, 1.25),
        ("NEES of the pose, eight", 2.5, 1.25),
        ("error of the way between two resets", 0.5, 0.5),
        ("turned over by a fault", 0.1, 2),
    ],
)
def test_a_figure_has_the_bound_of_its_longest_known_beginning(figure, value, ratio):
    row = legs.judged(measured(f"quadbot {figure}", value), "stop")
    assert row["name"] == f"quadbot stop: {figure}"
    assert row["ratio"] == pytest.approx(ratio)
    assert row["reference_name"] == markdown.ALLOWED


def test_what_has_no_bound_is_measured_alone():
    for figure in ("1.5 m/s, turned over", "neither, motor off", "mean error of the way between two resets"):
        row = legs.judged(measured(f"quadbot {figure}", 1), "push")
        assert (row["ratio"], row["reference_name"]) == (0, markdown.NO_BOUND)


def test_an_unknown_figure_is_an_error():
    with pytest.raises(ValueError, match="empty"):
        legs.judged(measured("quadbot colour", 1), "stop")


def test_one_figure_beyond_its_bound_is_a_failure():
    lines = []
    rows = [measured("quadbot RMS of foot rear_left", 0.006), measured("quadbot stops", 0)]
    result, good = legs.bench(["circle"], 0, None, lambda *_: {"rows": rows}, lines.append)
    assert not good
    assert lines == ["missed: quadbot circle: RMS of foot rear_left: 0.006 m, at most 0.005"]
    assert "| circle: stops [m] | 0 | 0 | 0 % |" in markdown.table(result)
    assert legs.bench(["circle"], 0, None, lambda *_: {"rows": rows[1:]}, lines.append)[1]
