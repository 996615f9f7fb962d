"""estimate.py reads recordings and writes estimates. Bags need Debian's python3-rosbag and are skipped by name without
it.
"""

import csv
import os
import re
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop, Estimator
from robot_control.data.estimate.main import main
from robot_control.data.estimate.samples import Stream, merged
from robot_control.data.estimate.wheels import wheel_angles
from robot_control.installed_files import share_file
from support.recordings.kinematic_drive import IMU, RADIUS, WHEEL_BASE, drive

SCRIPT = Path(__file__).parents[3] / "scripts/estimate.py"
ROBOT = [f"--wheel-radius={RADIUS}", f"--wheel-base={WHEEL_BASE}", f"--imu-position={','.join(map(str, IMU))}"]
CLOSE = 0.02  # m and rad, after some 5 m of exact sensors: the effect of gates, lags and interpolation


@pytest.fixture(scope="module")
def exact():
    return drive()


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Runs estimate.py in an empty folder; returns its report and its exit message, "" after success."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        message = ""
        try:
            main([str(argument) for argument in arguments])
        except SystemExit as error:
            message = str(error)
        return capsys.readouterr().out, message

    return call


@pytest.fixture
def good(run):
    """Runs estimate.py with success; returns its report."""

    def call(*arguments):
        report, message = run(*arguments)
        assert message == ""
        return report

    return call


def write_csv(path, columns, delimiter=","):
    """Writes a CSV; NaN is an empty cell."""
    rows = zip(*[np.asarray(values).tolist() for values in columns.values()], strict=True)
    lines = [delimiter.join("" if cell != cell else repr(cell) for cell in row) for row in rows]  # noqa: PLR0124
    Path(path).write_text("\n".join([delimiter.join(columns), *lines]) + "\n")


def read_csv(path):
    with Path(path).open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def columns_of(some):
    columns = {"time": some.time, "left": some.left, "right": some.right}
    columns |= {f"gyro_{axis}": some.gyro[:, i] for i, axis in enumerate("xyz")}
    return columns | {f"accel_{axis}": some.accel[:, i] for i, axis in enumerate("xyz")}


@pytest.fixture
def columns(exact):
    """A healthy file with everything at 200 Hz."""
    return columns_of(exact.at(np.arange(0, 12, 0.005)))


def assert_at(out, exact, row=-1):
    truth = exact.at([out["time"][row] - out["time"][0]])
    assert out["x"][row] == pytest.approx(truth.x[0], abs=CLOSE)
    assert out["y"][row] == pytest.approx(truth.y[0], abs=CLOSE)
    assert out["yaw"][row] == pytest.approx(truth.yaw[0], abs=CLOSE)
    assert out["valid"][row] == 1


def test_a_csv_becomes_a_csv_a_picture_and_a_report(good, columns, exact, tmp_path):
    write_csv("in.csv", columns)
    report = good("in.csv", *ROBOT, "--csv", "out.csv", "--plot", "out.png")
    out = read_csv("out.csv")
    assert np.array_equal(out["time"], columns["time"].round(9))
    assert_at(out, exact)
    assert (tmp_path / "out.png").stat().st_size > 20000
    for word in ("distance", "end pose", "±", "gyro bias", "slip detection", "rejected", "wheels 200 Hz"):
        assert word in report
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.csv", "out.csv", "out.png"]


def test_the_csv_holds_what_the_class_gives(good, columns):
    write_csv("in.csv", columns)
    good("in.csv", *ROBOT, "--csv", "out.csv")
    out = read_csv("out.csv")
    est = Estimator(wheel_radius=RADIUS, wheel_base=WHEEL_BASE, imu_position=IMU)
    gyro, accel = (np.column_stack([columns[f"{name}_{axis}"] for axis in "xyz"]) for name in ("gyro", "accel"))
    want = est.process(columns["time"].round(9), columns["left"], columns["right"], gyro, accel)
    for name in ("x", "y", "yaw", "distance", "flags", "radius_ratio"):
        assert np.array_equal(out[name], want[name]), name
    assert np.array_equal(out["x_yaw_covariance"], want["pose_covariance"][:, 0, 5])
    assert np.array_equal(out["rejected_gyro"], want["rejected"][:, 2])


