"""Tests the dead-man switch of teleop.py in virtual time."""

import itertools

import pytest
from robot_control.drive.keys.dead_man import BURST, DeadMan, HoldParameters, RepeatDelay

PARAMETERS = HoldParameters()
DELAY, PERIOD = 0.5, 0.033  # s: a usual keyboard
SHORT = 1e-6  # s


def train(begin, seconds, delay=DELAY, period=PERIOD):
    """Times of the bytes of one key that is held for `seconds`."""
    times = [begin]
    while (following := times[-1] + (delay if len(times) == 1 else period)) < begin + seconds:
        times.append(following)
    return times


def press(dead_man, key, times):
    for time in times:
        dead_man.press(key, time)
    return times[-1]


def share(dead_man, now):
    held = dead_man.held(now)
    return 0.0 if held is None else held.share


@pytest.fixture
def dead_man():
    return DeadMan(PARAMETERS)


def test_nothing_is_held_before_a_key_came(dead_man):
    assert dead_man.held(0.0) is None


def test_the_first_byte_holds_slowly_for_first_hold(dead_man):
    dead_man.press("w", 1.0)
    assert share(dead_man, 1.0) == PARAMETERS.slow
    assert share(dead_man, 1.0 + PARAMETERS.first_hold - SHORT) == PARAMETERS.slow
    assert dead_man.held(1.0 + PARAMETERS.first_hold) is None


def test_from_the_first_repeat_on_it_drives_fast_and_each_byte_holds_for_hold(dead_man):
    last = press(dead_man, "w", train(0.0, 2.0))
    assert share(dead_man, last + PARAMETERS.hold - SHORT) == 1.0
    assert dead_man.held(last + PARAMETERS.hold) is None


def test_a_held_key_never_stutters(dead_man):
    times = train(0.0, 10.0)
    for begin, end in itertools.pairwise(times):
        dead_man.press("w", begin)
        assert dead_man.held(end - SHORT) is not None


def test_two_quick_taps_are_no_repeat(dead_man):
    press(dead_man, "w", [0.0, 0.1])
    assert share(dead_man, 0.1) == PARAMETERS.slow
    assert share(dead_man, 0.1 + PARAMETERS.first_hold - SHORT) == PARAMETERS.slow


def test_another_key_takes_over_without_a_gap_and_without_slowing_down(dead_man):
    last = press(dead_man, "w", train(0.0, 2.0))
    times = train(last + PERIOD, 2.0)
    for begin, end in itertools.pairwise(times):
        dead_man.press("a", begin)
        assert dead_man.held(end - SHORT).key == "a"
        assert share(dead_man, end - SHORT) == 1.0


@pytest.mark.parametrize("held_before", [True, False])
def test_a_burst_that_would_begin_a_motion_was_typed_before_its_link_stalled(dead_man, held_before):
    if held_before:
        press(dead_man, "w", train(0.0, 2.0))
    last = press(dead_man, "w", [4.0 + number * BURST / 2 for number in range(60)])
    assert dead_man.held(4.0 + BURST) is None
    assert dead_man.blocked(last)
    last = press(dead_man, "w", train(last + PERIOD, 1.0, delay=PERIOD))
    assert dead_man.held(last) is None, "it is held all the time"
    dead_man.press("w", last + PARAMETERS.first_hold + SHORT)
    assert dead_man.held(last + PARAMETERS.first_hold + SHORT) is not None


def test_a_burst_while_a_key_is_held_counts_as_one_byte(dead_man):
    last = press(dead_man, "w", train(0.0, 2.0))
    press(dead_man, "w", [last + PERIOD + number * BURST / 2 for number in range(5)])
    assert share(dead_man, last + PERIOD + PARAMETERS.hold - SHORT) == 1.0
    assert dead_man.held(last + PERIOD + PARAMETERS.hold) is None


def test_a_flood_holds_no_longer_than_its_first_byte(dead_man):
    for number in range(10_000):
        dead_man.press("w", number * 0.001)
    assert dead_man.held(10.0) is None


def test_after_a_stop_in_a_burst_its_motion_keys_do_not_count(dead_man):
    dead_man.press("w", 1.0)
    dead_man.stop(1.001)
    dead_man.press("w", 1.002)
    dead_man.press("a", 1.003)
    assert dead_man.held(1.01) is None
    dead_man.press("a", 1.1)
    assert dead_man.held(1.1).key == "a"


