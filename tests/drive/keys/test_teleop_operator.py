"""From keys to commands, in virtual time."""

import pytest
from robot_control.drive.keys.key_map import ARROWS, CLASSIC, KEY_MAPS
from robot_control.drive.keys.keyboard import Event, Key
from robot_control.drive.keys.operator import RESET_PAUSE, RESET_WINDOW, ZEROS, Limits, Operator, Request
from robot_control.robot.command import Command

LINEAR, ANGULAR = 0.4, 0.8
CHOSEN, LIMITS = Command(LINEAR, ANGULAR), Limits(1.0, 2.0, reverse=1.0)


@pytest.fixture
def operator():
    operator = Operator(ARROWS, CHOSEN, LIMITS)
    operator.permit(True, 0.0)
    return operator


def hold(operator, key, begin, seconds):
    """Types the bytes of a held key; returns the time of the last one."""
    times = [begin, *(begin + 0.5 + 0.03 * number for number in range(round((seconds - 0.5) / 0.03) + 1))]
    for time in times:
        operator.key(Key(key), time)
    return times[-1]


def test_a_held_key_commands_half_and_then_all_of_the_chosen_speed(operator):
    operator.key(Key("w"), 1.0)
    assert operator.command(1.0) == Command(LINEAR / 2, 0.0)
    last = hold(operator, "w", 2.0, 2.0)
    assert operator.command(last) == Command(LINEAR, 0.0)


@pytest.mark.parametrize(("keys", "key", "signs"), [
    (ARROWS, "up", (1, 0)), (ARROWS, "s", (-1, 0)), (ARROWS, "left", (0, 1)), (ARROWS, "d", (0, -1)),
    (ARROWS, "q", (1, 1)), (ARROWS, "z", (-1, -1)),
    (CLASSIC, "i", (1, 0)), (CLASSIC, ",", (-1, 0)), (CLASSIC, "j", (0, 1)), (CLASSIC, "m", (-1, -1)),
])  # fmt: skip
def test_forward_is_positive_and_left_is_positive(keys, key, signs):
    operator = Operator(keys, CHOSEN, LIMITS)
    last = hold(operator, key, 0.0, 2.0)
    assert operator.command(last) == Command(signs[0] * LINEAR, signs[1] * ANGULAR)


@pytest.mark.parametrize(("keys", "key", "sign"), [(ARROWS, "j", 1), (ARROWS, "l", -1), (CLASSIC, "a", 1)])
def test_a_robot_on_legs_moves_sideways_within_its_limit(keys, key, sign):
    operator = Operator(keys, Command(LINEAR, ANGULAR, 0.9), Limits(1.0, 2.0, reverse=1.0, lateral=0.5))
    last = hold(operator, key, 0.0, 2.0)
    assert operator.command(last) == Command(0.0, 0.0, sign * 0.5)
    assert operator.message(last) == ""


def test_on_wheels_a_key_for_sideways_says_why_nothing_happens(operator):
    last = hold(operator, "j", 0.0, 2.0)
    assert operator.command(last) == Command()
    assert operator.message(last) == "key j has no effect: this robot has wheels and does not move sideways"


def test_the_speed_sideways_changes_with_the_linear_one_also_before_the_kind_is_known():
    operator = Operator(ARROWS, Command(LINEAR, ANGULAR, 0.3), LIMITS)
    operator.key(Key("+"), 0.0)
    operator.limit(Limits(1.0, 2.0, reverse=1.0, lateral=0.5))
    assert operator.chosen.linear == pytest.approx(1.1 * LINEAR)
    assert operator.chosen.lateral == pytest.approx(1.1 * 0.3)


def test_after_a_release_zeros_follow_and_then_nothing_so_that_others_may_command(operator):
    last = hold(operator, "w", 0.0, 2.0)
    operator.command(last)
    operator.key(Key("w", Event.RELEASE), last)
    assert operator.command(last + ZEROS - 0.01) == Command()
    assert operator.command(last + ZEROS) is None


