"""The law of pad.py in virtual time, and its device by a fake one: the kernel of a test machine has no uinput."""

import math
import os
import random
from dataclasses import dataclass, fields

import pytest
from robot_control.drive.pad.device import EV_ABS, EV_KEY, FIRST_BUTTON, GAMEPAD, Device, is_pad
from robot_control.drive.pad_law import ZEROS, Pad, PadParameters
from robot_control.robot.command import Command

GIVEN = PadParameters()
PERIOD = 0.02  # s
REST, FORWARD = (0.0, 0.0), (0.0, 1.0)
NONE, ENABLE, TURBO = (0,) * 6, (0, 0, 0, 0, 1, 0), (0, 0, 0, 0, 0, 1)


@pytest.fixture
def pad():
    """A pad that was read with nothing held, until 0 s."""
    pad = Pad(GIVEN)
    hold(pad, REST, NONE, -0.5, 0.5)
    return pad


def hold(pad, axes, buttons, begin, seconds, *, sender=""):
    """Answers as a device does that is read all the time; returns the last time."""
    now = begin
    for number in range(round(seconds / PERIOD) + 1):
        now = begin + number * PERIOD
        pad.receive(axes, buttons, now, sender)
    return now


def test_the_stick_moves_nothing_without_the_enable_button(pad):
    now = hold(pad, FORWARD, NONE, 0.1, 1.0)
    assert pad.command(now) is None


def test_with_the_enable_button_it_does(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0)
    assert pad.command(now) == Command(GIVEN.scale_linear, 0.0)
    now = hold(pad, (1.0, 0.0), ENABLE, now, 0.1)
    assert pad.command(now) == Command(0.0, GIVEN.scale_angular)


def test_on_legs_the_right_stick_moves_sideways_and_on_wheels_the_state_says_why_nothing_happens(pad):
    sideways = (0.0, 0.0, 0.0, 1.0)
    now = hold(pad, sideways, ENABLE, 0.1, 1.0)
    assert pad.command(now) == Command()
    assert pad.state(now) == "drives, but this robot has wheels and does not move sideways"
    pad.legged = True
    assert pad.command(now) == Command(0.0, 0.0, GIVEN.scale_lateral)
    assert pad.state(now) == "drives"


def test_the_turbo_button_has_scales_of_its_own(pad):
    now = hold(pad, (1.0, 1.0), TURBO, 0.1, 1.0)
    assert pad.command(now) == Command(GIVEN.scale_linear_turbo, GIVEN.scale_angular_turbo)


def test_a_release_is_zero_at_once_and_then_nothing(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0)
    pad.command(now)
    pad.receive(FORWARD, NONE, now + PERIOD)
    assert pad.command(now + PERIOD) == Command()
    hold(pad, FORWARD, NONE, now + 2 * PERIOD, ZEROS)
    assert pad.command(now + ZEROS + PERIOD) is None


def test_a_pad_that_is_merely_held_still_goes_on(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, GIVEN.max_hold - 1.0)
    assert pad.command(now).linear == GIVEN.scale_linear


def test_a_pad_that_is_unplugged_is_zero_at_once(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0)
    pad.command(now)
    pad.lose()
    assert pad.command(now + PERIOD) == Command()
    assert pad.state(now + PERIOD) == "no pad answers"


def test_a_device_that_no_longer_answers_is_zero_within_joy_timeout(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0)
    assert pad.command(now + GIVEN.joy_timeout).linear > 0
    assert pad.command(now + GIVEN.joy_timeout + 0.001) == Command()


def test_a_pad_that_comes_back_with_the_button_held_moves_nothing(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0)
    pad.command(now)
    now = hold(pad, FORWARD, ENABLE, now + 5.0, 1.0)
    assert pad.command(now) is None
    assert pad.state(now) == "release the enable button once"
    pad.receive(FORWARD, NONE, now + PERIOD)
    now = hold(pad, FORWARD, ENABLE, now + 2 * PERIOD, 0.1)
    assert pad.command(now).linear > 0