def test_a_stop_ends_the_hold_at_once(dead_man):
    last = press(dead_man, "w", train(0.0, 2.0))
    dead_man.stop(last + SHORT)
    assert dead_man.held(last + SHORT) is None


def test_a_release_ends_the_hold_at_once_and_that_of_another_key_does_not(dead_man):
    last = press(dead_man, "w", train(0.0, 2.0))
    dead_man.release("a")
    assert dead_man.held(last) is not None
    dead_man.release("w")
    assert dead_man.held(last) is None


def test_a_repeat_that_the_terminal_names_is_fast_at_once(dead_man):
    dead_man.press("w", 0.0)
    dead_man.press("w", 0.05, repeat=True)
    assert share(dead_man, 0.05) == 1.0


def test_max_hold_ends_in_zero_is_announced_and_needs_a_pause(dead_man):
    announced = []
    for time in train(0.0, 40.0):
        dead_man.press("w", time)
        held = dead_man.held(time)
        if held is not None and dead_man.ends_soon(held):
            announced.append(time)
        assert (held is None) == (time >= PARAMETERS.max_hold)
    assert announced[0] == pytest.approx(PARAMETERS.max_hold - PARAMETERS.announce, abs=PERIOD)
    press(dead_man, "w", train(40.0 + PARAMETERS.hold, 1.0))  # a pause shorter than first_hold is none
    assert dead_man.held(41.2) is None
    dead_man.press("w", 42.2)
    assert dead_man.held(42.2).key == "w"


def test_another_key_begins_another_max_hold(dead_man):
    last = press(dead_man, "w", train(0.0, 29.0))
    press(dead_man, "a", train(last + PERIOD, 20.0))
    assert dead_man.held(49.0).key == "a"


def test_another_key_of_the_same_motion_does_not_begin_another_max_hold():
    dead_man = DeadMan(PARAMETERS, {"w": "forward", "up": "forward", "a": "left"})
    times = [0.1 * number for number in range(1200)]
    held = []
    for key, time in zip(itertools.cycle(("w", "up")), times, strict=False):
        dead_man.press(key, time)
        held.append(dead_man.held(time) is not None)
    assert held == [time < PARAMETERS.max_hold for time in times]
    dead_man.press("a", times[-1] + 0.1)
    assert dead_man.held(times[-1] + 0.1).key == "a"


def test_what_was_held_when_the_robot_stopped_has_to_pause(dead_man):
    last = press(dead_man, "w", train(0.0, 2.0))
    dead_man.end(last)
    last = press(dead_man, "w", [last + PERIOD * number for number in range(1, 60)])
    assert dead_man.held(last) is None
    dead_man.press("w", last + PARAMETERS.first_hold + 0.01)
    assert dead_man.held(last + PARAMETERS.first_hold + 0.01).key == "w"


def test_a_stop_of_the_robot_long_after_the_last_key_blocks_nothing(dead_man):
    last = press(dead_man, "w", train(0.0, 2.0))
    dead_man.end(last + 5.0)
    dead_man.press("w", last + 5.1)
    assert dead_man.held(last + 5.1) is not None


@pytest.mark.parametrize("delay", [0.2, 0.25, 0.5, 0.66])
def test_first_hold_is_shortened_to_the_measured_delay(dead_man, delay):
    press(dead_man, "w", train(0.0, 2.0, delay))
    assert dead_man.first_hold == pytest.approx(min(PARAMETERS.first_hold, delay + 0.1))


def test_a_keyboard_that_became_slower_is_measured_again(dead_man):
    press(dead_man, "w", train(0.0, 2.0, 0.25))
    press(dead_man, "w", train(10.0, 2.0, 0.6))
    assert dead_man.first_hold == pytest.approx(PARAMETERS.first_hold)


@pytest.mark.parametrize(
    "times",
    [
        [0.0, 0.3, 0.6, 0.9, 1.2],  # taps
        [0.0, 0.1, 0.2, 0.3],  # quick taps: no delay in front
        [0.0, 0.033, 0.066, 0.366, 0.4, 0.43],  # a link that stalled within a train
        [0.0, 0.4, 0.43],  # too short a train
    ],
)
def test_what_is_no_press_and_repeat_is_not_measured(times):
    delay = RepeatDelay(PARAMETERS.first_hold)
    for time in times:
        delay.byte("w", time)
    assert delay.measured is None
