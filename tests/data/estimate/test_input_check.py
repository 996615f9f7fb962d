"""Faults of an input are reported at once, with the remedy: each test breaks one thing in a healthy recording."""

import math

import numpy as np
import pytest
from robot_control import ClosedLoop, Estimator
from robot_control.data.estimate.clock import fit_turning
from robot_control.data.estimate.input_check import check, check_angles
from robot_control.data.estimate.samples import InputError, Samples, Stream, merged
from robot_control.data.estimate.streams import streams_of
from robot_control.robot.pose import rotation
from support.recordings.kinematic_drive import IMU, RADIUS, WHEEL_BASE, drive

from bench.odometry.recordings import ABSENT, NAMES, recording, recordings_folder

ROBOT = Estimator(wheel_radius=RADIUS, wheel_base=WHEEL_BASE, imu_position=IMU).robot
MILLISECOND = 0.001


@pytest.fixture(scope="module")
def exact():
    return drive(seconds=40.0)


def samples_of(exact, *, begin=0.0, imu_late=0.0, mounting=None):
    """Wheels at 50 Hz, IMU at 100 Hz with stamps that are late by `imu_late`, its axes turned by `mounting`."""
    wheels, imu = np.arange(begin, 39, 0.02), np.arange(max(begin, 0.003), 39, 0.01)
    at_wheels, at_imu = exact.at(wheels), exact.at(imu)
    turned = np.eye(3) if mounting is None else mounting
    stamps = [np.round(time * 1e9).astype(np.int64) for time in (wheels, imu + imu_late)]
    time_ns, tables = merged(
        [
            Stream(stamps[0], np.column_stack([at_wheels.left, at_wheels.right])),
            Stream(stamps[1], at_imu.gyro @ turned),
            Stream(stamps[1], at_imu.accel @ turned),
        ]
    )
    return Samples(time_ns, tables[0][:, 0], tables[0][:, 1], tables[1], tables[2])


def warnings_of(samples, robot=ROBOT):
    return " · ".join(check(samples, robot).warnings)


def test_a_healthy_recording_gives_no_warning_and_no_offset(exact):
    findings = check(samples_of(exact), ROBOT)
    assert findings.warnings == []
    assert findings.offset is None


@pytest.mark.parametrize("late", [-0.3, -0.03, 0.06, 0.17])
def test_the_offset_of_the_clocks_is_found_to_a_millisecond(exact, late):
    assert check(samples_of(exact, imu_late=late), ROBOT).offset == pytest.approx(late, abs=MILLISECOND)


def test_the_delay_of_the_simulated_imu_is_found_to_a_millisecond():
    """The errors are the noise and vibration of the field; the robot follows its wheels 1.1 ms late, because tyres
    yield.
    """

    def offset(delay):
        field = {"sensor_errors": "field", "imu_delay": delay, "imu_jitter": 0.0}
        loop = ClosedLoop({"mujoco_plant": field}, seed=4)
        log = loop.run(20.0, lambda t: (0.0, 0.0) if t < 2 else (0.5, 0.6 * math.sin(1.3 * t)))
        axes = [np.column_stack([log[f"{name}_{axis}"] for axis in "xyz"]) for name in ("gyro", "accel")]
        wheels = [log[f"{side}_wheel_joint_position"] for side in ("left", "right")]
        some = streams_of(Samples(np.round(log["time"] * 1e9).astype(np.int64), *wheels, *axes), loop.robot)
        return fit_turning(some.wheel_time, some.left, some.right, some.gyro_time, some.gyro[:, 2]).offset

    assert offset(0.08) - offset(0.0) == pytest.approx(0.08, abs=MILLISECOND)


def test_an_offset_that_was_found_can_be_taken_out(exact):
    late = samples_of(exact, imu_late=0.1)
    assert check(late.with_imu_earlier(0.1), ROBOT).offset is None


def test_taking_an_offset_out_keeps_all_columns(exact):
    late = samples_of(exact, imu_late=0.1)
    late.left = np.column_stack([late.left, late.left])
    moved = late.with_imu_earlier(0.1)
    assert moved.left.shape[1] == 2
    assert moved.right.ndim == 1
    wheels = ~np.isnan(moved.right)
    assert np.array_equal(moved.right[wheels], late.right[~np.isnan(late.right)])
    rate = exact.at(moved.seconds[~np.isnan(moved.gyro[:, 2])] + moved.time_ns[0] / 1e9).gyro[:, 2]
    assert moved.gyro[~np.isnan(moved.gyro[:, 2]), 2] == pytest.approx(rate, abs=1e-9)