def test_what_a_stalled_link_delivers_at_once_when_it_goes_on_moves_nothing(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0) + 5.0
    for buttons in (ENABLE, NONE, ENABLE):
        pad.receive(FORWARD, buttons, now)
        assert pad.command(now) in (None, Command())
    assert pad.state(now) == "release the enable button once"


def test_a_pad_that_is_plugged_in_with_the_button_held_moves_nothing():
    pad = Pad(GIVEN)
    now = hold(pad, FORWARD, ENABLE, 0.0, 1.0)
    assert pad.command(now) is None


def test_a_lost_wireless_link_ends_after_max_hold(pad):
    """Its receiver repeats the last values."""
    now = hold(pad, FORWARD, ENABLE, 0.1, 0.1)
    last = None
    while now < GIVEN.max_hold + 1.0:
        now += PERIOD
        pad.receive(FORWARD, ENABLE, now)
        if pad.command(now) not in (None, Command()):
            last = now
    assert last == pytest.approx(0.1 + GIVEN.max_hold, abs=2 * PERIOD)


def test_noise_of_the_stick_lengthens_no_hold(pad):
    last, number = None, 0
    while 0.1 + number * PERIOD < GIVEN.max_hold + 5.0:
        now = 0.1 + number * PERIOD
        pad.receive((0.0, 0.9 + 0.0001 * (number % 7)), (0, number % 3 == 0, 0, 0, 1, number % 2), now)
        if pad.command(now) not in (None, Command()):
            last = now
        number += 1
    assert last == pytest.approx(0.1 + GIVEN.max_hold, abs=2 * PERIOD)
    assert pad.state(now) == "release the enable button once"


def test_a_second_publisher_of_joy_zeroes_and_is_named():
    """A lost pad with its button held, and an idle one that was switched on meanwhile, publish at once."""
    pad = Pad(GIVEN)
    hold(pad, REST, NONE, -0.5, 0.5, sender="/lost")
    for number in range(60):
        now = 0.1 + number * PERIOD
        pad.receive(FORWARD, ENABLE, now, "/lost")
        if number > 50:
            pad.receive(REST, NONE, now, "/idle")
        assert pad.command(now) == (Command(GIVEN.scale_linear, 0.0) if number <= 50 else Command())
    assert pad.state(now) == "/lost and /idle publish joy: zero until one is left"
    pad.receive(REST, NONE, now, "/third")
    assert pad.state(now) == "/lost and /idle and /third publish joy: zero until one is left"


@pytest.mark.parametrize("left", ["/first", "/second"])
def test_the_publisher_that_is_left_drives_after_a_release(left):
    pad = Pad(GIVEN)
    for number in range(50):
        pad.receive(REST, NONE, number * PERIOD, "/first")
        pad.receive(FORWARD, ENABLE, number * PERIOD, "/second")
    for number in range(50, 150):
        now = number * PERIOD
        pad.receive(FORWARD, ENABLE, now, left)
        assert pad.command(now) in (None, Command())
        assert f"{left} and {left}" not in pad.state(now)
    pad.receive(FORWARD, NONE, now + PERIOD, left)
    pad.receive(FORWARD, ENABLE, now + 2 * PERIOD, left)
    assert pad.command(now + 2 * PERIOD).linear == GIVEN.scale_linear


@pytest.mark.parametrize("seed", range(100))
def test_of_two_pads_that_send_at_random_none_moves_the_robot(seed):
    chance = random.Random(seed)
    pad = Pad(GIVEN)
    periods = {name: chance.uniform(0.01, 0.4 * GIVEN.joy_timeout) for name in ("/a", "/b")}
    due = dict.fromkeys(periods, 0.0)
    for number in range(2000):
        now = 0.005 * number
        for name, at in due.items():
            if now >= at:
                due[name] = now + periods[name] * chance.uniform(0.5, 1.0)
                pad.receive(FORWARD, chance.choice([ENABLE, NONE]), now, name)
        assert now < GIVEN.joy_timeout or pad.command(now) in (None, Command())


