"""Checks the law of calibrate.py against closed forms and against itself."""

import math

import numpy as np
import pytest
from robot_control.robot.pose import arcs_between
from robot_control.setup.calibrate.law import (
    NotCalibratedError,
    Square,
    Straight,
    Truth,
    Wheels,
    fit,
    largest_mean_return_error,
    of_axle,
    replay,
    return_errors,
    sides,
    umbmark,
)
from support.recordings.square_path import square_path

WHEELS = Wheels(0.5)
TRUE = Truth(scale=1.008, ratio=1.004 / 1.012, base=1.02)  # left +1.2 %, right +0.4 %, base +2 %
ROUNDING = 1e-12


def line(length, count=50):
    return np.column_stack([np.linspace(0, length, count), np.zeros(count), np.zeros(count)])


def driven(truth, side=4.0, wheels=WHEELS, per_metre=100):
    """One square each way as a robot with the wheels `truth` drives it by its odometry."""
    squares = []
    for clockwise in (True, False):
        path = square_path(side, clockwise=clockwise, per_metre=per_metre)
        x, y = replay(path, wheels, truth)[-1, :2]
        squares.append(Square(path, (x, y), clockwise))
    return squares


def test_sides_keep_the_mean_and_have_the_ratio():
    left, right = sides(1.03)
    assert left + right == pytest.approx(2, abs=ROUNDING)
    assert right / left == pytest.approx(1.03, abs=ROUNDING)


def test_exact_wheels_replay_the_path_itself():
    for clockwise in (True, False):
        path = square_path(4, clockwise=clockwise)
        # not to rounding: that of the sums over 1800 steps of 1 cm
        np.testing.assert_allclose(replay(path, WHEELS, Truth())[:, :2], path[:, :2], atol=1e-11)


def test_a_straight_line_becomes_the_arc_of_unequal_wheels():
    """Left 1 % larger, right 1 % smaller over the base b: a radius of b/2·(l + r)/(r − l) = −25 m; in closed form."""
    ratio = 0.99 / 1.01
    radius = 0.5 / 2 * (1.01 + 0.99) / (0.99 - 1.01)
    angle = 5.0 / radius
    end = replay(line(5.0), WHEELS, Truth(ratio=ratio))[-1]
    np.testing.assert_allclose(end, [radius * math.sin(angle), radius * (1 - math.cos(angle)), angle], atol=ROUNDING)


def test_a_turn_on_the_spot_turns_by_scale_over_base():
    path = np.column_stack([np.zeros(100), np.zeros(100), np.linspace(0, 3.0, 100)])
    end = replay(path, WHEELS, Truth(scale=1.01, base=1.02))[-1]
    np.testing.assert_allclose(end, [0, 0, 3.0 * 1.01 / 1.02], atol=ROUNDING)


def test_steps_are_arcs_and_know_backwards_and_full_turns():
    quarter = np.array([[0, 0, math.pi - 0.1], [0, 0, -math.pi + 0.1]])
    advance, turn = arcs_between(*quarter.T)
    assert turn[0] == pytest.approx(0.2, abs=ROUNDING)
    assert advance[0] == pytest.approx(0, abs=ROUNDING)
    arc = np.array([[0, 0, 0], [math.sin(1.0), 1 - math.cos(1.0), 1.0]])  # of radius 1
    assert arcs_between(*arc.T)[0][0] == pytest.approx(1.0, abs=ROUNDING)
    assert arcs_between(*line(-2.0, 2).T)[0][0] == pytest.approx(-2.0, abs=ROUNDING)


def test_the_axle_of_a_frame_ahead_of_it_turns_about_itself():
    """The frame lies 0.2 m ahead of the axle: turning on the spot moves the frame, not the axle."""
    angle = np.linspace(0, 2, 40)
    frame = np.column_stack([0.2 * np.cos(angle), 0.2 * np.sin(angle), angle])
    np.testing.assert_allclose(of_axle(frame, (-0.2, 0.0))[:, :2], 0, atol=ROUNDING)


def test_finds_hidden_radii_and_base_exactly():
    straight = Straight(line(5.0), float(np.linalg.norm(replay(line(5.0), WHEELS, TRUE)[-1, :2])))
    found = fit([straight], driven(TRUE), WHEELS)
    assert (found.scale, found.ratio, found.base) == pytest.approx((TRUE.scale, TRUE.ratio, TRUE.base), abs=1e-9)


