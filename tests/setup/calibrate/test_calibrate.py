"""calibrate.py without a robot: command line, plausibility, table and YAML."""

import numpy as np
import pytest
import yaml
from robot_control import ClosedLoop
from robot_control.setup.calibrate.evaluation import (
    evaluate,
    implausible_distance,
    implausible_return,
    parse_options,
    place,
    space,
    wheels_of,
)
from robot_control.setup.calibrate.law import NotCalibratedError, Square, Straight, Truth, replay
from support.recordings.square_path import square_path

TRUE = Truth(scale=1.008, ratio=1.004 / 1.012, base=1.02)


@pytest.fixture(scope="module")
def robot():
    return ClosedLoop().robot


def squares(wheels, truth=TRUE, side=4.0, noise=0.0):
    found = []
    for clockwise in (True, False):
        path = square_path(side, clockwise=clockwise)
        end, apart = replay(path, wheels, truth)[-1, :2], np.array([noise, 0.0])
        found += [Square(path, tuple(end + apart), clockwise), Square(path, tuple(end - apart), clockwise)]
    return found


def line(wheels, truth=TRUE):
    path = np.column_stack([np.linspace(0, 3, 100), np.zeros(100), np.zeros(100)])
    return Straight(path, float(np.linalg.norm(replay(path, wheels, truth)[-1, :2])))


def test_writes_parameters_that_the_loop_takes_and_says_before_and_after(robot):
    wheels = wheels_of(robot)
    outcome = evaluate(robot, [line(wheels)], squares(wheels), 4.0)
    overlay = yaml.safe_load(outcome.yaml)
    assert overlay["robot"]["wheel_radius"] == pytest.approx(0.1 * 1.008, rel=1e-6)
    assert overlay["robot"]["wheel_base"] == pytest.approx(0.5 * 1.02, rel=1e-6)
    assert overlay["state_estimator"]["radius_ratio"] == pytest.approx(TRUE.ratio, rel=1e-6)
    assert overlay["state_estimator"]["wheel_base_factor"] == 1.0
    assert 0 < overlay["state_estimator"]["radius_ratio_deviation"] < 0.001
    assert overlay["state_estimator"]["wheel_base_deviation"] == pytest.approx(0.003)
    loop = ClosedLoop(overlay)
    assert loop.robot["wheels"][0]["radius"] == pytest.approx(0.1008)
    for word in ("nominal", "measured", "largest mean return error", "mm after", "E_d", "3.000 m by wheels before"):
        assert word in outcome.table, word
    assert not outcome.warnings


def test_a_second_calibration_starts_from_the_first(robot):
    """A value that is relative to a nominal radius comes out absolute."""
    nominal = ClosedLoop({"robot": {"wheel_radius": 0.1008, "wheel_base": 0.51}}).robot
    wheels = wheels_of(nominal)
    truth = Truth(ratio=TRUE.ratio)
    overlay = yaml.safe_load(evaluate(nominal, [line(wheels, truth)], squares(wheels, truth), 4.0).yaml)
    assert overlay["robot"]["wheel_radius"] == pytest.approx(0.1008, rel=1e-6)
    assert overlay["robot"]["wheel_base"] == pytest.approx(0.51, rel=1e-6)
    assert overlay["state_estimator"]["radius_ratio"] == pytest.approx(TRUE.ratio, rel=1e-6)


def test_a_skid_steer_gets_a_multiplier(robot):
    four = {**robot, "wheels": [*robot["wheels"], *robot["wheels"]], "wheel_base_multiplier": 1.5}
    four["effective_wheel_base"] = 0.75
    wheels = wheels_of(four)
    overlay = yaml.safe_load(evaluate(four, [line(wheels)], squares(wheels), 4.0).yaml)
    assert "wheel_base" not in overlay["robot"]
    assert overlay["robot"]["wheel_base_multiplier"] == pytest.approx(1.5 * 1.02, rel=1e-6)


def test_half_a_measurement_writes_half_and_says_so(robot):
    wheels = wheels_of(robot)
    straight = evaluate(robot, [line(wheels)], [], 4.0)
    assert list(yaml.safe_load(straight.yaml)) == ["robot"]
    assert list(yaml.safe_load(straight.yaml)["robot"]) == ["wheel_radius"]
    assert "no squares" in straight.warnings[0]
    square = evaluate(robot, [], squares(wheels), 4.0)
    assert list(yaml.safe_load(square.yaml)["robot"]) == ["wheel_base"]
    assert "common radius" in square.warnings[0]


def test_refuses_what_is_no_robot(robot):
    wheels = wheels_of(robot)
    with pytest.raises(NotCalibratedError, match=r"ratio of the radii would be 1\.0[56]"):
        evaluate(robot, [line(wheels)], squares(wheels, Truth(ratio=1.06)), 4.0)
    with pytest.raises(NotCalibratedError, match=r"wheel base would be|no wheels explain"):
        evaluate(robot, [line(wheels)], squares(wheels, Truth(base=0.65)), 4.0)


def test_warns_of_a_square_that_slipped(robot):
    wheels = wheels_of(robot)
    outcome = evaluate(robot, [line(wheels)], squares(wheels, Truth(ratio=1.0005), noise=0.2), 4.0)
    assert any("200 mm from the mean" in sentence for sentence in outcome.warnings)


def test_accepts_no_answer_in_other_units():
    assert implausible_distance(3.02, 3.0) == ""
    assert "metres" in implausible_distance(302.0, 3.0)
    assert implausible_return((0.3, -0.4), 4.0) == ""
    assert "metres" in implausible_return((30.0, -40.0), 4.0)


def test_reads_a_place_and_refuses_what_is_none():
    assert place("0.1, -0.2") == (0.1, -0.2)
    assert place("0.1 -0.2") == (0.1, -0.2)
    for text in ("", "1", "1,2,3", "a,b", "nan,0", "inf 0"):
        with pytest.raises(ValueError):
            place(text)


def test_says_how_much_space_it_needs():
    assert "3.875 m ahead" in space(parse_options([]))
    assert "from 1 m behind it to 5 m ahead, and 5 m to either side" in space(parse_options([]))
    assert "square" not in space(parse_options(["--side=0"]))
    assert "no command is sent" in space(parse_options(["--manual"]))


@pytest.mark.parametrize(
    "arguments",
    [["--distance=0", "--side=0"], ["--side=0.2"], ["--distance=-1"], ["--runs=0"], ["--speed=nan"], ["--returned=1"]],
)
def test_refuses_a_wrong_command_line(arguments, capsys):
    with pytest.raises(SystemExit) as ended:
        parse_options(arguments)
    assert ended.value.code == 2
    assert "usage: calibrate.py" in capsys.readouterr().err