@pytest.mark.parametrize("delimiter", [";", "\t"])
def test_other_delimiters_units_and_names_are_understood(good, columns, exact, delimiter):
    other = {
        "stamp": np.round(1.7e12 + columns["time"] * 1e3).astype(np.int64),
        "L": np.round(columns["left"] / (2 * np.pi) * 4096),
        "R": np.round(columns["right"] / (2 * np.pi) * 4096),
        "wz": np.degrees(columns["gyro_z"]),
        **{f"a{axis}": columns[f"accel_{axis}"] / 9.80665 for axis in "xyz"},
    }
    write_csv("in.csv", other, delimiter)
    names = "time=stamp,left=L,right=R,gyro_z=wz,accel_x=ax,accel_y=ay,accel_z=az"
    units = ["--counts-per-turn=4096", "--time-unit=ms", "--gyro-unit=deg/s", "--accel-unit=g"]
    good("in.csv", *ROBOT, "--columns", names, *units, "--csv", "out.csv")
    out = read_csv("out.csv")
    assert out["time"][0] == 1.7e9
    assert_at(out, exact)


def test_sensors_of_different_rates_share_a_file(good, exact):
    wheels, imu = np.arange(0, 12, 0.02), np.arange(0.003, 12, 0.005)
    at = np.unique(np.concatenate([wheels, imu]).round(6))
    columns = columns_of(exact.at(at))
    for name, values in columns.items():
        if name != "time":
            values[~np.isin(at, (wheels if name in ("left", "right") else imu).round(6))] = np.nan
    write_csv("in.csv", columns)
    report = good("in.csv", *ROBOT, "--csv", "out.csv")
    assert "wheels 50 Hz, gyro 200 Hz, accelerometer 200 Hz" in report
    assert_at(read_csv("out.csv"), exact)


def test_without_imu_columns_the_wheels_do(good, columns, exact):
    write_csv("in.csv", {name: columns[name] for name in ("time", "left", "right")})
    good("in.csv", *ROBOT, "--csv", "out.csv")
    assert_at(read_csv("out.csv"), exact)


def test_a_coarse_encoder_is_found_out_and_is_no_slip(good, exact):
    some = exact.at(np.arange(0, 12, 0.005))
    columns = columns_of(some)
    for side in ("left", "right"):
        columns[side] = np.floor(columns[side] / (2 * np.pi) * 360)
    write_csv("in.csv", columns)
    report = good("in.csv", *ROBOT, "--counts-per-turn=360", "--csv", "out.csv")
    assert "steps of 1/360 turn" in report
    assert_at(read_csv("out.csv"), exact)


def test_neither_a_fine_encoder_nor_a_steady_speed_is_taken_for_a_coarse_one(good, columns):
    write_csv("in.csv", columns)
    assert "steps of" not in good("in.csv", *ROBOT)
    columns["left"] = columns["right"] = columns["time"] * 4.0
    write_csv("in.csv", columns)
    assert "steps of" not in good("in.csv", *ROBOT)


def test_what_was_learned_becomes_the_calibration_of_the_next_run(good, columns):
    write_csv("in.csv", columns)
    good("in.csv", *ROBOT, "--calibration", "learned.yaml", "--csv", "out.csv")
    params = {"state_estimator": {"calibration_file": str(Path("learned.yaml").absolute())}}
    est = Estimator(params, wheel_radius=RADIUS, wheel_base=WHEEL_BASE)
    again = est.process([0.0], [0.0], [0.0])
    assert again["radius_ratio"][0] == pytest.approx(read_csv("out.csv")["radius_ratio"][-1], abs=1e-12)


def test_rate_thins_what_is_written_and_keeps_the_last_row(good, columns):
    write_csv("in.csv", columns)
    good("in.csv", *ROBOT, "--csv", "all.csv")
    good("in.csv", *ROBOT, "--csv", "thin.csv", "--rate", 10)
    everything, thin = read_csv("all.csv"), read_csv("thin.csv")
    assert thin["time"] == pytest.approx([*np.arange(0, 12, 0.1), 11.995])
    rows = np.searchsorted(everything["time"], thin["time"])
    assert np.array_equal(thin["x"], everything["x"][rows])


def test_a_bag_of_the_node_is_estimated_again_bit_for_bit(good):
    loop = ClosedLoop(seed=2)
    loop.log_into(".")
    log = loop.run(4.0, lambda t: (0.4, 0.3 if t > 1 else 0.0))
    loop.end_log()
    good("run.bag", "--csv", "out.csv")
    out = read_csv("out.csv")
    for name in ("x", "y", "yaw", "flags", "distance", "x_variance", "yaw_variance"):
        assert np.array_equal(out[name], log[f"estimate_{name}"]), name


def test_of_several_runs_in_a_log_the_last_one_counts(good):
    loop = ClosedLoop()
    loop.log_into(".")
    loop.run(1.0, (0.0, 0.0))
    loop.reset()
    loop.run(2.0, (0.4, 0.3))
    loop.end_log()
    report = good("run.bag")
    assert "2 runs in the file; this is the last one" in report
    assert "2000 rows" in report


