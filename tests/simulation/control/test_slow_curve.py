"""Skid steers do not surge when their treads break loose in a slow curve, and do not spring back after a turn."""

import numpy as np
import pytest
from robot_control import ClosedLoop
from simulation.corpus import ABSENT, FOLDER
from simulation.skid_steer import write_skid_steer

from bench.robot_corpus import urdf_of


@pytest.fixture(scope="module", name="skid_steer")
def fixture_skid_steer(tmp_path_factory) -> str:
    """Path of the description."""
    return write_skid_steer(tmp_path_factory.mktemp("robot"))


@pytest.mark.parametrize("command", [(0.05, 0.1), (0.03, -0.05), (-0.1, 0.3)])
def test_starts_in_a_curve_without_a_surge(skid_steer, command):
    loop = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}}, urdf=skid_steer)
    assert len(loop.robot["wheels"]) == 4
    loop.run(1.0, (0.0, 0.0))
    cycles = round(0.05 / loop.period)
    for _ in range(2):
        log = loop.run(2.0, command)
        speed = np.convolve(np.sign(command[0]) * log["truth_linear"], np.full(cycles, 1 / cycles), mode="valid")
        assert speed.max() <= 1.05 * abs(command[0]) + 0.005
        assert speed[-1] == pytest.approx(abs(command[0]), rel=0.1)
        loop.run(1.2, (0.0, 0.0))


# Integrators that hold the ground's friction would turn the robot back by themselves: with these, at 0.15 rad/s.
def test_does_not_turn_back_after_a_turn_with_slow_integrators(skid_steer):
    loop = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}}, urdf=skid_steer)
    loop.set_parameters({"pid_ki": 0.4})
    loop.run(1.0, (0.0, 0.0))
    loop.run(2.0, (0.0, 0.8))
    log = loop.run(1.0, (0.0, 0.0))
    cycles = round(0.05 / loop.period)
    assert np.convolve(log["truth_angular"], np.full(cycles, 1 / cycles), mode="valid").min() > -0.05


@pytest.mark.parametrize("ground", [0.3, 1.0, 2.0])
def test_a_turn_follows_its_reversal_on_any_ground(skid_steer, ground):
    loop = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet", "ground_friction": ground}}, urdf=skid_steer)
    loop.run(1.0, (0.0, 0.0))
    loop.run(1.0, (0.0, 0.5))
    for angular in (-0.5, 0.5):
        log = loop.run(1.0, (0.0, angular))
        reversed_for = np.abs(log["truth_angular"] - angular) < 0.1
        late = np.flatnonzero(~reversed_for)[-1] - np.flatnonzero(log["limited_angular"] != angular)[-1]
        assert late * loop.period < 0.2


# Treads under the brake tremble. A start from that speed, instead of from rest, surged by 0.08 m/s now and then.
@pytest.mark.skipif(FOLDER is None, reason=ABSENT)
def test_no_start_from_the_brake_surges():
    errors = {"sensor_errors": "data_sheet", "ground_friction": 1.0}
    loop = ClosedLoop({"mujoco_plant": errors}, urdf=urdf_of("jackal"))
    half_base = loop.robot["effective_wheel_base"] / 2
    loop.run(1.0, (0.0, 0.0))
    cycles = round(0.05 / loop.period)
    for _ in range(6):
        log = loop.run(2.0, (0.05, 0.1))
        turn = np.convolve(log["truth_angular"], np.full(cycles, 1 / cycles), mode="valid")
        assert half_base * (turn.max() - 0.1) < 0.03
        loop.run(1.2, (0.0, 0.0))


# A first torque for a floor of 0.7 surged by 73 mm/s of a rim on 0.4. A search that does not give torque back surged by
# 25 on 0.7. Now it surges by at most 21 on any floor, by 6 at the wheels.
@pytest.mark.skipif(FOLDER is None, reason=ABSENT)
@pytest.mark.parametrize("ground", [0.4, 0.7, 1.0])
def test_the_first_turn_of_a_run_does_not_surge_on_any_floor(ground):
    errors = {"sensor_errors": "data_sheet", "ground_friction": ground}
    for command in ((0.05, 0.1), (0.1, 0.3), (0.0, 0.5)):
        loop = ClosedLoop({"mujoco_plant": errors}, urdf=urdf_of("jackal"))
        half_base = loop.robot["effective_wheel_base"] / 2
        loop.run(1.0, (0.0, 0.0))
        cycles = round(0.05 / loop.period)
        log = loop.run(1.5, command)
        turn = np.convolve(log["truth_angular"], np.full(cycles, 1 / cycles), mode="valid")
        assert half_base * (turn.max() - command[1]) < 0.024
        assert turn[: round(0.5 / loop.period)].max() > 0.8 * command[1]
