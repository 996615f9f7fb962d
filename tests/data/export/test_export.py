"""export.py writes one log in other formats."""

import csv
import math

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.data.export.main import main
from robot_control.data.export.topics import root_link
from robot_control.data.run_log import odom_frame, read_log, read_run
from support.pypi_package import imported

SECONDS = 2.0


@pytest.fixture(scope="module")
def run_bag(tmp_path_factory):
    """A drive whose request changes once."""
    folder = tmp_path_factory.mktemp("log")
    loop = ClosedLoop(seed=5)
    loop.log_into(folder)
    loop.command(0.0, 0.0)
    loop.run(SECONDS / 2)
    loop.command(0.4, 0.3)
    loop.run(SECONDS / 2)
    loop.end_log()
    return folder / "run.bag"


def table_of(path):
    """Names and rows of a CSV, as texts."""
    with path.open(newline="") as file:
        names, *rows = csv.reader(file)
    return names, rows


def test_a_csv_reads_as_the_bag_does(run_bag, tmp_path):
    main([str(run_bag), "--csv", str(tmp_path / "run.csv")])
    bag = read_log(run_bag)
    names, rows = table_of(tmp_path / "run.csv")
    assert names == list(bag)
    for name, texts in zip(names, zip(*rows, strict=True), strict=True):
        numbers = [float(text) if text else math.nan for text in texts]
        np.testing.assert_array_equal(numbers, bag[name], err_msg=name)
    assert rows[5][names.index("cycle")] == "5", "an integer has no decimal point"
    assert rows[5][names.index("speed_limit")] == "", "there is none"


def test_a_csv_holds_all_runs_one_after_the_other(tmp_path):
    loop = ClosedLoop()
    loop.log_into(tmp_path)
    loop.run(0.2)
    loop.reset()
    loop.run(17.0)  # more rows than are written at once
    loop.end_log()
    main([str(tmp_path / "run.bag"), "--csv", str(tmp_path / "run.csv")])
    names, rows = table_of(tmp_path / "run.csv")
    expected = [("0", str(k)) for k in range(200)] + [("1", str(k)) for k in range(17000)]
    assert [(row[names.index("run")], row[names.index("cycle")]) for row in rows] == expected


def test_without_an_output_nothing_is_done_silently(run_bag, capsys):
    with pytest.raises(SystemExit) as end:
        main([str(run_bag)])
    assert end.value.code == 2
    assert "--csv, --mcap or --topics" in capsys.readouterr().err


def test_a_bag_that_was_cut_off_is_exported_up_to_there_and_that_is_said(run_bag, tmp_path, capsys):
    cut = tmp_path / "cut.bag"
    cut.write_bytes(run_bag.read_bytes()[: run_bag.stat().st_size * 2 // 3])
    main([str(cut), "--csv", str(tmp_path / "run.csv")])
    assert "the bag has no end" in capsys.readouterr().err


def test_topics_are_those_of_a_robot_at_its_rates(run_bag, tmp_path):
    rosbag = pytest.importorskip("rosbag")
    main([str(run_bag), "--topics", str(tmp_path / "drive.bag")])
    log = read_run(run_bag)
    with rosbag.Bag(str(tmp_path / "drive.bag")) as bag:
        messages = {}
        for topic, message, stamp in bag.read_messages():
            messages.setdefault(topic, []).append((message, stamp.to_sec()))
    assert sorted(messages) == ["cmd_vel", "joint_states", "odom", "tf"]
    assert len(messages["odom"]) == len(messages["tf"]) == SECONDS * 50
    assert len(messages["joint_states"]) == SECONDS * 100
    requested = [(message.linear.x, message.angular.z) for message, _ in messages["cmd_vel"]]
    assert requested[0] == (0.0, 0.0)
    assert requested[-1] == (0.4, 0.3)
    odometry, time = messages["odom"][-1]
    row = int(np.argmin(np.abs(log.ros_time - time)))
    assert odometry.pose.pose.position.x == log.columns["estimate_x"][row]
    assert odometry.pose.covariance[35] == log.columns["estimate_yaw_variance"][row]
    assert odometry.child_frame_id == "base_link"
    assert messages["tf"][-1][0].transforms[0].header.frame_id == "odom"


def test_an_mcap_holds_every_message_as_it_is(run_bag, tmp_path):
    reader = imported("mcap.reader", "export", "mcap")
    rosbag = pytest.importorskip("rosbag")
    main([str(run_bag), "--mcap", str(tmp_path / "run.mcap")])
    with rosbag.Bag(str(run_bag)) as bag:
        expected = [(topic, message[1]) for topic, message, _ in bag.read_messages(raw=True)]
    with (tmp_path / "run.mcap").open("rb") as file:
        found = [(channel.topic, message.data) for _, channel, message in reader.make_reader(file).iter_messages()]
    assert sorted(each for each in found if each[0] not in PUBLISHED) == sorted(expected)


PUBLISHED = {"/odom": 101, "/tf": 101, "/joint_states": 201, "/cmd_vel": 2, "/robot_description": 1}
"""Messages that the robot publishes in SECONDS, at most"""


def test_an_mcap_shows_the_robot_in_the_reader_of_foxglove(run_bag, tmp_path):
    reader = imported("mcap.reader", "export", "mcap")
    decoder = imported("mcap_ros1.decoder", "export", "mcap_ros1")
    main([str(run_bag), "--mcap", str(tmp_path / "run.mcap")])
    messages = {topic: [] for topic in PUBLISHED}
    with (tmp_path / "run.mcap").open("rb") as file:
        made = reader.make_reader(file, decoder_factories=[decoder.DecoderFactory()])
        for _, channel, _, message in made.iter_decoded_messages(topics=list(PUBLISHED)):
            messages[channel.topic].append(message)
    for topic, most in PUBLISHED.items():
        assert 0.98 * most - 1 <= len(messages[topic]) <= most, topic
    log = read_log(run_bag)
    assert messages["/odom"][-1].pose.pose.position.x == pytest.approx(log["estimate_x"][-1], abs=0.02)
    assert messages["/tf"][-1].transforms[0].child_frame_id == messages["/odom"][-1].child_frame_id
    assert set(messages["/joint_states"][-1].name) == {"left_wheel_joint", "right_wheel_joint"}
    assert messages["/robot_description"][0].data.startswith("<?xml")


def test_what_is_no_log_is_refused_and_nothing_is_written(tmp_path):
    (tmp_path / "text").write_text("no bag")
    with pytest.raises(SystemExit, match="is not a ROS bag"):
        main([str(tmp_path / "text"), "--csv", str(tmp_path / "out.csv")])
    assert not (tmp_path / "out.csv").exists()


def test_frames_are_those_of_the_robot():
    urdf = '<robot><link name="a"/><link name="b"/><joint><parent link="b"/><child link="a"/></joint></robot>'
    assert root_link(urdf) == "b"
    assert odom_frame("state_estimator: {odom_frame: robot/odom}") == "robot/odom"