def test_a_log_of_another_robot_is_refused_with_its_joints(run):
    Path("other.urdf").write_text(
        Path(share_file("urdf/diffbot.urdf")).read_text().replace("left_wheel_joint", "port_joint")
    )
    loop = ClosedLoop(urdf="other.urdf")
    loop.log_into(".")
    loop.run(0.1)
    loop.end_log()
    _, message = run("run.bag")
    assert "no column left_wheel_joint_position; it has port_joint_position, right_wheel_joint_position" in message


def test_the_log_of_a_robot_on_legs_is_refused_with_and_without_its_description(run):
    urdf = share_file("urdf/quadbot.urdf")
    loop = ClosedLoop(urdf=urdf)
    loop.log_into(".")
    loop.run(0.1)
    loop.end_log()
    for arguments in ([], ["--urdf", urdf]):
        _, message = run("run.bag", *arguments)
        assert message == "estimate.py: this robot is a quadruped: estimate.py works on wheels only"


def spoil(line, old, new):
    """The file with one line changed; line 1 is the header."""
    lines = Path("in.csv").read_text().splitlines(keepends=True)
    assert old in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new, 1)
    Path("in.csv").write_text("".join(lines))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ((1, "left", "links"), "in.csv: no column left; its header is time, links, right"),
        ((1, "time", "left"), "two columns are named left"),
        ((1, "gyro_z", "spin"), "there is gyro_x, but no gyro_z"),
        ((1, "accel_y", "ay"), "there is accel_x, but no accel_y"),
        ((4, "0.01,", "soon,"), "in.csv, line 4: the time is 'soon'; every row needs a finite number"),
        ((4, "0.01,", ","), "line 4: the time is ''"),
        ((4, "0.01,", "nan,"), "line 4: the time is 'nan'"),
        ((4, "0.01,", "0.005,"), "line 4: time is 0.005, not after the row before"),
        ((4, "0.01,", "0.001,"), "line 4: time is 0.001, not after the row before"),
        ((4, "0.01,", "1e30,"), "line 4: the time is 1e30, beyond 146 years; check --time-unit"),
        (
            (4, "0.01,0.0", "0.01,fast"),
            "line 4, column left: 'fast' is not a number; leave the cell of an absent sample",
        ),
        ((4, "0.01,", "0.01,1,"), "line 4: 10 cells, the header has 9"),
        ((4, "0.01,", "0.01 "), "line 4: 8 cells, the header has 9"),
        ((4, "0.01,", '"0.01,'), "line 4: a quotation mark is not closed in this line"),
        ((2300, ",", ',"'), "line 2300: a quotation mark is not closed in this line"),
    ],
)
def test_a_csv_that_is_wrong_is_refused_by_its_line_and_nothing_is_written(run, columns, tmp_path, change, said):
    write_csv("in.csv", columns)
    spoil(*change)
    report, message = run("in.csv", *ROBOT, "--csv", "out.csv", "--plot", "out.png")
    assert said in message
    assert message.startswith("estimate.py: ")
    assert "\n" not in message
    assert report == ""
    assert [path.name for path in tmp_path.iterdir()] == ["in.csv"]


def test_a_last_line_that_was_cut_short_is_left_out_and_reported(good, columns):
    write_csv("in.csv", columns)
    text = Path("in.csv").read_text()
    Path("in.csv").write_text(text[:-60])
    report = good("in.csv", *ROBOT)
    assert "line 2401, the last one, is incomplete and ignored" in report


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1e3, 1e6])
def test_times_of_another_unit_are_refused(run, columns, unit):
    write_csv("in.csv", columns | {"time": columns["time"] * unit})
    _, message = run("in.csv", *ROBOT)
    assert "--time-unit" in message


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_wheel_without_any_angle_is_refused(run, columns, side):
    write_csv("in.csv", columns | {side: np.full_like(columns[side], np.nan)})
    _, message = run("in.csv", *ROBOT)
    assert f"the {side} wheel has no angle in this recording" in message