def test_what_is_held_over_a_stop_moves_nothing_until_it_was_released(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0)
    assert pad.command(now).linear > 0
    pad.permit(False)
    pad.interrupt(now)
    assert pad.command(now) == Command()
    pad.permit(True)
    now = hold(pad, FORWARD, ENABLE, now, 2.0)
    assert pad.command(now) is None
    pad.receive(FORWARD, NONE, now)
    pad.receive(FORWARD, ENABLE, now + PERIOD)
    assert pad.command(now + PERIOD).linear > 0


@pytest.mark.parametrize("buttons", [NONE, ENABLE])
def test_a_stop_is_followed_by_zeros_whatever_is_held(pad, buttons):
    """The controller may refuse earlier commands."""
    now = hold(pad, FORWARD, buttons, 0.1, 1.0) + 2 * ZEROS
    pad.interrupt(now)
    assert pad.command(now + ZEROS - PERIOD) == Command()
    assert pad.command(now + ZEROS + PERIOD) is None


def test_what_the_controller_refuses_is_zero_and_named_until_it_was_released(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0)
    assert pad.state(now) == "drives"
    pad.refuse(now)
    assert pad.command(now) == Command()
    now = hold(pad, FORWARD, ENABLE, now, 0.5)
    assert pad.state(now) == "release the enable button once"
    pad.receive(FORWARD, NONE, now)
    pad.receive(FORWARD, ENABLE, now + PERIOD)
    assert pad.command(now + PERIOD).linear > 0


def test_a_button_that_is_pressed_while_the_controller_refuses_has_to_be_released_once(pad):
    now = hold(pad, FORWARD, NONE, 0.1, 1.0)
    pad.receive(FORWARD, ENABLE, now)
    pad.refuse(now)
    assert pad.state(now) == "release the enable button once"
    assert pad.command(now) == Command()


def test_what_is_pressed_during_a_stop_moves_nothing_after_it(pad):
    pad.permit(False)
    now = hold(pad, FORWARD, ENABLE, 1.0, 1.0)
    assert pad.command(now) is None
    pad.permit(True)
    now = hold(pad, FORWARD, ENABLE, now, 1.0)
    assert pad.command(now) is None


def test_nor_what_was_pressed_during_a_stop_that_is_over_when_it_is_read(pad):
    pad.permit(False)
    hold(pad, FORWARD, NONE, 0.1, 1.0)
    now = hold(pad, FORWARD, ENABLE, 1.2, 0.1)
    pad.permit(True)
    assert pad.command(now) is None
    pad.receive(FORWARD, NONE, now + PERIOD)
    pad.receive(FORWARD, ENABLE, now + 2 * PERIOD)
    assert pad.command(now + 2 * PERIOD).linear > 0


def test_messages_from_before_an_interruption_arm_nothing(pad):
    now = hold(pad, FORWARD, ENABLE, 0.1, 1.0) + 3.0
    pad.interrupt(now)
    for buttons in (ENABLE, NONE, ENABLE):
        pad.receive(FORWARD, buttons, now)
        assert pad.command(now) in (None, Command())


@pytest.mark.parametrize("value", [math.nan, math.inf, 2.0, -1.01])
def test_an_axis_that_is_no_share_is_zero(pad, value):
    now = hold(pad, (0.0, value), ENABLE, 0.1, 0.1)
    assert pad.command(now) == Command()


def test_the_middle_of_an_axis_is_dead_and_its_end_is_full(pad):
    now = hold(pad, (0.0, GIVEN.deadzone), ENABLE, 0.1, 0.1)
    assert pad.command(now) == Command()
    now = hold(pad, (0.0, -1.0), ENABLE, now, 0.1)
    assert pad.command(now).linear == -GIVEN.scale_linear
    now = hold(pad, (0.0, GIVEN.deadzone + 0.01), ENABLE, now, 0.1)
    assert 0 < pad.command(now).linear < 0.02


