"""Random fault sequences end at standstill, and their judge notices if they do not."""

import dataclasses

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.loop.signal_names import number_of
from simulation.corpus import ABSENT, FOLDER

from bench.faults.campaign import campaign, run_seed
from bench.faults.fault_sequence import ALL_RUNS, FaultSequence, draw_sequence, draw_walk
from bench.faults.random_drive import Leg
from bench.faults.sequence_judge import RULES, judge
from bench.faults.sequence_run import COLUMNS
from bench.robot_corpus import ICE, robot_names, stop_deceleration_of, urdf_of

PERIOD, WHEEL_BASE, FASTEST = 0.001, 0.5, 1.5  # s, m, m/s
STOPPED, READY = (number_of("SupervisorState", name) for name in ("STOPPED", "READY"))
BRAKE, PASSED = (number_of("GateVerdict", name) for name in ("brake", "passed"))
DRIVE = number_of("PermitAction", "drive")
DRIVEN = 1.0  # s


def expect_survived(step, least_stops):
    """Runs one seed in `step`; requires stops for `least_stops` different causes, so that enough is tested."""
    sample, lines = range(0, ALL_RUNS, step), []
    tally = campaign(sample, lines.append)
    assert tally.runs == len(sample)
    assert not tally.failed, "\n".join(lines)
    assert len(tally.stops) >= least_stops


def test_one_in_five_hundred_of_all_sequences_is_survived():
    expect_survived(500, 3)


@pytest.mark.nightly
def test_one_in_a_hundred_of_all_sequences_is_survived():
    expect_survived(100, 5)


def test_a_seed_is_the_same_sequence_each_time():
    robots = robot_names()
    assert draw_sequence(3, robots) == draw_sequence(3, robots) != draw_sequence(4, robots)


def test_a_seed_gives_the_same_outcome_each_time():
    assert run_seed(7, robot_names()) == run_seed(7, robot_names())


@pytest.fixture
def sequence():
    return FaultSequence(0, "diffbot", "flat", [Leg(0, 1, 0)], 0.1, DRIVEN, False, False)


@pytest.fixture
def log(sequence):
    """A log that drives at 1 m/s, ramps down at 1 m/s², and stands under the brake."""
    cycles = round(sequence.released / PERIOD)
    time = np.arange(cycles) * PERIOD
    log = {name: np.zeros(cycles) for name in COLUMNS}
    log["cycle"] = np.arange(cycles, dtype=float)
    log["truth_linear"] = np.clip(1.0 - (time - DRIVEN), 0.0, 1.0)
    log["requested_linear"] = np.where(time < DRIVEN, 1.0, 0.0)
    log["permit_action"][:] = DRIVE
    log["supervisor_state"][:] = READY
    log["gate_verdict"] = np.where(log["truth_linear"] > 0, PASSED, BRAKE).astype(float)
    log["gate_permit_cycle"] = np.maximum(log["cycle"] - 1, 0)
    log["gate_verdict"][0] = BRAKE
    return log


def rules_broken(sequence, log):
    return {violation.rule for violation in judge(sequence, log, WHEEL_BASE, PERIOD, FASTEST)}


def rows(first, end):
    """Rows from `first` to `end`, s."""
    return slice(round(first / PERIOD), round(end / PERIOD))


def test_a_healthy_drive_breaks_no_rule(sequence, log):
    assert rules_broken(sequence, log) == set()


def test_a_passed_command_under_a_brake_permit_is_noticed(sequence, log):
    log["permit_action"][500] = number_of("PermitAction", "brake")
    assert rules_broken(sequence, log) == {"permit"}


def test_a_passed_command_under_an_old_permit_is_noticed(sequence, log):
    log["gate_permit_cycle"][500] -= 4
    assert rules_broken(sequence, log) == {"permit"}


def test_a_robot_that_speeds_up_under_the_brake_is_noticed(sequence, log):
    log["gate_verdict"][rows(0.5, 0.8)] = BRAKE
    log["truth_linear"][rows(0.7, 0.8)] = 1.31
    assert rules_broken(sequence, log) == {"brake"}


def test_a_robot_that_goes_on_under_the_brake_is_noticed(sequence, log):
    log["truth_linear"][rows(1.0, 4.0)] = 1.0
    log["gate_verdict"][rows(1.0, 8.0)] = BRAKE
    assert rules_broken(sequence, log) == {"brake"}


def test_a_runaway_is_noticed(sequence, log):
    log["truth_linear"][500] = 1.5 * FASTEST + 0.71
    assert rules_broken(sequence, log) == {"speed"}


def test_a_robot_that_turns_too_fast_is_noticed(sequence, log):
    log["truth_angular"][500] = 12.0  # 3 m/s at the wheels, and 1 m/s of the drive
    assert rules_broken(sequence, log) == {"speed"}


def test_a_robot_that_creeps_at_the_end_is_noticed(sequence, log):
    log["truth_linear"][rows(sequence.rested - 0.4, sequence.rested)] = 0.011
    assert "rest" in rules_broken(sequence, log)


