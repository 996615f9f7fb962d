"""Estimator runs the node's law over arrays."""

import threading
import time as clock

import numpy as np
import pytest
from robot_control import ClosedLoop, Estimator, ParameterError, RobotError
from robot_control.installed_files import share_file
from robot_control.loop.estimator import FLAGS, SENSORS

DIFFBOT = share_file("urdf/diffbot.urdf")
GEOMETRY = {"wheel_radius": 0.1, "wheel_base": 0.5, "imu_position": (0.05, 0.02, 0.06)}  # diffbot's
LOGGED = {
    "x": "estimate_x",
    "y": "estimate_y",
    "yaw": "estimate_yaw",
    "flags": "estimate_flags",
    "distance": "estimate_distance",
}


def wander(t):
    """Rests, then drives curves either way, which excites everything that the estimator learns."""
    return (0.0, 0.0) if t < 1 else (0.5, 0.8 * np.sin(t))


def samples_of(log, left=("left_wheel_joint",), right=("right_wheel_joint",)):
    columns = [np.column_stack([log[f"{name}_position"] for name in side]) for side in (left, right)]
    columns = [column[:, 0] if column.shape[1] == 1 else column for column in columns]
    axes = [np.column_stack([log[f"{sensor}_{axis}"] for axis in "xyz"]) for sensor in ("gyro", "accel")]
    return [log["time"], *columns, *axes]


ERRORS = {"mujoco_plant": {"sensor_errors": "data_sheet"}}  # these tests judge absent samples, not what shakes the IMU


@pytest.fixture(scope="module")
def log():
    return ClosedLoop(ERRORS, seed=5).run(8.0, wander)


@pytest.fixture
def samples(log):
    return samples_of(log)


def same(one, other):
    return one.keys() == other.keys() and all(np.array_equal(one[name], other[name]) for name in one)


def part(samples, rows):
    return [None if table is None else table[rows] for table in samples]


def assert_node_and_estimator_agree(out, log):
    for name, column in LOGGED.items():
        assert np.array_equal(out[name], log[column]), name
    assert np.array_equal(out["linear"][:, 0], log["estimate_linear"])
    assert np.array_equal(out["angular"][:, 2], log["estimate_angular"])
    for i, axis in ((0, "x"), (1, "y"), (5, "yaw")):
        assert np.array_equal(out["pose_covariance"][:, i, i], log[f"estimate_{axis}_variance"]), axis
    for i, sensor in enumerate(SENSORS[:4]):
        assert np.array_equal(out["confidence"][:, i], log[f"confidence_{sensor}"]), sensor


def test_gives_the_bits_of_the_node_that_had_the_same_samples(log, samples):
    assert_node_and_estimator_agree(Estimator().process(*samples), log)


@pytest.mark.parametrize("rate", [300, 500])  # 1/300 s is no whole number of nanoseconds
def test_gives_the_bits_of_a_node_of_another_rate(rate):
    params = {"robot": {"rate": rate}}
    log = ClosedLoop(params).run(4.0, wander)
    assert_node_and_estimator_agree(Estimator(params).process(*samples_of(log)), log)


def four_wheels():
    """diffbot's dimensions with an axle at ± 0.2 m."""
    parts = ['<robot name="four"><link name="base_link">', body("box size='0.5 0.4 0.1'", 10), "</link>"]
    for x, y in ((0.2, 0.25), (-0.2, 0.25), (0.2, -0.25), (-0.2, -0.25)):
        name = f"{'front' if x > 0 else 'rear'}_{'left' if y > 0 else 'right'}"
        wheel = body("cylinder radius='0.1' length='0.04'", 1, "<origin rpy='1.5708 0 0'/>")
        parts.append(f'<link name="{name}">{wheel}</link><joint name="{name}_joint" type="continuous">')
        parts.append(f'<origin xyz="{x} {y} 0"/><parent link="base_link"/><child link="{name}"/><axis xyz="0 1 0"/>')
        parts.append('<limit effort="5" velocity="20"/></joint>')
    return "".join([*parts, "</robot>"])


def body(shape, mass, origin=""):
    inertia = " ".join(f'{axis}="{0.01 * mass}"' for axis in ("ixx", "iyy", "izz"))
    return (
        f'<inertial><mass value="{mass}"/><inertia {inertia} ixy="0" ixz="0" iyz="0"/></inertial>'
        f"<collision>{origin}<geometry><{shape}/></geometry></collision>"
    )


