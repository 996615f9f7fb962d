"""Each test breaks one thing in a healthy run; the verdict must say so."""

import math

import numpy as np
import pytest
from robot_control.data.demo.tracking import (
    EXCUSED_CYCLES,
    ON_LEGS,
    SETTLE,
    NotSteadyError,
    commanded_path,
    judge,
    steady_rows,
)
from robot_control.loop.signal_names import mask_of
from support.recordings.synthetic_run import (
    ANGULAR,
    BEGIN,
    END,
    LINEAR,
    PERIOD,
    RAMP,
    brake_at,
    healthy_run,
    with_truth,
)

MIDDLE = 4000  # a cycle in the steady part


@pytest.fixture
def run():
    return healthy_run()


def verdict(log):
    return judge(log, LINEAR, ANGULAR)


def failed(log):
    return {check.name for check in verdict(log).checks if not check.passed}


def test_a_healthy_run_passes(run):
    assert verdict(run).passed


def test_the_steady_part_begins_after_ramp_and_settling_and_ends_with_the_command(run):
    rows = steady_rows(run, LINEAR, ANGULAR)
    assert rows.start == pytest.approx(BEGIN + (RAMP + SETTLE) / PERIOD, abs=1)
    assert rows.stop == END


def test_a_command_that_the_log_has_rounded_is_the_one_that_was_sent(run):
    """The outputs of a law are float32 there, and 0.2 is none of these numbers."""
    for name in ("limited_linear", "limited_angular"):
        run[name] = run[name].astype(np.float32).astype(float)
    rows = steady_rows(run, LINEAR, ANGULAR)
    assert rows.start == pytest.approx(BEGIN + (RAMP + SETTLE) / PERIOD, abs=1)
    run["limited_angular"] *= 1 + 1e-6
    with pytest.raises(NotSteadyError):
        steady_rows(run, LINEAR, ANGULAR)


def test_a_robot_that_never_moves_fails(run):
    still = np.zeros_like(run["time"])
    tracking = verdict(with_truth(run, still, still))
    assert [check.passed for check in tracking.checks] == [False] * 5  # nor can 0 m be a distance to compare with


def test_a_robot_two_percent_slow_fails_on_the_mean_alone(run):
    slow = with_truth(run, 0.98 * run["truth_linear"], 0.98 * run["truth_angular"])
    assert failed(slow) == {"mean true linear speed", "mean true angular speed"}


def test_a_body_on_legs_that_sways_within_each_step_is_judged_by_its_mean(run):
    sway = 0.1 * np.sin(2 * np.pi * run["time"] / 0.19)
    swaying = with_truth(run, run["truth_linear"] + sway, run["truth_angular"] + sway)
    assert judge(swaying, LINEAR, ANGULAR, ON_LEGS).passed
    assert not verdict(swaying).passed
    slow = with_truth(swaying, 0.96 * swaying["truth_linear"], swaying["truth_angular"])
    assert [check.name for check in judge(slow, LINEAR, ANGULAR, ON_LEGS).checks if not check.passed] == [
        "mean true linear speed"
    ]


def test_a_robot_half_a_percent_slow_passes(run):
    assert verdict(with_truth(run, 0.995 * run["truth_linear"], 0.995 * run["truth_angular"])).passed


@pytest.mark.parametrize("component", ["linear", "angular"])
def test_a_robot_that_drives_backwards_fails(run, component):
    run[f"truth_{component}"] *= -1
    assert f"mean true {component} speed" in failed(run)


@pytest.mark.parametrize("component", ["linear", "angular"])
def test_one_cycle_six_percent_off_fails(run, component):
    run[f"truth_{component}"][MIDDLE] *= 1.06
    assert failed(run) == {f"worst steady cycle, {component}"}


def test_one_cycle_four_percent_off_passes(run):
    run["truth_linear"][MIDDLE] *= 0.96
    assert verdict(run).passed


@pytest.mark.parametrize("after", [0, EXCUSED_CYCLES])
def test_a_deviation_right_after_a_counted_brake_is_excused(run, after):
    brake_at(run, MIDDLE)
    run["truth_linear"][MIDDLE + after] *= 0.8
    assert verdict(run).passed
    assert verdict(run).excused_cycles == EXCUSED_CYCLES + 1