def test_a_gap_is_reported(good, columns):
    write_csv("in.csv", {name: np.delete(values, slice(1000, 1300)) for name, values in columns.items()})
    report = good("in.csv", *ROBOT)
    assert "no sample for 1.5 s after 4.995 s" in report


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nowhere.csv", *ROBOT], "nowhere.csv: file not found (/"),
        (["empty.csv", *ROBOT], "empty; the first line must name the columns"),
        (["head.csv", *ROBOT], "no rows below the header"),
        (["in.csv", "--wheel-radius=0.1"], "wheel_radius without wheel_base"),
        (["in.csv", "--urdf=no.urdf"], "no.urdf"),
        (["in.csv", *ROBOT, "--columns=speed=v"], "--columns names speed; there are time, left, right, gyro_x"),
        (["in.csv", *ROBOT, "--columns=left=L"], "no column L; its header is time"),
        (["in.csv", *ROBOT, "--imu=/imu"], "--imu is for a bag; in.csv is read as a CSV"),
        (["in.bag", *ROBOT, "--time-unit=ms"], "--time-unit is for a CSV; in.bag is read as a bag"),
        (["in.csv", *ROBOT, "--csv=in.csv"], "in.csv is an input of this program"),
        (["in.csv", *ROBOT, "--csv=no/out.csv"], "folder no not found"),
        (["in.csv", *ROBOT, "--csv=a.png", "--plot=a.png"], "is the name of two outputs"),
        (["in.csv", *ROBOT, "--plot=a.docx"], "docx"),
        (["in.mcap", *ROBOT], "is a ROS 2 bag"),
        (
            ["in.csv", *ROBOT, "--imu-orientation=1,2"],
            "imu_orientation is [1.0, 2.0]; it must be 3 or 4 finite numbers",
        ),
    ],
)
def test_what_is_asked_for_wrongly_is_refused_in_one_message(run, columns, tmp_path, arguments, said):
    write_csv("in.csv", columns)
    Path("empty.csv").touch()
    Path("head.csv").write_text("time,left,right\n")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    _, message = run(*arguments)
    assert said in message
    assert "\n" not in message
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_failure_keeps_the_earlier_output(run, columns):
    write_csv("in.csv", columns)
    Path("out.csv").write_text("mine")
    _, message = run("in.csv", *ROBOT, "--csv", "out.csv", "--plot", "out.docx")
    assert message
    assert Path("out.csv").read_text() == "mine"


def test_the_script_ends_with_1_and_a_message_without_traceback(tmp_path):
    done = subprocess.run(
        [sys.executable, "-P", str(SCRIPT), "nowhere.csv", *ROBOT],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path,
        env=os.environ,
        timeout=60,
    )
    assert done.returncode == 1
    assert done.stderr.startswith("estimate.py: ")
    assert "Traceback" not in done.stderr


def test_streams_are_merged_into_one_row_per_time():
    one = Stream(np.array([10, 30]), np.array([[1.0], [3.0]]))
    two = Stream(np.array([10, 20]), np.array([[5.0], [6.0]]))
    time, (first, second) = merged([one, two])
    assert time.tolist() == [10, 20, 30]
    assert first[:, 0].tolist() == pytest.approx([1.0, np.nan, 3.0], nan_ok=True)
    assert second[:, 0].tolist() == pytest.approx([5.0, 6.0, np.nan], nan_ok=True)


def test_messages_are_sorted_and_one_of_each_time_counts():
    stream, back, same = Stream(np.array([10, 30, 20, 30]), np.arange(4.0)[:, None]).ordered()
    assert stream.time_ns.tolist() == [10, 20, 30]
    assert stream.values[:, 0].tolist() == [0.0, 2.0, 1.0]
    assert (back, same) == (1, 1)


@pytest.mark.parametrize("source", ["pose", "twist"])
def test_wheel_angles_come_out_of_the_odometry_that_they_made(exact, source):
    some = exact.at(np.arange(0, 12, 0.01))
    values = np.column_stack([some.x, some.y, some.yaw, some.linear, some.angular])
    robot = Estimator(wheel_radius=RADIUS, wheel_base=WHEEL_BASE).robot
    angles, used = wheel_angles(Stream((some.time * 1e9).astype(np.int64), values), robot, source)
    assert used == source
    # Between two samples the speeds are taken as constant: second order in 10 ms.
    assert np.max(np.abs(angles[:, 0] - some.left)) < 2e-3
    assert np.max(np.abs(angles[:, 1] - some.right)) < 2e-3


def test_a_pose_that_was_never_filled_in_is_not_used(exact):
    some = exact.at(np.arange(0, 12, 0.01))
    still = np.zeros_like(some.x)
    values = np.column_stack([still, still, still, some.linear, some.angular])
    robot = Estimator(wheel_radius=RADIUS, wheel_base=WHEEL_BASE).robot
    _, used = wheel_angles(Stream((some.time * 1e9).astype(np.int64), values), robot, None)
    assert used == "twist"