def test_gives_the_bits_of_a_node_with_two_wheels_a_side(tmp_path):
    urdf = tmp_path / "four.urdf"
    urdf.write_text(four_wheels())
    loop = ClosedLoop(urdf=urdf)
    wheels = [(wheel["joint"], wheel["side"]) for wheel in loop.robot["wheels"]]
    sides = [[joint for joint, own_side in wheels if own_side == side] for side in ("left", "right")]
    log = loop.run(4.0, wander)
    assert_node_and_estimator_agree(Estimator(urdf=urdf).process(*samples_of(log, *sides)), log)


def test_time_since_1970_gives_the_same_bits(samples):
    zero = Estimator().process(*samples)
    late = Estimator().process(samples[0] + 1.7e9, *samples[1:])
    zero.pop("time")
    late.pop("time")
    assert same(zero, late)


def test_a_recording_in_two_parts_gives_the_bits_of_one(samples):
    whole = Estimator().process(*samples)
    est = Estimator()
    first = est.process(*part(samples, slice(0, 3001)))
    second = est.process(*part(samples, slice(3001, None)))
    assert same(whole, {name: np.concatenate([first[name], second[name]]) for name in first})


def test_reset_begins_a_new_run(samples):
    est = Estimator()
    first = est.process(*samples)
    est.reset()
    assert same(est.process(*samples), first)


def test_the_odometry_is_reset_in_the_next_row_and_all_else_stays(samples):
    est = Estimator()
    est.process(*part(samples, slice(0, 5000)))
    whole = Estimator().process(*samples)
    est.reset_odometry()
    after = est.process(*part(samples, slice(5000, None)))
    assert whole["x"][5000] > 0.1, "it had moved"
    for name in ("x", "y", "z", "yaw"):
        assert after[name][0] == pytest.approx(0, abs=1e-15), name
    assert after["pose_covariance"][0][:2, :2] == pytest.approx(np.zeros((2, 2)), abs=1e-20)  # m²: rounding
    assert after["pose_covariance"][0][5, 5] == pytest.approx(0, abs=1e-20)  # rad²
    for name in ("linear", "angular", "gyro_bias", "radius_ratio", "distance", "flags"):
        assert np.array_equal(after[name][0], whole[name][5000]), name


def test_the_odometry_is_set_in_the_first_row_and_only_there(samples):
    moved, plain = Estimator(), Estimator().process(*samples)
    moved.set_odometry(1.0, -2.0, 0.5)
    out = moved.process(*samples)
    assert (out["x"][0], out["y"][0]) == (1.0, -2.0)
    cos, sin = np.cos(0.5), np.sin(0.5)
    assert out["yaw"][0] == pytest.approx(0.5)
    # A run begins with a certain place of the IMU, a pose that is set with that of base_link: 6 cm below, at a tilt of
    # 0.1 rad.
    assert out["x"][-1] == pytest.approx(1 + cos * plain["x"][-1] - sin * plain["y"][-1], abs=0.006)
    assert out["y"][-1] == pytest.approx(-2 + sin * plain["x"][-1] + cos * plain["y"][-1], abs=0.006)


def test_what_is_no_pose_is_refused_and_changes_nothing(samples):
    est = Estimator()
    for pose in ((np.nan, 0, 0), (0, 1.1e6, 0), (0, 0, np.inf)):
        with pytest.raises(ValueError, match="must be a number of"):
            est.set_odometry(*pose)
    assert same(est.process(*samples), Estimator().process(*samples))


def test_a_pose_that_was_set_is_forgotten_by_a_new_run(samples):
    est = Estimator()
    est.set_odometry(1.0, 0.0, 0.0)
    est.reset()
    assert same(est.process(*samples), Estimator().process(*samples))


def test_thinned_rows_are_those_of_all_rows_and_the_last_one(samples):
    whole = Estimator().process(*samples)
    thin = Estimator().process(*samples, every=7)
    rows = np.unique([*range(0, samples[0].size, 7), samples[0].size - 1])
    assert same(thin, {name: values[rows] for name, values in whole.items()})


def test_without_covariance_only_the_matrices_are_left_out(samples):
    whole = Estimator().process(*samples)
    lean = Estimator().process(*samples, covariance=False)
    assert whole.keys() - lean.keys() == {"pose_covariance", "twist_covariance", "attitude_covariance"}
    assert same(lean, {name: whole[name] for name in lean})