@pytest.mark.parametrize("name", KEY_MAPS)
def test_space_stops_at_once(name):
    operator = Operator(KEY_MAPS[name], CHOSEN, LIMITS)
    last = hold(operator, next(iter(KEY_MAPS[name].motions)), 0.0, 2.0)
    assert operator.key(Key("space"), last + 0.02) is None
    assert operator.command(last + 0.02) == Command()


@pytest.mark.parametrize("key", ["escape", "!"])
def test_the_e_stop_ends_motion_and_no_key_moves_the_robot_until_a_reset(operator, key):
    last = hold(operator, "w", 0.0, 2.0)
    assert operator.key(Key(key), last + 0.01) is Request.E_STOP
    assert operator.command(last + 0.01) == Command()
    last = hold(operator, "a", 10.0, 2.0)
    assert operator.command(last) == Command()
    assert "EMERGENCY STOP" in operator.message(last)
    operator.reset_accepted()
    last = hold(operator, "a", 20.0, 2.0)
    assert operator.command(last) == Command(0.0, ANGULAR)


def test_a_reset_of_somebody_else_ends_the_block_too(operator):
    operator.key(Key("!"), 1.0)
    operator.permit(False, 1.1)
    operator.permit(True, 5.0)
    operator.key(Key("w"), 6.0)
    assert operator.command(6.0) == Command(LINEAR / 2, 0.0)


def test_a_reset_takes_two_steps_within_its_window(operator):
    assert operator.key(Key("y"), 0.0) is None
    assert operator.key(Key("r"), 1.0) is None
    assert "reset?" in operator.message(1.0)
    assert operator.key(Key("y"), 1.0 + RESET_WINDOW) is None
    operator.key(Key("r"), 10.0)
    assert operator.key(Key("y"), 10.0 + RESET_WINDOW - 0.01) is Request.RESET
    assert operator.key(Key("y"), 10.0 + RESET_WINDOW - 0.01) is None


def test_both_keys_of_a_reset_at_once_are_none_and_leave_the_question(operator):
    operator.key(Key("r"), 1.0)
    assert operator.key(Key("y"), 1.0) is None
    assert operator.key(Key("y"), 1.0 + RESET_PAUSE - 0.01) is None
    assert operator.key(Key("y"), 1.0 + RESET_PAUSE + 0.01) is Request.RESET


def test_a_motion_key_cancels_a_reset(operator):
    operator.key(Key("r"), 1.0)
    operator.key(Key("w"), 1.2)
    assert operator.key(Key("y"), 1.4) is None


def test_a_robot_that_stopped_does_not_go_on_under_the_key_that_was_held(operator):
    last = hold(operator, "w", 0.0, 2.0)
    operator.permit(False, last + 0.01)
    assert operator.command(last + 0.01) == Command()
    for number in range(1, 100):
        operator.key(Key("w"), last + 0.03 * number)
    last += 0.03 * 99
    operator.permit(True, last)
    operator.key(Key("w"), last + 0.03)
    assert operator.command(last + 0.03) is None or operator.command(last + 0.03) == Command()
    assert "release it" in operator.message(last + 0.03)
    operator.key(Key("w"), last + 1.0)
    assert operator.command(last + 1.0) == Command(LINEAR / 2, 0.0)


def test_a_silent_monitor_does_not_keep_commands_back():
    operator = Operator(ARROWS, CHOSEN, LIMITS)
    operator.permit(None, 0.0)
    operator.key(Key("w"), 0.0)
    assert operator.command(0.0) == Command(LINEAR / 2, 0.0)


def test_what_was_typed_while_the_program_stood_moves_nothing_and_may_stop(operator):
    operator.key(Key("w"), 1.0, late=True)
    assert operator.command(1.0) is None
    last = hold(operator, "w", 2.0, 2.0)
    operator.key(Key("space"), last, late=True)
    assert operator.command(last) == Command()
    assert operator.key(Key("!"), last, late=True) is Request.E_STOP