@pytest.fixture
def rosbag():
    return pytest.importorskip("rosbag", reason="bags need Debian's python3-rosbag")


BASE = 1_700_000_000.0  # s: stamps of a bag


def stamp_of(seconds):
    from rospy import Time

    ns = round((BASE + round(seconds, 6)) * 1e6) * 1000
    return Time(ns // 10**9, ns % 10**9)


def joint_state(stamp, **positions):
    from sensor_msgs.msg import JointState

    message = JointState(name=list(positions), position=list(positions.values()))
    message.header.stamp = stamp
    return message


def imu_sample(stamp, gyro, accel):
    from sensor_msgs.msg import Imu

    message = Imu()
    message.header.stamp = stamp
    message.header.frame_id = "imu_link"
    rate, force = message.angular_velocity, message.linear_acceleration
    rate.x, rate.y, rate.z = gyro
    force.x, force.y, force.z = accel
    return message


def odometry(stamp, some, i):
    from nav_msgs.msg import Odometry

    message = Odometry()
    message.header.stamp = stamp
    pose, twist = message.pose.pose, message.twist.twist
    pose.position.x, pose.position.y = some.x[i], some.y[i]
    pose.orientation.z, pose.orientation.w = np.sin(some.yaw[i] / 2), np.cos(some.yaw[i] / 2)
    twist.linear.x, twist.angular.z = some.linear[i], some.angular[i]
    return message


def messages_of(exact, wheels="joint_states", imu="imu/data_raw", rate=50):
    """(topic, message, stamp) of all wheels, then all of the IMU."""
    some = exact.at(np.arange(0, 12, 1 / rate))
    for i, t in enumerate(some.time):
        stamp = stamp_of(t)
        if wheels == "joint_states":
            state = joint_state(stamp, left_wheel_joint=some.left[i], right_wheel_joint=some.right[i], arm=0.0)
            yield "/joint_states", state, stamp
        elif wheels is not None:
            yield f"/{wheels}", odometry(stamp, some, i), stamp
    if imu is not None:
        some = exact.at(np.arange(0.0013, 12, 0.005))
        for i, t in enumerate(some.time):
            yield f"/{imu}", imu_sample(stamp_of(t), some.gyro[i], some.accel[i]), stamp_of(t)


def write_bag(rosbag, messages, path="in.bag", **options):
    with rosbag.Bag(path, "w", **options) as bag:
        for topic, message, stamp in messages:
            bag.write(topic, message, stamp)


@pytest.fixture(scope="module")
def usual(exact, tmp_path_factory):
    """A bag of joint states and IMU; to write it takes longer than most of its tests."""
    rosbag = pytest.importorskip("rosbag", reason="bags need Debian's python3-rosbag")
    path = tmp_path_factory.mktemp("usual") / "in.bag"
    write_bag(rosbag, messages_of(exact), path)
    return path


@pytest.fixture
def in_bag(usual, tmp_path):
    shutil.copy(usual, tmp_path)


def test_a_bag_of_joint_states_and_imu_becomes_a_path(in_bag, good, exact):
    report = good("in.bag", *ROBOT, "--csv", "out.csv")
    for found in ("wheels: /joint_states", "IMU: /imu/data_raw", "wheels 50 Hz, gyro 200 Hz"):
        assert found in report
    out = read_csv("out.csv")
    assert out["time"].size == 600 + 2400
    assert_at(out, exact)


def test_a_bag_comes_out_with_odometry_and_its_transform(in_bag, rosbag, good):
    good("in.bag", *ROBOT, "--csv", "out.csv", "--bag", "out.bag")
    rows = read_csv("out.csv")
    with rosbag.Bag("out.bag") as bag:
        odom = [message for _, message, _ in bag.read_messages("/odom")]
        transforms = [message.transforms[0] for _, message, _ in bag.read_messages("/tf")]
    assert len(odom) == len(transforms) == pytest.approx(12 * 50, abs=2)
    last, placed = odom[-1], transforms[-1]
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "base_link")
    assert last.header.stamp.to_nsec() == 1_700_000_011_996_300_000
    assert last.pose.pose.position.x == rows["x"][-1] == placed.transform.translation.x
    assert last.pose.covariance[0] == rows["x_variance"][-1]
    assert last.pose.covariance[35] == rows["yaw_variance"][-1]
    assert last.twist.twist.angular.z == rows["angular_z"][-1]
    assert placed.header.stamp == last.header.stamp
    assert placed.child_frame_id == "base_link"