def test_what_comes_out_has_the_documented_shapes(samples):
    out = Estimator().process(*part(samples, slice(0, 10)))
    shapes = {"quaternion": (4,), "attitude": (4,), "pose_covariance": (6, 6), "twist_covariance": (6, 6)}
    shapes |= {"attitude_covariance": (3, 3), "rejected": (6,), "nis": (6,), "confidence": (6,)}
    shapes |= dict.fromkeys(("linear", "angular", "gyro_bias", "gyro_bias_deviation", "accelerometer_bias"), (3,))
    for name, values in out.items():
        assert values.shape == (10, *shapes.get(name, ())), name
        assert f"{name}" in Estimator.process.__doc__, name
    assert out["valid"].dtype == bool
    assert out["flags"].dtype == out["rejected"].dtype == np.int64


def test_geometry_is_as_good_as_the_urdf_that_says_the_same_but_for_wheels_behind_these(samples):
    ours, urdf = Estimator(**GEOMETRY).process(*samples), Estimator(urdf=DIFFBOT).process(*samples)
    for name in ("wheel_x", "wheel_y", "wheel_yaw", "slip", "rejected"):
        assert np.array_equal(ours[name], urdf[name]), name
    for name in ("x", "y", "yaw"):
        assert ours[name] == pytest.approx(urdf[name], abs=1e-3), name
    assert ours["wheel_base_deviation"][-1] > 1.5 * urdf["wheel_base_deviation"][-1]


def test_geometry_lies_over_a_urdf(samples):
    est = Estimator(urdf=DIFFBOT, wheel_radius=0.11, imu_position=(0.0, 0.0, 0.5))
    assert [wheel["radius"] for wheel in est.robot["wheels"]] == [0.11, 0.11]
    assert est.robot["wheel_base"] == 0.5
    assert est.robot["imu"]["position"] == [0.0, 0.0, 0.5]


def test_any_mounting_of_the_imu_gives_the_same_path(samples):
    roll, pitch, yaw = 0.3, -1.1, 2.0
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    to_base = (
        np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
        @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
        @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    )
    turned = [*samples[:3], samples[3] @ to_base, samples[4] @ to_base]  # rows: (Rᵀ v)ᵀ
    even = Estimator(**GEOMETRY).process(*samples)
    out = Estimator(**GEOMETRY, imu_orientation=(roll, pitch, yaw)).process(*turned)
    # Rounding is amplified if a gate or a window decides by a small margin: 0.1 mm and 0.01° over 3 m.
    assert np.max(np.hypot(out["x"] - even["x"], out["y"] - even["y"])) < 1e-4
    assert np.max(np.abs(out["yaw"] - even["yaw"])) < 2e-4
    assert out["gyro_bias"][-1] @ to_base.T == pytest.approx(even["gyro_bias"][-1], abs=1e-4)


def test_angles_and_quaternion_are_two_words_for_one_mounting(samples):
    half = 0.35
    quaternion = (0.0, 0.0, np.sin(half), np.cos(half))
    by_angles = Estimator(**GEOMETRY, imu_orientation=(0.0, 0.0, 2 * half)).robot["imu"]["orientation"]
    by_quaternion = Estimator(**GEOMETRY, imu_orientation=quaternion).robot["imu"]["orientation"]
    assert by_angles == pytest.approx(by_quaternion, abs=1e-15)


def path_error(out, log):
    """m and rad, against the truth at the same times."""
    rows = np.searchsorted(log["time"], out["time"])
    position = np.hypot(out["x"] - log["truth_x"][rows], out["y"] - log["truth_y"][rows])
    turn = out["yaw"] - log["truth_yaw"][rows]
    return float(position[-1]), float(abs(np.angle(np.exp(1j * turn[-1]))))


def assert_on_the_path(out, log):
    """The end is right within 1 % of the 3.5 m that it drove, and within 1°."""
    position, yaw = path_error(out, log)
    assert position < 0.035
    assert yaw < 0.0175
    assert out["valid"][-1]


def test_samples_may_come_at_irregular_times(log, samples):
    rows = np.cumsum(np.random.default_rng(4).integers(1, 20, size=2000))  # 1 … 19 ms apart
    rows = rows[rows < samples[0].size]
    est = Estimator()
    assert_on_the_path(est.process(*part(samples, rows)), log)
    assert est.period == pytest.approx(np.median(np.diff(samples[0][rows])))