def test_speeds_change_by_a_tenth(operator):
    operator.key(Key("+"), 0.0)
    operator.key(Key(","), 0.0)
    assert operator.chosen == Command(pytest.approx(1.1 * LINEAR), pytest.approx(0.9 * ANGULAR))


@pytest.mark.parametrize(("keys", "key"), [(ARROWS, "+"), (CLASSIC, "w")])
def test_the_first_byte_after_a_held_speed_key_commands_no_more_than_half_of_what_the_robot_drives(keys, key):
    operator = Operator(keys, Command(0.9 * LIMITS.linear, ANGULAR), LIMITS)
    hold(operator, key, 0.0, 2.0)
    operator.key(Key("up" if keys is ARROWS else "i"), 3.0)
    assert operator.command(3.0).linear <= LIMITS.linear / 2


def test_a_speed_key_that_is_held_changes_the_speed_once(operator):
    for time in (0.0, *(0.5 + 0.03 * number for number in range(50))):
        operator.key(Key("+"), time)
        operator.command(time + 0.01)
    operator.command(9.0)
    assert operator.chosen.linear == pytest.approx(1.1 * LINEAR)


def test_every_tap_of_a_speed_key_changes_the_speed(operator):
    for number in range(5):
        operator.key(Key("+"), 0.25 * number)
    operator.command(2.0)
    assert operator.chosen.linear == pytest.approx(1.1**5 * LINEAR)


def test_chosen_speeds_have_the_robots_limits_as_a_bound_also_when_those_change(operator):
    for number in range(200):
        operator.key(Key("+"), float(number))
        operator.key(Key("."), number + 0.5)
    assert operator.chosen == Command(LIMITS.linear, LIMITS.angular)
    operator.limit(Limits(0.2, 0.3, reverse=0.2))
    assert operator.chosen == Command(0.2, 0.3)
    operator.key(Key("-"), 300.0)
    assert operator.chosen == Command(pytest.approx(0.9 * 0.2), 0.3)


def test_a_speed_of_the_command_line_above_the_limits_of_the_file_counts_once_the_robots_are_received():
    operator = Operator(ARROWS, Command(1.5, 1.0), LIMITS)
    assert operator.chosen == Command(LIMITS.linear, 1.0)
    operator.limit(Limits(2.0, 2.0, reverse=2.0))
    assert operator.chosen == Command(1.5, 1.0)


@pytest.mark.parametrize(("key", "turn"), [("s", 0.0), ("z", -ANGULAR)])
def test_backwards_the_robots_limit_of_reverse_is_a_bound_and_a_first_press_half_of_it(operator, key, turn):
    operator.limit(Limits(1.0, 2.0, reverse=0.1))
    operator.key(Key(key), 0.0)
    assert operator.command(0.0) == Command(-0.05, turn / 2)
    assert operator.command(hold(operator, key, 1.0, 2.0)) == Command(-0.1, turn)
    assert operator.command(hold(operator, "w", 4.0, 2.0)) == Command(LINEAR, 0.0)


@pytest.mark.parametrize(("keys", "first", "second"), [(ARROWS, "w", "up"), (ARROWS, "left", "a")])
def test_two_keys_of_one_motion_in_turn_are_held_no_longer_than_one(keys, first, second):
    operator = Operator(keys, CHOSEN, LIMITS)
    zeros = [0.0]
    for number in range(1200):
        time = 0.1 * number
        operator.key(Key((first, second)[number % 2]), time)
        if operator.command(time) in {Command(), None}:
            zeros.append(time)
    assert 29.9 < zeros[1] < 30.1
    assert zeros[-1] > 119.0


def test_a_key_that_is_held_too_long_is_announced_and_explained(operator):
    hold(operator, "w", 0.0, 26.0)
    assert "stops in 4 s" in operator.message(26.1)
    for number in range(200):
        operator.key(Key("w"), 26.13 + 0.03 * number)
    assert operator.message(32.2).startswith("stopped: the key was held too long")


def test_ctrl_c_ends(operator):
    assert operator.key(Key("interrupt"), 0.0) is Request.END