@pytest.mark.parametrize("source", ["pose", "twist"])
def test_wheel_odometry_is_read_where_there_are_no_joint_states(rosbag, good, exact, source):
    write_bag(rosbag, messages_of(exact, wheels="wheel_odom"))
    report = good("in.bag", *ROBOT, "--odometry", source, "--csv", "out.csv")
    assert f"wheel angles from the {source} of /wheel_odom" in report
    assert_at(read_csv("out.csv"), exact)


def test_messages_out_of_order_are_sorted_and_reported(rosbag, good, exact):
    messages = list(messages_of(exact))
    write_bag(rosbag, messages)
    good("in.bag", *ROBOT, "--csv", "even.csv")
    recorded = [stamp for _, _, stamp in messages]
    messages[100], messages[101] = messages[101], messages[100]
    write_bag(rosbag, [(topic, message, at) for (topic, message, _), at in zip(messages, recorded, strict=True)])
    report = good("in.bag", *ROBOT, "--csv", "out.csv")
    assert "time ran back 1 times on /joint_states; its messages were sorted" in report
    assert Path("out.csv").read_text() == Path("even.csv").read_text()


def test_a_message_per_wheel_is_understood(in_bag, rosbag, good, exact):
    def split():
        for topic, message, stamp in messages_of(exact):
            if topic == "/joint_states":
                for name, position in zip(message.name[:2], message.position[:2], strict=True):
                    yield topic, joint_state(stamp, **{name: position}), stamp
            else:
                yield topic, message, stamp

    good("in.bag", *ROBOT, "--csv", "even.csv")
    write_bag(rosbag, split())
    good("in.bag", *ROBOT, "--csv", "out.csv")
    assert Path("out.csv").read_text() == Path("even.csv").read_text()


def test_an_imu_that_says_it_has_no_accelerometer_has_none(rosbag, good, exact):
    def deaf():
        for topic, message, stamp in messages_of(exact):
            if topic == "/imu/data_raw":
                message.linear_acceleration_covariance[0] = -1  # REP 145
            yield topic, message, stamp

    write_bag(rosbag, deaf())
    report = good("in.bag", *ROBOT)
    assert "gyro 200 Hz" in report
    assert "accelerometer" not in report


def test_a_bag_without_imu_is_estimated_by_its_wheels_and_says_so(rosbag, good, exact):
    write_bag(rosbag, messages_of(exact, imu=None))
    report = good("in.bag", *ROBOT, "--csv", "out.csv")
    assert "no topic of sensor_msgs/Imu; only the wheels are used" in report
    assert_at(read_csv("out.csv"), exact)


def test_the_same_imu_with_an_orientation_is_no_second_imu(rosbag, good, exact):
    write_bag(rosbag, [*messages_of(exact), *messages_of(exact, wheels=None, imu="imu/data")])
    report = good("in.bag", *ROBOT)
    assert "IMU: /imu/data_raw" in report


def test_what_could_be_meant_twice_is_asked_for_by_name(rosbag, run, good, exact):
    write_bag(rosbag, [*messages_of(exact, imu="front/imu"), *messages_of(exact, wheels=None, imu="rear/imu")])
    _, message = run("in.bag", *ROBOT)
    assert "in.bag has several IMU topics: set --imu to one of /front/imu, /rear/imu, or none" in message
    good("in.bag", *ROBOT, "--imu", "rear/imu")
    write_bag(rosbag, [*messages_of(exact, wheels="odom"), *messages_of(exact, wheels="wheel_odom", imu=None)])
    _, message = run("in.bag", *ROBOT)
    assert "several topics of nav_msgs/Odometry: set --wheels to one of /odom, /wheel_odom" in message


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ["--wheels=/encoders"],
            "/encoders is not in it; topics of sensor_msgs/JointState or nav_msgs/Odometry: /joint",
        ),
        (["--wheels=/imu/data_raw"], "/imu/data_raw is of sensor_msgs/Imu"),
        (
            ["--imu=/joint_states"],
            "/joint_states is of sensor_msgs/JointState; topics of sensor_msgs/Imu: /imu/data_raw",
        ),
        (
            ["--joints=left=port,right=starboard"],
            "positions of the wheels port, starboard. Joints with a position: /joint",
        ),
        (["--joints=left=port"], "--joints names one joint of each side"),
    ],
)
def test_topics_that_are_not_there_are_refused_with_those_that_are(in_bag, run, arguments, said):
    _, message = run("in.bag", *ROBOT, *arguments, "--csv", "out.csv")
    assert said in message
    assert "\n" not in message
    assert not Path("out.csv").exists()