def test_a_pad_with_fewer_axes_or_buttons_than_asked_for_moves_nothing(pad):
    now = hold(pad, (), (), 0.1, 0.1)
    assert pad.command(now) is None
    now = hold(pad, (1.0,), (1,) * 5, now, 0.1)
    assert pad.command(now) == Command(0.0, GIVEN.scale_angular)


def test_a_message_of_absurd_size_is_none(pad):
    pad.receive((1.0,) * 1000, ENABLE, 0.1)
    pad.receive(FORWARD, (1,) * 1000, 0.1)
    assert pad.command(0.1) is None


def test_the_names_are_those_of_teleop_twist_joy():
    names = {"axis_linear", "axis_angular", "scale_linear", "scale_angular", "scale_linear_turbo"}
    assert names | {"scale_angular_turbo", "enable_button", "enable_turbo_button"} <= {
        field.name for field in fields(PadParameters)
    }


@dataclass
class Info:
    value: int
    min: int
    max: int


class FakeDevice:
    """The part of evdev.InputDevice that pad.py uses, with an Xbox pad's layout."""

    name = "a pad"

    def __init__(self):
        self.axes = {0: Info(0, -32768, 32767), 1: Info(0, -32768, 32767), 2: Info(0, 0, 255), 0x28: Info(0, 0, 1)}
        self.held = []
        self.gone = False

    def capabilities(self):
        return {EV_KEY: [304, 305, 307, 308, 310, 311, 30], EV_ABS: list(self.axes.items())}

    def active_keys(self):
        if self.gone:
            raise OSError(19, "No such device")
        return self.held

    def absinfo(self, code):
        return self.axes[code]


def test_a_device_is_read_forward_and_left_positive():
    fake = FakeDevice()
    fake.axes[0].value, fake.axes[1].value, fake.axes[2].value = -32768, -32768, 255
    fake.held = [310, 30]
    axes, buttons = Device(fake).read()
    assert axes == pytest.approx((1.0, 1.0, -1.0))
    assert buttons == (0, 0, 0, 0, 1, 0), "a keyboard's key is none of its buttons"
    assert buttons[GIVEN.enable_button] == 1


def test_a_device_that_is_gone_says_so():
    fake = FakeDevice()
    fake.gone = True
    with pytest.raises(OSError, match="No such device"):
        Device(fake).read()


def test_what_is_a_pad():
    assert is_pad(FakeDevice())
    keyboard = FakeDevice()
    keyboard.capabilities = lambda: {EV_KEY: [30, 31, 32]}
    assert not is_pad(keyboard)
    mouse = FakeDevice()
    mouse.capabilities = lambda: {EV_KEY: [0x110, 0x111]}
    assert not is_pad(mouse)
    stick = FakeDevice()
    stick.capabilities = lambda: {EV_KEY: [FIRST_BUTTON], EV_ABS: [(0, Info(0, 0, 255)), (1, Info(0, 0, 255))]}
    assert is_pad(stick)
    assert GAMEPAD not in keyboard.capabilities()[EV_KEY]


def test_the_fake_has_the_form_of_the_library():
    if not (os.environ.get("CI") and os.environ.get("ROBOT_CONTROL_NIGHTLY")):  # there it must run
        pytest.importorskip("evdev", reason="python3-evdev, optional, is not installed: scripts/setup --operator")
    import evdev

    for name in ("capabilities", "active_keys", "absinfo"):
        assert callable(getattr(evdev.InputDevice, name))
    assert {"value", "min", "max"} <= set(evdev.AbsInfo._fields)
    assert (evdev.ecodes.EV_KEY, evdev.ecodes.EV_ABS) == (EV_KEY, EV_ABS)
    assert (evdev.ecodes.BTN_JOYSTICK, evdev.ecodes.BTN_GAMEPAD) == (FIRST_BUTTON, GAMEPAD)
