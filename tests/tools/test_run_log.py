import numpy as np
import pytest
from robot_control.common.run_log import LogError, joint_names, last, read_log


def write(tmp_path, text):
    path = tmp_path / "run.csv"
    path.write_text(text)
    return path


def test_columns_come_back_by_name(tmp_path):
    log = read_log(write(tmp_path, "run,cycle,truth_x\n0,0,0.5\n0,1,-1e-3\n"))
    assert log["cycle"].tolist() == [0, 1]
    assert log["truth_x"].tolist() == [0.5, -0.001]


def test_an_empty_cell_is_nan(tmp_path):
    assert np.isnan(read_log(write(tmp_path, "run,cycle,truth_x\n0,0,\n"))["truth_x"][0])


def test_a_last_line_cut_short_is_left_out(tmp_path):
    assert read_log(write(tmp_path, "run,cycle,truth_x\n0,0,1\n0,1"))["cycle"].tolist() == [0]


def test_of_several_runs_the_last_is_read(tmp_path):
    assert read_log(write(tmp_path, "run,cycle\n0,0\n0,1\n1,0\n"))["cycle"].tolist() == [0]


@pytest.mark.parametrize(
    ("text", "message"), [("", "no columns"), ("a,b\n1,2\n", "no columns"), ("run,cycle\n", "no rows")]
)
def test_what_is_no_log_is_refused(tmp_path, text, message):
    with pytest.raises(LogError, match=message):
        read_log(write(tmp_path, text))


def test_joints_are_found_by_their_effort():
    assert joint_names({"time": None, "left_effort": None, "left_effort_command": None, "a_b_effort": None}) == [
        "left",
        "a_b",
    ]


def test_last_skips_nan():
    assert last(np.array([1.0, 2.0, np.nan])) == 2.0
    assert np.isnan(last(np.array([np.nan])))