@pytest.mark.parametrize("after", [-1, EXCUSED_CYCLES + 1])
def test_a_deviation_before_or_long_after_a_brake_is_not_excused(run, after):
    brake_at(run, MIDDLE)
    run["truth_linear"][MIDDLE + after] *= 0.8
    assert failed(run) == {"worst steady cycle, linear"}


def test_a_brake_that_the_monitor_ordered_excuses_nothing(run):
    brake_at(run, MIDDLE, reasons=mask_of("GateReason", "permit_brake"))
    run["truth_linear"][MIDDLE + 1] *= 0.8
    assert failed(run) == {"worst steady cycle, linear"}


def test_a_robot_braked_half_of_the_time_fails_although_each_cycle_is_excused(run):
    for cycle in range(BEGIN, END, 50):
        brake_at(run, cycle)
    assert "mean true linear speed" in failed(with_truth(run, 0.5 * run["truth_linear"], run["truth_angular"]))


def test_a_stop_in_the_middle_fails(run):
    stopped = np.where(run["cycle"] > MIDDLE, 0.0, 1.0)
    run["limited_linear"] *= stopped
    run["limited_angular"] *= stopped
    assert not verdict(with_truth(run, run["truth_linear"] * stopped, run["truth_angular"] * stopped)).passed


def test_an_estimate_two_percent_of_the_distance_off_fails(run):
    run["estimate_x"] *= 1.0
    run["estimate_y"] += 0.02 * LINEAR * (END - BEGIN) * PERIOD
    assert failed(run) == {"estimated pose, of the distance"}


def test_nan_in_the_truth_never_passes(run):
    run["truth_linear"][MIDDLE] = np.nan
    assert "mean true linear speed" in failed(run)


def test_a_log_without_truth_is_not_judged(run):
    run["truth_x"][:] = np.nan
    with pytest.raises(NotSteadyError, match="steady cycles are in the log"):
        verdict(run)


def test_a_log_with_lost_rows_is_not_judged(run):
    kept = (run["cycle"] < MIDDLE) | (run["cycle"] > MIDDLE + 500)
    with pytest.raises(NotSteadyError, match="steady cycles are in the log"):
        verdict({name: values[kept] for name, values in run.items()})


def test_a_command_that_never_arrived_is_not_judged(run):
    run["requested_linear"][:] = 0
    with pytest.raises(NotSteadyError, match="never received"):
        verdict(run)


def test_a_command_that_was_never_let_through_is_not_judged(run):
    run["limited_linear"] *= 0.9
    with pytest.raises(NotSteadyError, match="never reached"):
        verdict(run)


def test_a_command_let_through_seconds_late_is_not_judged(run):
    run["limited_linear"][: BEGIN + 2500] = 0
    with pytest.raises(NotSteadyError, match="not within 2 s"):
        verdict(run)


def test_gaps_in_the_request_belong_to_the_steady_part(run):
    run["requested_linear"][MIDDLE : MIDDLE + 100] = 0
    assert steady_rows(run, LINEAR, ANGULAR).stop == END


def test_the_commanded_path_is_an_exact_arc():
    n = 5001
    log = {"time": np.arange(n) * PERIOD, "limited_linear": np.full(n, 0.5), "limited_angular": np.full(n, 0.2)}
    x, y, yaw = commanded_path(log)
    radius, turn = 0.5 / 0.2, 0.2 * 5.0
    # 5001 roundings of about 2.5 m each: 1e-12.
    assert x[-1] == pytest.approx(radius * math.sin(turn), abs=1e-11)
    assert y[-1] == pytest.approx(radius * (1 - math.cos(turn)), abs=1e-11)
    assert yaw[-1] == pytest.approx(turn, abs=1e-11)


def test_a_command_without_turning_cannot_be_judged(run):
    with pytest.raises(ValueError, match="neither component may be zero"):
        judge(run, LINEAR, 0.0)