def test_joints_of_other_names_are_given_by_name(rosbag, run, good, exact):
    def renamed():
        for topic, message, stamp in messages_of(exact):
            if topic == "/joint_states":
                message.name = ["port", "starboard", "arm"]
            yield topic, message, stamp

    write_bag(rosbag, renamed())
    _, message = run("in.bag", *ROBOT)
    assert "Name two of them: --joints left=…,right=…" in message
    good("in.bag", *ROBOT, "--joints=left=port,right=starboard", "--csv", "out.csv")
    assert_at(read_csv("out.csv"), exact)


def test_a_bag_whose_recorder_was_killed_is_read_up_to_there_and_says_so(rosbag, run, good, exact):
    write_bag(rosbag, messages_of(exact), chunk_threshold=50_000)
    whole = good("in.bag", *ROBOT, "--csv", "whole.csv")
    content = Path("in.bag").read_bytes()
    Path("in.bag").write_bytes(content[: len(content) * 3 // 4])
    report = good("in.bag", *ROBOT, "--csv", "cut.csv")
    assert "warning         the bag has no end" in report
    assert "warning" not in whole
    lengths = [len(Path(name).read_text().splitlines()) for name in ("cut.csv", "whole.csv")]
    assert 100 < lengths[0] < 0.9 * lengths[1]
    Path("in.bag").write_bytes(content[:4200])
    assert "in.bag contains no readable message: the bag has no end" in run("in.bag", *ROBOT)[1]


@pytest.mark.parametrize("name", ["in.csv", "in.bag"])
def test_a_recording_that_is_no_regular_file_is_refused_at_once(run, name):
    for target, said in (("/dev/zero", "is a device"), ("fifo", "is a FIFO"), (".", "is a folder")):
        Path(name).unlink(missing_ok=True)
        if not Path("fifo").exists():
            os.mkfifo("fifo")
        Path(name).symlink_to(target)
        _, message = run(name, *ROBOT)
        assert re.search(rf"{name}: {said}", message)
        _, message = run("in2.csv", "--params", name)
        assert said in message


def test_what_is_no_csv_is_refused_in_a_short_message(run):
    contents = [b"\0" * 10**6, b"x" * 10**6, b"time,left,right\n" + b"1" * 10**6, b'time,"left,' + b"y\n" * 10**5]
    contents += [b",".join(b"c%d" % i for i in range(9000)), bytes(range(256)) * 20]
    for content in contents:
        Path("in.csv").write_bytes(content)
        _, message = run("in.csv", *ROBOT)
        assert message.startswith("estimate.py: in.csv")
        assert len(message) < 800
        assert "\0" not in message


@pytest.mark.parametrize("option", ["--csv", "--bag", "--plot", "--calibration"])
def test_outputs_keep_what_they_are_written_through(good, columns, tmp_path, option):
    write_csv("in.csv", columns)
    suffix = {"--csv": "csv", "--bag": "bag", "--plot": "png", "--calibration": "yaml"}[option]
    Path(f"link.{suffix}").symlink_to(f"target.{suffix}")
    good("in.csv", *ROBOT, option, f"link.{suffix}")
    assert Path(f"link.{suffix}").is_symlink()
    assert Path(f"target.{suffix}").stat().st_size > 0
    null = Path(f"null.{suffix}")
    try:
        os.mknod(null, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
        null.open("wb").close()
    except PermissionError:
        pytest.skip("devices are not granted")
    good("in.csv", *ROBOT, option, null)
    assert null.is_char_device()


def mutated(data, random):
    """The data, damaged in one of several ways."""
    data = bytearray(data)
    kind = random.choice(4, p=(0.5, 0.1, 0.1, 0.3))  # a wrong length leaves no index, and little to read
    if kind == 0:
        for at in random.integers(len(data), size=random.integers(1, 40)):
            data[at] = random.integers(256)
    elif kind == 1:
        del data[random.integers(len(data)) :]
    elif kind == 2:
        first = random.integers(len(data))
        del data[first : first + random.integers(1, 200)]
    else:
        first, second = random.integers(len(data), size=2)
        data[first : first + 64] = data[second : second + 64]
    return bytes(data)


@pytest.mark.parametrize(
    "compression", ["none", *(pytest.param(one, marks=pytest.mark.nightly) for one in ("bz2", "lz4"))]
)
def test_a_damaged_bag_is_estimated_or_refused_in_one_message(rosbag, run, exact, compression):
    with rosbag.Bag("sound.bag", "w", compression=compression, chunk_threshold=20000) as bag:
        for topic, message, stamp in messages_of(exact, rate=10):
            if stamp.to_sec() < BASE + 3:
                bag.write(topic, message, stamp)
    sound = Path("sound.bag").read_bytes()
    for seed in range(10):
        Path("in.bag").write_bytes(mutated(sound, np.random.default_rng(seed)))
        try:
            _, message = run("in.bag", *ROBOT)  # exits with a message, or ends well
        except Exception as error:
            raise AssertionError(f"seed {seed}, {compression}: {error!r}") from error
        assert message == "" or message.startswith("estimate.py: "), seed
        assert len(message) < 1000, seed


def test_a_robot_of_unknown_size_is_never_taken_for_the_installed_one(run, good, columns):
    write_csv("in.csv", columns)
    Path("mine.yaml").write_text("state_estimator: {gyro_noise: 1.0e-3}\n")
    for given in ([], ["--params", "mine.yaml"]):
        _, message = run("in.csv", *given)
        assert "the robot is unknown" in message
        assert "--wheel-radius and --wheel-base, or --urdf FILE" in message
    Path("mine.yaml").write_text(f"robot: {{wheel_base: {WHEEL_BASE}}}\n")
    good("in.csv", "--params", "mine.yaml")


@pytest.mark.parametrize("form", [["--imu-orientation=-1.5708,0,0"], ["--imu-orientation", "-1.5708,0,0"]])
def test_an_imu_orientation_may_begin_with_a_minus(good, columns, form):
    write_csv("in.csv", columns)
    report = good("in.csv", *ROBOT, *form)
    assert "warning         gravity is 90° away" in report  # the given mounting is wrong
    assert "--imu-orientation=0,0,0 fits" in report


def test_late_stamps_of_the_imu_are_found_said_and_taken_out(good, exact):
    wheels, imu = np.arange(0, 12, 0.02), np.arange(0.003, 12, 0.005)
    late = columns_of(exact.at(imu))
    late = {name: values for name, values in late.items() if name not in ("left", "right")}
    of_wheels = {name: values for name, values in columns_of(exact.at(wheels)).items() if name in ("left", "right")}
    streams = [
        Stream(np.round((time + delay) * 1e9).astype(np.int64), np.column_stack(list(table.values())))
        for time, delay, table in (
            (wheels, 0.0, of_wheels),
            (imu, 0.08, {k: v for k, v in late.items() if k != "time"}),
        )
    ]
    time_ns, tables = merged(streams)
    names = [name for name in late if name != "time"]
    rows = dict(zip([*of_wheels, *names], np.column_stack(tables).T, strict=True))
    write_csv("in.csv", {"time": time_ns / 1e9, **rows})
    report = good("in.csv", *ROBOT, "--csv", "out.csv")
    assert "the IMU's stamps are +0.080 s after the wheels'" in report
    assert_at(read_csv("out.csv"), exact)
    for given in (["--imu-delay", "0"], ["--imu-delay", "-0.01"]):
        assert "taken out" not in good("in.csv", *ROBOT, *given)


def test_a_jump_of_the_clock_costs_no_time_of_its_own_and_is_named_in_its_row(good, columns, exact):
    row = 1000
    for jump in (86400.0, 6 * 365 * 86400.0):
        columns["time"] = np.arange(0, 12, 0.005) + np.where(np.arange(2400) >= row, jump, 0)
        write_csv("in.csv", columns)
        report = good("in.csv", *ROBOT, "--csv", "out.csv", "--plot", "out.png", "--rate", 50)
        assert (
            f"the time jumps by {jump + 0.005:.3f} s to {jump + 5:.3f} s in row {row + 1}: the clock was set" in report
        )
        assert re.search(r"^recording +11\.995 s, 2400 rows; wheels 200 Hz", report, re.MULTILINE)
        assert "not to be trusted" not in report
        out = read_csv("out.csv")
        assert out["time"][-1] == pytest.approx(jump + 11.995), "the stamps of the recording"
        out["time"][-1] -= jump
        assert_at(out, exact)


def test_encoders_that_begin_again_are_no_travel_and_are_named(good, columns, exact):
    begun = columns["time"] >= 6
    for side in ("left", "right"):
        columns[side][begun] -= columns[side][begun][0]
    write_csv("in.csv", columns)
    report = good("in.csv", *ROBOT, "--csv", "out.csv")
    assert re.search(r"^warning +an encoder restarted after 6\.020 s: the travel", report, re.MULTILINE)
    out, truth = read_csv("out.csv"), exact.at([11.995])
    assert np.hypot(out["x"][-1] - truth.x[0], out["y"][-1] - truth.y[0]) < 0.04, "five readings at 5 ms"
