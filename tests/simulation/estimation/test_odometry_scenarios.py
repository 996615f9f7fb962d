"""The drives of the odometry benchmark have the properties that they claim."""

import dataclasses

import numpy as np
import pytest
from robot_control import ClosedLoop

from bench.odometry.consistency import ROLLING, SLIPPING
from bench.odometry.drives import FIRST_STAND, SIDE
from bench.odometry.errors import draw_errors
from bench.odometry.methods import calibrated_wheels, raw_wheels, standing
from bench.odometry.recording import TRUTH_EVERY, record
from bench.odometry.scenarios import SCENARIOS, draw_trial
from bench.odometry.slip import KINDS
from bench.odometry.truth import truth_of


def shortened(scenario, seed, cycles):
    trial = draw_trial(scenario, seed)
    return dataclasses.replace(trial, commands=trial.commands[:cycles])


@pytest.fixture(scope="module")
def drive():
    """Five seconds of a random drive."""
    return record(shortened("random", 1, 5000))


def test_a_record_is_what_a_run_logs():
    commands = np.tile([0.3, 0.5], (2000, 1))
    recorded, logged = ClosedLoop(seed=3).record(commands), ClosedLoop(seed=3).run(2.0, (0.3, 0.5))
    assert (recorded["gyro"][:, 2] == logged["gyro_z"]).all()
    assert (recorded["accel"][:, 0] == logged["accel_x"]).all()
    assert (recorded["wheel_position"][:, 1] == logged["right_wheel_joint_position"]).all()
    assert (recorded["position"][:, 1] == logged["truth_y"]).all()
    assert (recorded["linear"][:, 0] == logged["truth_linear"]).all()
    assert (recorded["time"] == logged["time"]).all()


def test_commands_of_another_shape_are_refused():
    with pytest.raises(ValueError, match="shape"):
        ClosedLoop().record(np.zeros((10, 3)))


def test_rows_without_a_number_send_nothing():
    commands = np.full((3000, 2), np.nan)
    commands[0] = [0.3, 0.0]
    log = ClosedLoop().record(commands)
    assert log["linear"][1000, 0] == pytest.approx(0.3, abs=0.02)
    assert log["linear"][-1, 0] == pytest.approx(0.0, abs=0.02), "it timed out, as cmd_vel does"


def test_a_seed_gives_the_same_bits_and_another_one_other_noise_and_another_robot(drive):
    assert (record(shortened("random", 1, 5000)).gyro == drive.gyro).all()
    other = record(shortened("random", 2, 5000))
    assert abs(other.gyro[:2000, 2].mean() - drive.gyro[:2000, 2].mean()) > 1e-5, "bias, σ 1.7e-3 rad/s"
    assert np.corrcoef(other.gyro[:2000, 2], drive.gyro[:2000, 2])[0, 1] < 0.12, "5/√2000"
    assert draw_errors(1) != draw_errors(2)


@pytest.mark.nightly
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_every_run_begins_at_rest_and_no_monitor_stops_it(scenario):
    recording = record(shortened(scenario, 0, 20_000))
    first = round(1000 * FIRST_STAND)
    assert standing(recording)[200:first].all()
    assert np.abs(recording.position[: first // TRUTH_EVERY]).max() < 1e-3
    assert np.abs(recording.position).max() > 0.1, "then it drives"
    assert not recording.stopped


@pytest.mark.nightly
def test_on_the_square_nominal_wheels_return_to_where_they_began():
    """The wheels return except for 12.5 mrad, on squares whose corners are at most 5.7 m away. That bound has
    several parts. Whole cycles make 0.5 ms of 1 rad/s in each of four turns, and the brakes take a share of each turn.
    The wheel loops creep by at most one and a half counts of 0.15 mm of both wheels, 0.5 m apart, after each of eight
    ramps. Each wheel may miss its next count.
    """
    trial = draw_trial("umbmark", 0)
    begin, end = trial.marks["cw"][0], trial.marks["end"][0]
    recording = record(dataclasses.replace(trial, commands=trial.commands[: end + 10]))
    path, rows = raw_wheels(recording), [begin // TRUTH_EVERY, end // TRUTH_EVERY]
    assert path.yaw[rows[1]] - path.yaw[rows[0]] == pytest.approx(-2 * np.pi, abs=0.0125)
    assert np.hypot(*(line[rows[1]] - line[rows[0]] for line in (path.x, path.y))) < 0.0125 * 5.7
    for line in (path.x, path.y):
        assert np.ptp(line) == pytest.approx(SIDE, abs=0.0125 * 5.7)


@pytest.mark.nightly
def test_the_pitching_ground_pitches_by_a_degree_and_no_wheel_slips():
    truth = truth_of(record(shortened("waves", 1, 60_000)))
    moving = np.abs(truth.linear) > 0.05
    assert np.rad2deg(np.std(truth.pitch[moving])) == pytest.approx(1.0, abs=0.15)
    assert (truth.slip < ROLLING).all(axis=1).mean() > 0.9
    assert (truth.slip > SLIPPING).any(axis=1).mean() < 0.005


@pytest.mark.nightly
def test_slip_runs_slip_between_stretches_of_grip():
    """One run of each kind is driven. Calibrated wheels are wrong by more than 0.2 m in most."""
    wrong = []
    for seed, kind in enumerate(KINDS):
        recording = record(draw_trial("slip", seed))
        truth, wheels = truth_of(recording), calibrated_wheels(recording)
        slipping = (truth.slip > SLIPPING).any(axis=1).mean()
        assert 0.003 < slipping < 0.4, kind
        assert (truth.slip < ROLLING).all(axis=1).mean() > 0.5, kind
        assert not recording.stopped, kind
        wrong.append(np.hypot(wheels.x[-1] - truth.ground.x[-1], wheels.y[-1] - truth.ground.y[-1]) > 0.2)
    assert np.mean(wrong) > 0.5


@pytest.mark.nightly
def test_within_default_limits_on_dry_ground_nothing_slips():
    truth = truth_of(record(shortened("random", 3, 60_000)))
    assert (truth.slip > SLIPPING).any(axis=1).mean() < 0.002