def test_finds_them_on_a_frame_beside_the_axle():
    wheels = Wheels(0.4, (-0.15, 0.03))
    squares = []
    for clockwise in (True, False):
        path = of_axle(square_path(3, clockwise=clockwise), (0.15, -0.03))  # where the frame goes
        squares.append(Square(path, tuple(replay(path, wheels, TRUE)[-1, :2]), clockwise))
    length = float(np.linalg.norm(replay(line(3.0), Wheels(0.4), TRUE)[-1, :2]))
    found = fit([Straight(of_axle(line(3.0), (0.15, -0.03)), length)], squares, wheels)
    assert (found.scale, found.ratio, found.base) == pytest.approx((TRUE.scale, TRUE.ratio, TRUE.base), abs=1e-9)


def test_squares_alone_see_the_base_over_the_radius():
    found = fit([], driven(TRUE), WHEELS)
    assert found.scale == 1
    assert found.scale_deviation == 0
    # The square is scaled with the radius, and with it its return by 0.8 % of 1 m: a little of that is taken for base.
    assert found.base == pytest.approx(TRUE.base / TRUE.scale, abs=1e-3)
    assert found.ratio == pytest.approx(TRUE.ratio, abs=1e-4)


def test_straight_drives_alone_leave_ratio_and_base():
    found = fit([Straight(line(2.0), 2.02), Straight(line(2.0), 2.04)], [], WHEELS)
    assert found.scale == pytest.approx(1.015, abs=1e-9)
    assert (found.ratio, found.base, found.ratio_deviation, found.base_deviation) == (1, 1, 0, 0)


def test_deviations_are_those_of_many_readings_of_a_tape():
    """A tape of 3 mm measures 100 robots: the spread equals the deviation, within three times its own 1/√200."""
    random = np.random.default_rng(0)
    length = float(np.linalg.norm(replay(line(3.0), WHEELS, TRUE)[-1, :2]))
    exact = driven(TRUE, per_metre=10)
    found = []
    for _ in range(100):
        straights = [Straight(line(3.0), length + 0.003 * random.standard_normal()) for _ in range(2)]
        squares = [
            Square(square.path, tuple(np.array(square.measured) + 0.003 * random.standard_normal(2)), square.clockwise)
            for square in exact
            for _ in range(2)
        ]
        found.append(fit(straights, squares, WHEELS))
    for name in ("scale", "ratio", "base"):
        spread = np.std([getattr(one, name) for one in found])
        reported = np.mean([getattr(one, f"{name}_deviation") for one in found])
        assert reported == pytest.approx(spread, rel=0.22), name
        assert np.mean([getattr(one, name) for one in found]) == pytest.approx(getattr(TRUE, name), abs=spread * 0.4)


def test_the_authors_formulas_agree_for_small_errors():
    """They leave out products of angles: a side turns by 8 mrad here, four by 32, which bounds their error."""
    small = Truth(ratio=1.001, base=1.001)
    errors = return_errors(driven(small), WHEELS, Truth())
    classic = umbmark(errors[:1], errors[1:], 4.0, 0.5)
    assert classic.ratio - 1 == pytest.approx(0.001, rel=0.032)
    assert classic.base - 1 == pytest.approx(0.001, rel=0.032)


def test_the_authors_formulas_in_closed_form():
    """α = 0.02, β = 0.01 on a side of 2 m: returns as the header derives them."""
    together, apart = -2 * 2 * 0.03, -2 * 2 * 0.01
    classic = umbmark(np.array([[together, together]]), np.array([[apart, -apart]]), 2.0, 0.5)
    assert (classic.alpha, classic.beta) == pytest.approx((0.02, 0.01), abs=ROUNDING)
    radius = 1.0 / math.sin(0.005)
    assert classic.ratio == pytest.approx((radius + 0.25) / (radius - 0.25), abs=ROUNDING)
    assert classic.base == pytest.approx(90 / (90 - math.degrees(0.02)), abs=ROUNDING)
    assert umbmark(np.zeros((1, 2)), np.zeros((1, 2)), 2.0, 0.5).ratio == 1


def test_largest_mean_return_error_is_that_of_the_worse_direction():
    path = square_path(4, clockwise=True)
    squares = [Square(path, (0.1, 0.0), clockwise=True), Square(path, (-0.1, 0.2), clockwise=True)]
    squares += [Square(path, (0.0, 0.05), clockwise=False)]
    assert largest_mean_return_error(squares, WHEELS, Truth()) == pytest.approx(0.1, abs=1e-10)


def test_refuses_one_direction_nothing_and_nonsense():
    squares = driven(TRUE)
    with pytest.raises(NotCalibratedError, match="both ways"):
        fit([], squares[:1], WHEELS)
    with pytest.raises(NotCalibratedError, match="nothing was measured"):
        fit([], [], WHEELS)
    far = [Square(square.path, (400.0, -300.0), square.clockwise) for square in squares]
    with pytest.raises(NotCalibratedError, match="signs"):
        fit([], far, WHEELS)