def at_rates(samples, wheels, imu, offset):
    """Rows that sensors of other rates [Hz] would give for the exact rows of a 1 kHz log. The IMU's stamps are `offset`
    s late, and its samples are means over its period.
    """
    time, left, right, gyro, accel = samples
    of_wheels = np.arange(0, time.size, 1000 // wheels)
    step = 1000 // imu
    of_imu = np.arange(step, time.size, step)
    times = np.concatenate([time[of_wheels], time[of_imu] + offset])
    merged = np.unique(times)
    out = [merged, *(np.full((merged.size, *table.shape[1:]), np.nan) for table in samples[1:])]
    for table, values in zip(out[1:3], (left, right), strict=True):
        table[np.searchsorted(merged, times[: of_wheels.size])] = values[of_wheels]
    for table, values in zip(out[3:], (gyro, accel), strict=True):
        means = np.array([values[row - step + 1 : row + 1].mean(axis=0) for row in of_imu])
        table[np.searchsorted(merged, times[of_wheels.size :])] = means
    return out


# The stamps of two drivers in a bag have any distance, for instance 10 µs.
@pytest.mark.parametrize("offset", [1e-5, 0.0033])
@pytest.mark.parametrize(("wheels", "imu"), [(50, 200), (100, 100), (20, 100), (10, 50)])
def test_rates_that_people_have_give_path_and_twist(log, samples, wheels, imu, offset):
    out = Estimator().process(*at_rates(samples, wheels, imu, offset))
    rows = np.clip(np.round(out["time"] * 1000).astype(int), 0, log["time"].size - 1)
    assert np.hypot(out["x"][-1] - log["truth_x"][rows[-1]], out["y"][-1] - log["truth_y"][rows[-1]]) < 0.1
    moving = out["time"] > 2  # past the ramp
    # The gyro's samples may be 0.02 s old, in a turn that changes by 0.8 rad/s²; the truth's own ripple has 0.03 rad/s.
    # Samples of the wheels may come every 0.1 s only.
    assert np.max(np.abs(out["linear"][moving, 0] - log["truth_linear"][rows[moving]])) < 0.1
    assert np.max(np.abs(out["angular"][moving, 2] - log["truth_angular"][rows[moving]])) < 0.1
    assert np.mean(out["flags"] & FLAGS["slip"] != 0) < 0.05
    for name, values in out.items():
        assert np.all(np.isfinite(values)), name


def test_wheels_alone_make_a_path(log, samples):
    out = Estimator().process(*samples[:3])
    assert_on_the_path(out, log)  # the simulated wheels hardly slip, and match the URDF
    assert np.all(out["flags"] & FLAGS["no_gyro"])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"time": [0.0, 0.1, 0.1]}, r"time\[2\] is 0.1 s, time\[1\] is 0.1 s; time must strictly increase"),
        ({"time": [0.0, 0.2, 0.1]}, r"time\[2\] is 0.1 s"),
        ({"time": [0.0, np.nan, 0.1]}, r"time\[1\] is nan"),
        ({"time": [0.0, 0.1, np.inf]}, r"time\[2\] is inf"),
        ({"time": [[0.0, 0.1, 0.2]]}, r"time has the shape \(1, 3\)"),
        ({"time": []}, r"at least one row"),
        ({"time": ["a", "b", "c"]}, r"time is not an array of numbers"),
        ({"left_position": [0.0, 0.1]}, r"left_position has the shape \(2,\); with 3 times it must be \(3,\)"),
        ({"left_position": np.zeros((3, 2))}, r"left_position has the shape \(3, 2\)"),
        ({"right_position": 1.0}, r"right_position has the shape \(\)"),
        ({"right_position": [None, "x", 1]}, r"right_position is not an array of numbers"),
        ({"left_position": [0.0, [1.0], 2.0]}, r"left_position is not an array of numbers"),
        ({"gyro": np.zeros(3)}, r"gyro has the shape \(3,\); .* one axis"),
        ({"gyro": np.zeros((2, 3))}, r"gyro has the shape \(2, 3\)"),
        ({"accel": np.zeros((3, 2))}, r"accel has the shape \(3, 2\)"),
        ({"every": 0}, r"every is 0"),
        ({"every": 1.5}, r"every is 1.5"),
    ],
)
def test_refuses_what_is_no_recording_and_says_why(change, said):
    healthy = {"time": [0.0, 0.1, 0.2], "left_position": np.zeros(3), "right_position": np.zeros(3)}
    with pytest.raises(ValueError, match=said):
        Estimator(**GEOMETRY).process(**(healthy | change))


