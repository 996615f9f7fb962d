"""The judgement of odometry by truth, errors, consistency and promises, each against a result known by hand."""

import dataclasses
import math

import numpy as np
import pytest
from support.recordings.synthetic_odometry import RADIUS, drive

from bench.odometry.consistency import Notice, nees, nees_band, notice
from bench.odometry.errors import Errors
from bench.odometry.judge import Run, largest_mean, return_errors
from bench.odometry.methods import raw_wheels
from bench.odometry.promises import (
    CALIBRATED,
    RAW,
    SIMPLE,
    Promise,
    all_promises,
    in_band,
    mean_nees,
    umbmark,
)
from bench.odometry.tested_estimator import OURS, Ours
from bench.odometry.truth import Track, after_resets, levelling, slip_ratio, truth_of

STAND, LINE = (0.0, 0.0, 1.0), (0.5, 0.0, 4.0)
ROUNDING = 1e-9


# Truth.


def test_up_becomes_z_and_the_heading_stays():
    up = np.array([math.sin(0.1), 0.0, math.cos(0.1)])
    turn = levelling(up)
    assert turn @ up == pytest.approx([0, 0, 1], abs=ROUNDING)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=ROUNDING)
    assert np.linalg.det(turn) == pytest.approx(1)
    assert (turn @ [1, 0, 0])[1] == pytest.approx(0, abs=ROUNDING)
    assert (turn @ [1, 0, 0])[2] == pytest.approx(math.sin(0.1)), "uphill"


def test_the_way_up_a_slope_is_shorter_on_the_map():
    recording = dataclasses.replace(drive(STAND, LINE), up=np.array([math.sin(0.1), 0.0, math.cos(0.1)]))
    truth = truth_of(recording)
    assert truth.ground.x[-1] == pytest.approx(2.0)
    assert truth.odom.x[-1] == pytest.approx(2.0 * math.cos(0.1))
    assert truth.distance[-1] == pytest.approx(2.0)


def test_a_wheel_that_rolls_does_not_slip_in_a_turn_and_with_a_wrong_radius():
    recording = drive((0.5, 1.0, 2.0), errors=Errors(0.005, -0.005, 0.02, 0.0))
    assert slip_ratio(recording) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    ("rim", "ground", "expected"),
    [(0.6, 0.3, 0.5), (0.0, 0.5, 1.0), (0.5, 0.0, 1.0), (0.02, 0.0, 0.2), (-0.3, 0.3, 2.0)],
    ids=["spins", "locked", "spins on the spot", "below 0.1 m/s", "against its way"],
)
def test_slip_is_the_difference_over_the_faster_one(rim, ground, expected):
    recording = drive(LINE)
    recording.wheel_speed[:, 0] = rim / RADIUS
    recording.linear[:, 0] = ground
    assert slip_ratio(recording)[0, 0] == pytest.approx(expected)


def test_a_wheel_that_climbs_and_one_whose_body_pitches_do_not_slip():
    recording = drive(LINE)
    recording.linear[:] = [0.4, 0.0, 0.3]  # 0.5 m/s, upwards
    assert slip_ratio(recording) == pytest.approx(0, abs=1e-12)
    recording.angular[:, 1] = 0.2  # rad/s: the encoder sees that much less
    recording.wheel_speed[:] -= 0.2
    assert slip_ratio(recording) == pytest.approx(0, abs=1e-12)


# Errors.


def test_a_return_error_is_that_of_its_own_square():
    """An error from before the begin of a square does not count: two lines after a turn that the wheels misjudge."""
    turn, back = (0.0, 1.0, 1.0), (-0.5, 0.0, 4.0)
    marks = {"cw": [1000], "ccw": [9000], "end": [9000, 17000]}
    recording = drive(turn, LINE, back, LINE, back, errors=Errors(0.0, 0.0, 0.02, 0.0), marks=marks)
    errors = return_errors(recording, raw_wheels(recording), truth_of(recording).ground)
    assert errors == pytest.approx(np.zeros((2, 3)), abs=1e-6)
    shifted = Track(recording.time[recording.index], np.zeros(len(recording.index)), np.zeros(len(recording.index)))
    still = Track(*(np.zeros(len(recording.index)) for _ in range(3)))
    assert return_errors(recording, shifted, still)[:, 0] == pytest.approx([8.0, 8.0])


def test_a_reset_truth_restarts_in_its_own_axes():
    track = Track(
        np.array([0.0, 1.0, 1.0, 1.0]), np.array([0.0, 0.0, 2.0, 5.0]), np.array([0.0, 0.0, np.pi / 2, np.pi])
    )
    reset = after_resets(track, [2])
    assert reset.x == pytest.approx([0.0, 1.0, 0.0, 3.0])
    assert reset.y == pytest.approx([0.0, 0.0, 0.0, 0.0])
    assert reset.yaw == pytest.approx([0.0, 0.0, 0.0, np.pi / 2])


def test_a_standing_robot_does_not_count_for_consistency():
    runs = [
        run_of("random", pose_nees=np.array([3.0, np.nan, np.nan]), seed=seed, killed={OURS: 0, RAW: 1})
        for seed in (0, 1)
    ]
    runs[1].pose_nees[1] = 3.0
    times, means, low, high = mean_nees(runs, "pose")
    assert times == pytest.approx([1.0, 2.0])
    assert means == pytest.approx([3.0, 3.0])
    assert high[1] - low[1] > high[0] - low[0], "of one run"


def test_the_largest_mean_is_of_the_worse_way_round():
    clockwise, other = [[1.0, 0.0], [3.0, 0.0]], [[0.0, -1.0], [0.0, -5.0]]
    assert largest_mean(np.array(clockwise + other)) == pytest.approx(3.0)


# Consistency.


