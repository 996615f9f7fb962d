"""One act per press of a key of teleop.py, in virtual time."""

import pytest
from robot_control.drive.keys.dead_man import SLOWEST_REPEAT
from robot_control.drive.keys.single_press import SinglePress


def acts(times, keys="+", period=0.02, end=20.0):
    """How often keys act whose bytes come at `times`."""
    single, count, looked = SinglePress(), 0, 0.0
    for number, time in enumerate(times):
        while looked < time:
            count += len(single.due(looked))
            looked += period
        count += len(single.press(keys[number % len(keys)], time))
    return count + len(single.due(end))


@pytest.mark.parametrize("delay", [0.2, 0.25, 0.5, 0.66])
@pytest.mark.parametrize("period", [0.02, 0.033, 0.1])
def test_a_held_key_acts_once(delay, period):
    assert acts([0.0, *(delay + period * number for number in range(40))]) == 1


@pytest.mark.parametrize("gap", [0.15, 0.2, 0.3, 0.5, 1.0])
def test_every_tap_acts(gap):
    assert acts([gap * number for number in range(6)]) == 6


def test_a_link_that_stalls_within_a_train_adds_no_act():
    train = [0.0, *(0.5 + 0.033 * number for number in range(10))]
    assert acts([*train, *(1.2 + 0.001 * number for number in range(10))]) == 1


def test_keys_in_turn_act_each():
    assert acts([0.0, 0.05, 0.1, 0.15], keys="+-") == 4


def test_a_tap_acts_after_the_time_of_a_repeat():
    single = SinglePress()
    assert single.press("+", 0.0) == ["+"]
    assert single.press("+", 0.3) == []
    assert single.due(0.3 + SLOWEST_REPEAT - 0.01) == []
    assert single.due(0.3 + SLOWEST_REPEAT + 0.01) == ["+"]
    assert single.due(1.0) == []


def test_with_reported_releases_each_press_acts_at_once_and_no_repeat():
    single = SinglePress()
    for time in (0.0, 0.05, 0.3):
        assert single.press("+", time) == ["+"]
        assert single.press("+", time + 0.01, repeat=True) == []
        assert single.release("+") == []