def test_a_wheel_that_comes_free_is_turned_by_the_integral_of_its_drive_alone_and_not_for_long(sequence, log):
    velocity = dataclasses.replace(sequence, wheel_command="velocity")
    log["left_wheel_joint_injected_motor"] = np.zeros_like(log["injected"])
    log["left_wheel_joint_injected_motor"][rows(1.5, 4.0)] = number_of("FaultKind", "stuck")
    log["truth_linear"][rows(4.0, 4.3)] = 0.1
    assert rules_broken(velocity, log) == set()
    assert rules_broken(sequence, log) == {"brake"}
    log["truth_linear"][rows(4.3, 5.2)] = 0.011
    assert rules_broken(velocity, log) == {"brake"}


def test_a_start_without_a_command_after_a_reset_is_noticed(sequence, log):
    reset = round(sequence.rested / PERIOD)
    log["supervisor_state"][reset - 1000 : reset] = STOPPED
    assert rules_broken(sequence, log) == set()
    log["gate_verdict"][reset + 100 :] = PASSED
    log["truth_linear"][reset + 100 :] = 0.011
    assert rules_broken(sequence, log) == {"release"}


def test_a_robot_on_legs_may_lie_down_by_its_brake_after_a_reset_and_then_rests(sequence, log):
    legs = dataclasses.replace(sequence, gait="trot")
    brakes = DRIVEN + 1.0
    log["supervisor_state"][round(brakes / PERIOD)] = STOPPED
    log["truth_linear"][rows(brakes + 0.1, brakes + 0.8)] = 0.3
    assert rules_broken(legs, log) == set()
    assert "release" in rules_broken(sequence, log)
    log["gate_verdict"][rows(brakes + 1.0, sequence.rested)] = PASSED
    log["truth_linear"][rows(brakes + 1.2, brakes + 1.6)] = 0.1
    assert rules_broken(legs, log) == {"release"}


def test_a_robot_on_legs_may_sway_on_an_intermittent_motor_while_it_stands_and_rests_under_its_brake(sequence, log):
    legs = dataclasses.replace(sequence, gait="trot")
    log["rear_right_knee_injected_motor"] = np.full_like(log["injected"], number_of("FaultKind", "intermittent"))
    last = rows(sequence.rested - 0.4, sequence.rested)
    log["truth_linear"][last] = 0.05
    log["gate_verdict"][last] = PASSED
    assert rules_broken(legs, log) == set()
    log["gate_verdict"][last] = BRAKE
    assert "rest" in rules_broken(legs, log)
    log["truth_linear"][last] = 0.15
    log["gate_verdict"][last] = PASSED
    assert "rest" in rules_broken(legs, log)


@pytest.mark.parametrize(("scene", "limit"), [("flat", 10), ("walls", 30)])
def test_a_lean_is_noticed(sequence, log, scene, limit):
    sequence = dataclasses.replace(sequence, scene=scene)
    log["truth_tilt"][500] = np.radians(limit - 0.1)
    assert rules_broken(sequence, log) == set()
    log["truth_tilt"][500] = np.radians(limit + 0.1)
    assert rules_broken(sequence, log) == {"tilt"}


def test_a_diverged_simulation_is_noticed(sequence, log):
    log["driver_state"][500] = number_of("DriverState", "fault")
    assert rules_broken(sequence, log) == {"machine"}


def test_a_robot_without_brakes_need_not_stand(sequence, log):
    log["left_wheel_joint_injected_motor"] = np.full_like(log["injected"], number_of("FaultKind", "off"))
    log["truth_linear"][rows(2.0, 7.0)] = 0.5
    assert rules_broken(sequence, log) == set()


# 0.05, 0.06 and 0.17 m/s² of the wheels' way: their inertia about the vertical is large for their wheel base.
@pytest.mark.skipif(FOLDER is None, reason=ABSENT)
@pytest.mark.parametrize("robot", ["create_2", "p3dx_mario", "boxer"])
def test_a_robot_that_spins_on_ice_slows_down_as_expected_of_it(robot):
    loop = ClosedLoop({"mujoco_plant": {"sensor_errors": "ideal", "ground_friction": ICE}}, urdf=urdf_of(robot))
    half_base = loop.robot["wheel_base"] / 2
    loop.run(5.0, (0.0, 1.0))
    loop.e_stop()
    rim = half_base * np.abs(loop.run(4.0, (0.0, 0.0))["truth_angular"])
    slowed = int(np.argmax(rim < 0.2 * rim[0]))
    measured = 0.8 * rim[0] / (slowed * loop.period)
    assert measured / 1.5 < stop_deceleration_of(robot) < measured


def test_every_rule_was_broken_above():
    assert set(RULES) == {"permit", "brake", "speed", "rest", "release", "tilt", "machine"}


def test_a_quadruped_that_walks_survives_its_sequences_too():
    lines = []
    tally = campaign(range(3), lines.append, robot="quadbot")
    assert tally.runs == 3
    assert not tally.failed, "\n".join(lines)
    assert draw_walk(0) == draw_walk(0) != draw_walk(1)