def test_a_refused_call_changes_nothing(samples):
    whole = Estimator().process(*samples)
    est = Estimator()
    est.process(*part(samples, slice(0, 100)))
    with pytest.raises(ValueError, match=r"time\[0\] is 0.05 s, not after 0.099 s"):
        est.process(*part(samples, slice(50, 60)))
    rest = est.process(*part(samples, slice(100, None)))
    assert same(rest, {name: values[100:] for name, values in whole.items()})


@pytest.mark.parametrize(
    ("arguments", "error", "said"),
    [
        ({"wheel_radius": 0.1}, ValueError, "wheel_radius without wheel_base"),
        ({"wheel_base": 0.5}, ValueError, "wheel_base without wheel_radius"),
        ({"wheel_radius": -0.1, "wheel_base": 0.5}, ParameterError, "wheel_radius"),
        ({"wheel_radius": np.nan, "wheel_base": 0.5}, ParameterError, "wheel_radius"),
        ({"imu_position": (1.0, 2.0)}, ValueError, "imu_position is .* 3 finite numbers"),
        ({"imu_position": (1.0, 2.0, np.nan)}, ValueError, "imu_position"),
        ({"imu_orientation": (1.0, 1.0, 1.0, 1.0)}, ValueError, "must have norm 1"),
        ({"imu_orientation": (0.0, 0.0)}, ValueError, "3 or 4 finite numbers"),
        ({"encoder_counts": 0}, ValueError, "encoder_counts is 0; it must be above 0 counts"),
        ({"params": {"state_estimator": {"calibration_file": "/nowhere/c.yaml"}}}, ParameterError, "/nowhere"),
        ({"period": 0.0}, ValueError, "period is 0.0; it must be above 0 s"),
        ({"urdf": "/nowhere.urdf"}, RobotError, "/nowhere.urdf"),
        ({"params": {"state_estimator": {"gyro_noise": -1.0}}}, ParameterError, "gyro_noise"),
        ({"params": {"state_estimator": {"gyro_nois": 1.0}}}, ParameterError, "gyro_nois"),
    ],
)
def test_refuses_a_robot_that_is_none_and_says_why(arguments, error, said):
    with pytest.raises(error, match=said):
        Estimator(**arguments)


def test_parameters_reach_the_filter(samples):
    known = {"wheel_radius_deviation": 0.0}  # which the pose's covariance holds beside the noise
    rough = Estimator({"state_estimator": {"wheel_slip_noise": 0.2, **known}}).process(*samples)
    usual = Estimator({"state_estimator": known}).process(*samples)
    assert rough["pose_covariance"][-1, 0, 0] > 10 * usual["pose_covariance"][-1, 0, 0]


def test_what_was_learned_is_kept_and_read_again(tmp_path, samples):
    path = tmp_path / "calibration.yaml"
    est = Estimator()
    with pytest.raises(RuntimeError, match="nothing was estimated yet"):
        est.save_calibration(path)
    learned = est.process(*samples)
    est.save_calibration(path)
    again = Estimator({"state_estimator": {"calibration_file": str(path)}}).process(*part(samples, slice(0, 1)))
    assert again["radius_ratio"][0] == learned["radius_ratio"][-1]
    assert again["wheel_base_factor"][0] == learned["wheel_base_factor"][-1]
    assert again["radius_ratio_deviation"][0] < 0.01  # the parameter's, for an unknown robot


def standing(rows):
    t = np.arange(rows) * 0.001
    return [t, np.zeros(rows), np.zeros(rows), np.zeros((rows, 3)), np.tile([0.0, 0.0, 9.81], (rows, 1))]


def test_takes_at_least_200000_rows_a_second():
    rows = 100000
    samples = standing(rows)
    best = np.inf
    for _ in range(5):  # processor time: others may be using the machine
        est = Estimator(**GEOMETRY)
        begin = clock.thread_time()
        est.process(*samples, covariance=False)
        best = min(best, clock.thread_time() - begin)
    assert rows / best > 200000


def test_other_threads_run_meanwhile_and_may_not_enter():
    est = Estimator(**GEOMETRY)
    samples = standing(2000000)
    worker = threading.Thread(target=est.process, args=samples, kwargs={"every": 1000})
    worker.start()
    turns, refused = 0, 0
    while worker.is_alive():
        turns += 1
        try:
            est.process([1e9], [0.0], [0.0])
        except RuntimeError as error:
            refused += "another thread" in str(error)
        except ValueError:  # the run had not begun, or had ended
            pass
    assert turns > 100
    assert refused > 100
