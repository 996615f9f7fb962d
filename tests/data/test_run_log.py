from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.data.run_log import LogError, is_run_log, joint_names, last, read_log, read_run
from robot_control.installed_files import share_file
from std_msgs.msg import String


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is not a run.bag"),
        ("run,cycle\n0,0\n", "is not a run.bag .export.py makes a run.csv"),
    ],
    ids=["nothing", "table"],
)
def test_what_is_no_log_is_refused(tmp_path, text, message):
    path = tmp_path / "run.csv"
    path.write_text(text)
    with pytest.raises(LogError, match=message):
        read_log(path)


def test_a_column_that_is_not_there_is_named_with_the_file(bag_and_log):
    path, _ = bag_and_log
    log = read_log(path)
    assert "left_wing_effort" not in log
    with pytest.raises(LogError, match=r"run\.bag: no column left_wing_effort, which is needed here"):
        log["left_wing_effort"]


def test_joints_are_found_by_their_effort():
    assert joint_names({"time": None, "left_effort": None, "left_effort_command": None, "a_b_effort": None}) == [
        "left",
        "a_b",
    ]


def test_last_skips_nan():
    assert last(np.array([1.0, 2.0, np.nan])) == 2.0
    assert np.isnan(last(np.array([np.nan])))


@pytest.fixture(scope="module")
def bag_and_log(tmp_path_factory):
    """A run.bag, and the log that the loop itself returned."""
    folder = tmp_path_factory.mktemp("bag")
    loop = ClosedLoop(seed=3)
    loop.log_into(folder)
    log = loop.run(3.0, lambda t: (0.4, 0.3 if t > 1 else 0.0))
    loop.end_log()
    return folder / "run.bag", log


def test_a_bag_gives_the_columns_of_the_table(bag_and_log):
    path, log = bag_and_log
    read = read_log(path)
    assert [name for name in read if name in log] == list(log)  # those of timing stand between
    for name, values in log.items():
        # Outputs are recorded as float32, of relative error 2^-24; angles are computed of four of them.
        np.testing.assert_allclose(read[name], values, rtol=3e-7, atol=3e-7, err_msg=name)


def test_a_bag_gives_what_the_laws_took_in_bit_for_bit(bag_and_log):
    path, log = bag_and_log
    read = read_log(path)
    joints = [f"{joint}_{what}" for joint in joint_names(log) for what in ("position", "velocity", "effort")]
    for name in [*joints, "gyro_x", "gyro_z", "accel_x", "accel_z", "requested_linear", "max_linear_speed", "cycle"]:
        assert np.array_equal(read[name], log[name]), name


def test_of_a_bag_only_the_wanted_columns_are_read(bag_and_log):
    path, _ = bag_and_log
    assert list(read_log(path, ["cycle", "gyro_z", "nowhere"])) == ["cycle", "gyro_z"]


def test_a_bag_says_of_which_robot_and_how_it_was_made(bag_and_log):
    path, log = bag_and_log
    run = read_run(path)
    assert run.header["robot"] == "diffbot"
    assert run.header["joints"] == joint_names(log)
    assert run.header["contacts"] == ["left_wheel_link", "right_wheel_link"]
    assert run.header["period"] == 0.001
    assert "max_linear_speed" in run.header["parameters"]
    assert (run.runs, run.lost, run.cut) == (1, 0, "")
    assert np.all(np.diff(run.ros_time) > 0)


def test_a_scene_that_is_not_utf_8_does_not_make_a_log_unreadable(tmp_path):
    scene = Path(share_file("urdf/scenes/flat.xml")).read_bytes().replace(b"<mujoco", b"<!-- 20 \xb0C --><mujoco", 1)
    (tmp_path / "scene.xml").write_bytes(scene)
    loop = ClosedLoop(scene=str(tmp_path / "scene.xml"))
    loop.log_into(tmp_path)
    loop.run(0.1)
    loop.end_log()
    assert "<!-- 20 \ufffdC -->" in read_run(tmp_path / "run.bag").header["scene"]


def test_of_several_runs_in_a_bag_the_last_is_read(tmp_path):
    loop = ClosedLoop()
    loop.log_into(tmp_path)
    loop.run(0.2)
    loop.reset()
    loop.run(0.1)
    loop.end_log()
    run = read_run(tmp_path / "run.bag")
    assert run.runs == 2
    assert run.columns["cycle"].tolist() == list(range(100))


def test_an_earlier_bag_is_kept(tmp_path):
    for _ in range(2):
        loop = ClosedLoop()
        loop.log_into(tmp_path)
        loop.run(0.1)
        loop.end_log()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.1.bag", "run.bag"]


def test_a_log_that_cannot_be_written_is_refused_by_name(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match=r"run\.bag"):
        ClosedLoop().log_into(tmp_path / "file")


def test_a_cut_bag_gives_what_is_whole_and_says_where_it_ends(bag_and_log, tmp_path):
    path, log = bag_and_log
    cut = tmp_path / "cut.bag"
    cut.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])
    run = read_run(cut)
    assert 0 < run.columns["cycle"].size < log["cycle"].size
    assert "up to byte" in run.cut


@pytest.mark.parametrize(("compression", "said"), [("lz4", "TraceHeader"), ("none", "'none' is none of a log")])
def test_another_bag_is_no_log(tmp_path, compression, said):
    path = tmp_path / "other.bag"
    rosbag = pytest.importorskip("rosbag")
    with rosbag.Bag(str(path), "w", compression=compression) as bag:
        bag.write("chatter", String("hello"))
    assert not is_run_log(path)
    with pytest.raises(LogError, match=said):
        read_log(path)