def test_nees_is_infinite_where_the_covariance_is_none():
    error, zero = np.ones((2, 2)), np.zeros((2, 2))
    assert np.isinf(nees(error, np.array([zero, np.full((2, 2), np.nan)]))).all()


@pytest.mark.parametrize(
    ("runs", "dimension", "low", "high"), [(50, 2, 74.222, 129.561), (5, 2, 3.247, 20.483), (10, 3, 16.791, 46.979)]
)
def test_the_band_is_that_of_the_table_of_chi_square(runs, dimension, low, high):
    """2.5 % and 97.5 % quantiles of χ² with 100, 10 and 30 degrees of freedom."""
    assert nees_band(runs, dimension) == pytest.approx((low / runs, high / runs), rel=0.01)


# Detected slip.


def test_only_slip_above_a_fifth_has_to_be_flagged_and_only_below_a_twentieth_it_must_not():
    recording = drive(LINE)
    ours = _ours(len(recording.index))
    truth = truth_of(recording)
    truth.slip[:] = 0.1
    truth.slip[:30, 0] = 0.3
    truth.slip[30:90] = 0.01
    ours.slip[20:40] = True
    assert notice(ours, truth) == Notice(30, 10, rolling=60, alarms=10, rows=len(truth.linear))


def test_a_robot_is_blocked_while_all_wheels_turn_and_it_stands_for_more_than_a_second():
    recording = drive(LINE)
    ours = _ours(len(recording.index))
    truth = truth_of(recording)
    truth.linear[:] = 0.0
    for begin, end in ((0, 100), (105, 210), (215, 320), (325, 401)):  # of 10 ms: the first one is too short
        truth.slip[begin:end] = 1.0
    truth.linear[325:] = 0.5  # it slides
    for row in (20, 200, 322):  # the last one comes after the third span
        ours.slip[row] = True
    noticed = notice(ours, truth)
    assert (noticed.blocked, noticed.reported) == (2, 1)


def _ours(rows):
    zeros = np.zeros(rows)
    flags = np.zeros(rows, dtype=bool)
    track = Track(zeros, zeros, zeros)
    pose, twist = np.tile(np.eye(3), (rows, 1, 1)), np.tile(np.eye(2), (rows, 1, 1))
    return Ours(track, pose, zeros, zeros, twist, flags, ~flags)


# Promises.


def run_of(scenario="slip", ours=0.1, wheels=1.0, seed=0, **more):
    errors = {OURS: ours, CALIBRATED: wheels, SIMPLE: 0.1, RAW: 1.0}
    fields = {
        "stopped": False,
        "distance": 10.0,
        "position": errors,
        "yaw": errors,
        "times": np.arange(1.0, 4.0),
        "pose_nees": np.full(3, 3.0),
        "twist_nees": np.full(3, 2.0),
        "notice": Notice(100, 95, 1000, 10, 2000, 10, 9),
        "pitch": 0.0,
        "jump": 0.0,
        "invalid": 0.0,
    }
    return Run(scenario=scenario, seed=seed, **fields | more)


def kept(promises):
    return {promise.name: promise.kept for promise in promises}


def test_a_healthy_slip_run_keeps_all_promises():
    assert all(kept(all_promises([run_of()])).values())


@pytest.mark.parametrize(
    ("broken", "name"),
    [
        ({"notice": Notice(100, 95, 1000, 10, 2000, 10, 8)}, "blocked for more than 1 s, flagged"),
        ({"notice": Notice(100, 95, 1000, 31, 2000, 10, 9)}, "false alarms, slip"),
        ({"ours": 0.12}, "slip, position over simple odometry's"),
    ],
)
def test_each_broken_promise_is_reported(broken, name):
    promises = all_promises([run_of(**broken)])
    assert not kept(promises)[name]


@pytest.mark.parametrize(
    ("broken", "name"),
    [
        ({"scenario": "umbmark", "ours": 0.031}, "UMBmark, mean"),
        ({"notice": Notice(100, 95, 1000, 10, 2000, 10, 8)}, "blocked for more than 1 s, flagged"),
        ({"notice": Notice(100, 95, 1000, 31, 2000, 10, 9)}, "false alarms, slip"),
    ],
)
def test_each_broken_promise_of_the_field_is_reported(broken, name):
    notices = {"notice": Notice(100, 95, 1000, 10, 2000, 10, 9)}
    sound = [run_of("umbmark", 0.029, **notices), run_of("slip", **notices)]
    assert all(kept(all_promises(sound, "field")).values())
    assert not kept(all_promises([run_of(**{**notices, **broken})], "field"))[name]


def test_umbmark_is_judged_by_its_worst_seed_and_its_mean():
    promises = {
        promise.name: promise for promise in umbmark([run_of("umbmark", ours=0.041), run_of("umbmark", ours=0)])
    }
    assert not promises["UMBmark, worst seed"].kept
    assert not promises["UMBmark, mean"].kept
    assert promises["UMBmark, mean"].value == pytest.approx(20.5)
    assert promises["UMBmark, raw wheels over ours"].value == pytest.approx(1 / 0.0205)


def test_a_covariance_too_large_is_outside_the_band_as_one_too_small_is():
    runs = [run_of(pose_nees=np.array([3.0, 0.01, 100.0]), seed=seed) for seed in range(10)]
    assert in_band(runs, "pose") == pytest.approx(1 / 3)
    assert in_band(runs, "twist") == 1


def test_a_figure_that_is_no_number_keeps_no_promise():
    assert not Promise("way", math.nan, 1.0, "m").kept
    assert not Promise("way", math.nan, 1.0, "m", least=True).kept
    assert Promise("way", 2.0, 1.0, "m", least=True).kept
    assert "at least 1" in str(Promise("way", 0.5, 1.0, "m", least=True))