@pytest.mark.parametrize(
    "rpy", [(math.pi / 2, 0, 0), (math.pi, 0, 0), (0, -math.pi / 2, 0), (-math.pi / 2, 0, math.pi / 2)]
)
def test_gravity_on_another_axis_names_the_mounting_that_fits(exact, rpy):
    """With the named mounting nothing is wrong."""
    right = Estimator(wheel_radius=RADIUS, wheel_base=WHEEL_BASE, imu_position=IMU, imu_orientation=rpy)
    samples = samples_of(exact, mounting=rotation(right.robot["imu"]["orientation"]))
    assert check(samples, right.robot).warnings == []
    said = warnings_of(samples)
    assert "away from the direction that follows from the IMU's mounting" in said
    named = [float(angle) for angle in said.split("--imu-orientation=")[1].split()[0].split(",")]
    assert (
        Estimator(wheel_radius=RADIUS, wheel_base=WHEEL_BASE, imu_orientation=named).robot["imu"]["orientation"]
        == pytest.approx(right.robot["imu"]["orientation"], abs=1e-3)
        or warnings_of(samples, Estimator(wheel_radius=RADIUS, wheel_base=WHEEL_BASE, imu_orientation=named).robot)
        == ""
    )


def test_a_heading_of_the_imu_that_does_not_fit_the_drive_is_said(exact):
    quarter = rotation((0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    assert "--imu-orientation=0,0,1.571 fits" in warnings_of(samples_of(exact, mounting=quarter))


def test_gravity_between_the_axes_asks_for_the_mounting(exact):
    oblique = rotation((math.sin(math.radians(22.5)), 0.0, 0.0, math.cos(math.radians(22.5))))
    assert "on none of its axes" in warnings_of(samples_of(exact, mounting=oblique))


def test_an_accelerometer_in_g_is_refused_with_the_remedy(exact):
    samples = samples_of(exact)
    samples.accel /= 9.80665
    with pytest.raises(InputError, match="--accel-unit g"):
        check(samples, ROBOT)


def test_an_accelerometer_without_gravity_or_of_another_scale_is_said(exact):
    samples = samples_of(exact)
    samples.accel[:, 2] -= 9.80665
    assert "shows no gravity" in warnings_of(samples)
    samples = samples_of(exact)
    samples.accel *= 1.3
    assert "check its unit and scale" in warnings_of(samples)


def test_counts_instead_of_radians_are_refused_with_the_remedy(exact):
    samples = samples_of(exact)
    check_angles(samples)
    samples.left, samples.right = (np.round(table * 100) for table in (samples.left, samples.right))
    with pytest.raises(InputError, match="--counts-per-turn"):
        check_angles(samples)


def test_a_gyro_in_degrees_is_refused_with_the_remedy(exact):
    samples = samples_of(exact)
    samples.gyro = np.degrees(samples.gyro)
    with pytest.raises(InputError, match="--gyro-unit deg/s"):
        check(samples, ROBOT)


def test_a_left_handed_imu_is_said(exact):
    samples = samples_of(exact)
    samples.gyro[:, 2] *= -1
    assert "the gyro turns against the wheels: its frame is left-handed" in warnings_of(samples)
    samples = samples_of(exact)
    samples.accel[:, 1] *= -1
    assert "they are left-handed" in warnings_of(samples)


def test_exchanged_wheels_are_said(exact):
    samples = samples_of(exact)
    samples.left, samples.right = samples.right, samples.left
    assert "left and right wheels are exchanged" in warnings_of(samples)


def test_another_wheel_base_is_said_with_its_value(exact):
    given = Estimator(wheel_radius=RADIUS, wheel_base=WHEEL_BASE / 2).robot
    assert f"the effective wheel base is {WHEEL_BASE:.3f} m, not {WHEEL_BASE / 2:.3f} m" in warnings_of(
        samples_of(exact), given
    )


def test_a_start_in_motion_is_said(exact):
    assert "never rests" in warnings_of(samples_of(exact, begin=5.0))
    samples = samples_of(exact)
    for table in (samples.left, samples.right):
        table[:] = table[::-1]  # backwards in time: the drive ends with its rest
    samples.gyro, samples.accel = None, None
    assert warnings_of(samples) == ""  # no gyro, no bias
    samples = samples_of(exact)
    samples.left, samples.right = samples.left[::-1].copy(), samples.right[::-1].copy()
    samples.gyro *= -1
    samples.gyro = samples.gyro[::-1].copy()
    assert "starts in motion, the first rest is after" in warnings_of(samples)


def test_a_broken_gyro_axis_is_said(exact):
    samples = samples_of(exact)
    samples.gyro[:, 0] -= math.radians(31)
    assert "the gyro's x axis shows -31.0 °/s at rest" in warnings_of(samples)


def test_two_sensors_may_be_sampled_at_the_same_time(exact):
    """Two devices with one clock and one rate: their stamps differ by a microsecond."""
    time = np.arange(0, 39, 0.02)
    at, stamps = exact.at(time), np.round(time * 1e9).astype(np.int64)
    time_ns, (wheels, gyro, accel) = merged(
        [
            Stream(stamps, np.column_stack([at.left, at.right])),
            Stream(stamps + 1000, at.gyro),
            Stream(stamps + 1000, at.accel),
        ]
    )
    assert warnings_of(Samples(time_ns, wheels[:, 0], wheels[:, 1], gyro, accel)) == ""


def test_too_little_concludes_nothing(exact):
    samples = samples_of(exact)
    few = slice(0, 10)
    short = Samples(samples.time_ns[few], samples.left[few], samples.right[few], samples.gyro[few], samples.accel[few])
    assert check(short, ROBOT).offset is None
    assert fit_turning(*[np.empty(0)] * 5) is None


def test_wheels_alone_are_nothing_to_check_against(exact):
    samples = samples_of(exact)
    samples.gyro = samples.accel = None
    assert check(samples, ROBOT).warnings == []


# Offsets from the README of the recordings and from a correlation by hand; the other IMUs share a row with the wheels.
OFFSETS = {
    "skid_steer_a": 0.05,
    "skid_steer_b": 0.05,
    "skid_steer_c": 0.16,
    "skid_steer_d": 0.06,
    "vacuum_a": None,
    "vacuum_b": None,
    "vacuum_c": None,
    "vehicle": -0.025,
}


def recorded(name, **changes):
    some = recording(name)
    samples = Samples(np.round(some.time * 1e9).astype(np.int64), some.left, some.right, some.gyro, some.accel)
    for key, value in changes.items():
        setattr(samples, key, value(getattr(samples, key)))
    return samples, Estimator(wheel_radius=some.radius, wheel_base=some.base).robot


@pytest.mark.skipif(recordings_folder() is None, reason=ABSENT)
@pytest.mark.parametrize("name", OFFSETS)
def test_offsets_of_real_recordings_are_found(name):
    offset = check(*recorded(name)).offset
    if OFFSETS[name] is None:
        assert offset is None
    else:
        assert offset == pytest.approx(OFFSETS[name], abs=0.02)


IN_MOTION = {
    "husky_ice": "never rests",
    "husky_snow": "starts in motion, the first rest is after 6.5 s",
    "husky_asphalt": "starts in motion, the first rest is after 0.8 s",
}
"""recordings that do not begin with a rest, each with its warning"""


@pytest.mark.skipif(recordings_folder() is None, reason=ABSENT)
@pytest.mark.parametrize(
    "name",
    [name for name in NAMES if name not in {*IN_MOTION, "vehicle", "vehicle_mirrored_x", "outdoor_skid_steer_imu_b"}],
)
def test_sound_recordings_of_real_robots_cause_no_warning(name):
    assert check(*recorded(name)).warnings == []


@pytest.mark.skipif(recordings_folder() is None, reason=ABSENT)
@pytest.mark.parametrize("name", IN_MOTION)
def test_real_recordings_that_begin_in_motion_are_said_and_nothing_else(name):
    (said,) = check(*recorded(name)).warnings
    assert IN_MOTION[name] in said


@pytest.mark.skipif(recordings_folder() is None, reason=ABSENT)
def test_a_real_broken_gyro_axis_is_said():
    (said,) = check(*recorded("outdoor_skid_steer_imu_b")).warnings
    assert "the gyro's x axis shows -30.8 °/s at rest" in said


@pytest.mark.skipif(recordings_folder() is None, reason=ABSENT)
@pytest.mark.parametrize("name", ["skid_steer_a", "skid_steer_d", "vacuum_b", "outdoor_skid_steer"])
def test_a_real_imu_on_its_side_names_its_mounting(name):
    """The IMU was turned about x by a quarter, so y was up."""
    aside = np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]])
    samples, robot = recorded(name, gyro=lambda table: table @ aside, accel=lambda table: table @ aside)
    said = " · ".join(check(samples, robot).warnings)
    assert "--imu-orientation=1.571," in said
    assert "fits, with the forces of the drive" in said


@pytest.mark.skipif(recordings_folder() is None, reason=ABSENT)
def test_the_vehicle_as_it_was_recorded_has_a_left_handed_imu():
    samples, robot = recorded("vehicle")
    samples.gyro = samples.gyro * [-1, 1, -1]  # as it stands in the file; the recording is shared by the tests
    assert "left-handed" in " · ".join(check(samples, robot).warnings)
