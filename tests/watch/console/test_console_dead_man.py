"""The dead-man of a link, in virtual time."""

import math
from dataclasses import replace

import pytest
from robot_control.drive.keys.operator import ZEROS, Limits
from robot_control.drive.pad_law import SETTLING, PadParameters
from robot_control.robot.command import Command
from robot_control.watch.console.authority import Authority, RefusedError, Role
from robot_control.watch.console.dead_man import Drive
from robot_control.watch.console.settings import Settings

PERIOD = 0.05  # s between two messages of a page
SETTINGS = Settings()
LIMITS = Limits(linear=1.0, angular=2.0, reverse=0.3)


class Page:
    """A page with a perfect link, whose clock is ahead by 1000 s."""

    limits = LIMITS

    def __init__(self, authority, role=Role.OPERATE, name="anna"):
        self.authority, self.page, self.now, self.number = authority, authority.join(name, role), 0.0, 0
        self.page.dead_man.pad.permit(True)
        self.held, self.linear, self.angular, self.lateral = False, 0.0, 0.0, 0.0

    def send(self, delay=0.0):
        self.number += 1
        drive = Drive(self.number, self.now - delay + 1000.0, self.held, self.linear, self.angular, self.lateral)
        self.authority.receive(self.page, drive, self.now)

    def answer_pings(self, round_trip=0.0):
        for number in range(200):
            self.page.dead_man.round_trips.ping(str(number), self.now)
            self.page.dead_man.round_trips.pong(str(number), self.now + round_trip)

    def run(self, seconds, send=True):
        """Commands of every pass."""
        commands = []
        end = self.now + seconds
        while self.now < end - 1e-9:
            if send:
                self.send()
            commands.append(self.authority.command(self.limits, self.now)[0])
            self.now += PERIOD
        return commands

    def press(self, linear=1.0, angular=0.0):
        self.held, self.linear, self.angular = True, linear, angular

    def release(self):
        self.held, self.linear, self.angular = False, 0.0, 0.0


@pytest.fixture
def page():
    """Commands, has released everything, and its link allows the chosen speed."""
    made = Page(Authority(SETTINGS))
    made.authority.take(made.page, made.now)
    made.answer_pings()
    made.run(3.0)
    return made


def moves(commands):
    return [command for command in commands if command not in (None, Command())]


def test_a_held_key_drives_at_the_chosen_speed_and_its_release_is_zero_at_once(page):
    page.press(1.0, -1.0)
    assert page.run(1.0)[-1] == Command(0.5, -1.0)
    page.release()
    commands = page.run(ZEROS - PERIOD)
    assert set(commands) == {Command()}


def test_on_legs_alone_a_page_moves_sideways_and_the_cap_of_the_link_holds_for_both_axes_together(page):
    page.press(1.0)
    page.lateral = -1.0
    assert page.run(1.0)[-1] == Command(0.5, 0.0)
    assert "does not move sideways" in page.page.dead_man.state(page.now)
    page.page.dead_man.pad.legged = True
    page.limits = replace(LIMITS, lateral=0.2)
    assert page.run(1.0)[-1] == Command(0.5, 0.0, -0.2)
    page.page.chosen = Command(1.0, 1.0, 0.2)
    command = page.run(1.0)[-1]
    assert math.hypot(command.linear, command.lateral) == pytest.approx(page.page.cap)
    assert command.lateral == pytest.approx(-0.2 * command.linear)


def test_without_a_held_key_nothing_is_sent_after_a_second(page):
    page.press()
    page.run(1.0)
    page.release()
    assert page.run(ZEROS + 0.2)[-1] is None


def test_a_page_at_rest_sends_zeros_for_as_long_as_a_reset_may_need_them(page):
    page.run(ZEROS)
    page.authority.rest(page.now + 5.0)
    page.authority.refuse(page.now)
    assert set(page.run(5.0 - PERIOD)) == {Command()}
    assert page.run(0.2)[-1] is None


def test_the_zeros_for_a_reset_end_when_the_robot_may_drive_because_another_node_may_drive_it_then(page):
    page.run(ZEROS)
    page.authority.rest(page.now + 5.0)
    page.authority.permit(True)
    assert page.run(0.2)[-1] is None
    page.authority.rest(page.now + 5.0)
    assert page.run(0.2)[-1] is None


def test_backwards_it_is_no_faster_than_the_robot_may(page):
    page.press(-1.0)
    assert page.run(0.5)[-1].linear == -0.3


@pytest.mark.parametrize("silence", [0.35, 0.5, 5.0])
def test_a_gap_is_zero_within_link_gap_and_a_pass_and_needs_a_release(page, silence):
    page.press()
    page.run(1.0)
    commands = page.run(silence, send=False)
    assert len(moves(commands)) * PERIOD <= SETTINGS.command_life + 1e-9
    assert page.page.dead_man.gaps == 1
    assert not moves(page.run(5.0)), "it is still held"
    assert "release" in page.page.dead_man.state(page.now)
    page.release()
    page.run(SETTLING + 0.1)
    page.press()
    assert moves(page.run(1.0))


def test_a_shorter_gap_is_none(page):
    page.press()
    page.run(1.0)
    assert len(moves(page.run(0.25, send=False))) * PERIOD <= SETTINGS.command_life + 1e-9
    assert len(moves(page.run(1.0))) == 20


def test_messages_that_waited_in_a_stalled_link_move_nothing(page):
    """A release and a press that come in one burst are old."""
    page.press()
    page.run(1.0)
    page.run(2.0, send=False)
    for number in range(40):
        page.held = number > 20
        page.send(delay=2.0 - number * PERIOD)
    assert page.page.dead_man.late > 30
    page.press()
    assert not moves(page.run(3.0))


def test_the_stamp_is_the_receipt_less_what_the_message_took_longer(page):
    page.press()
    page.run(1.0)
    page.send(delay=0.12)
    command, age = page.authority.command(LIMITS, page.now)
    assert moves([command])
    assert age == pytest.approx(0.12)


def test_a_message_moves_the_robot_for_a_time_since_its_sending_not_since_its_receipt(page):
    page.press()
    page.run(1.0)
    page.send(delay=0.1)
    page.now += 0.1
    assert not moves([page.authority.command(LIMITS, page.now)[0]])


@pytest.mark.parametrize("step", [0, -5])
def test_a_replayed_message_does_not_count(page, step):
    page.press()
    page.number -= 1 - step
    page.send()
    assert page.page.dead_man.replayed == 1
    assert not moves([page.authority.command(LIMITS, page.now)[0]])


@pytest.mark.parametrize("event", ["interrupt", "permit", "refuse"])
def test_after_a_stop_nothing_moves_before_a_release_and_a_new_press(page, event):
    page.press()
    page.run(1.0)
    if event == "interrupt":
        page.authority.interrupt(page.now, "a stop")
    elif event == "refuse":
        page.authority.refuse(page.now)
    else:
        page.authority.permit(False)
        page.run(0.2)
        page.authority.permit(True)
    assert not moves(page.run(2.0))
    page.release()
    page.run(1.0)
    page.press()
    assert moves(page.run(0.5))


def test_a_reloaded_page_whose_key_is_still_held_moves_nothing(page):
    page.press()
    page.run(1.0)
    page.authority.leave(page.page, page.now)
    again = Page(page.authority)
    again.now = page.now
    again.answer_pings()
    again.authority.take(again.page, again.now)
    again.press()
    assert not moves(again.run(3.0))


def test_a_page_that_ends_is_zero_at_once(page):
    page.press()
    page.run(1.0)
    page.authority.leave(page.page, page.now)
    assert page.authority.command(LIMITS, page.now)[0] == Command()


def test_a_hold_of_max_hold_ends(page):
    page.press()
    commands = page.run(PadParameters.max_hold + 2.0)
    assert len(moves(commands)) * PERIOD == pytest.approx(PadParameters.max_hold, abs=0.2)


def test_one_page_commands_and_another_moves_nothing(page):
    other = Page(page.authority, name="berta")
    other.now = page.now
    with pytest.raises(RefusedError, match=r"anna .* has control"):
        other.authority.take(other.page, other.now)
    with pytest.raises(RefusedError, match=r"anna .* has control"):
        other.authority.take(other.page, other.now, force=True)
    other.press()
    with pytest.raises(RefusedError, match="does not have control"):
        other.send()
    assert not moves(page.run(0.5))


def test_a_watcher_cannot_take_the_command(page):
    watcher = Page(page.authority, Role.WATCH)
    page.authority.give_back(page.page, page.now)
    with pytest.raises(RefusedError, match="watch"):
        page.authority.take(watcher.page, 0.0, force=True)
    with pytest.raises(RefusedError, match="take control first"):
        page.authority.hand_over(watcher.page, 1, 0.0)


@pytest.mark.parametrize("how", ["force", "hand_over"])
def test_a_change_of_command_ends_the_motion_of_both(page, how):
    other = Page(page.authority, Role.MAINTAIN)
    other.now = page.now
    other.answer_pings()
    page.press()
    page.run(1.0)
    if how == "force":
        page.authority.take(other.page, page.now, force=True)
    else:
        page.authority.hand_over(page.page, other.page.number, page.now)
    assert page.authority.command(LIMITS, page.now)[0] == Command()
    with pytest.raises(RefusedError):
        page.send()
    other.now = page.now
    other.press()
    assert not moves(other.run(1.0)), "it was held before"
    other.release()
    other.run(0.5)
    other.press()
    assert moves(other.run(2.0))


@pytest.mark.parametrize("round_trip", [0.02, 0.1, 0.2, 0.4, 0.8])
def test_the_way_after_the_last_good_command_stays_within_the_distance(round_trip):
    """From its sending: half a round trip at full speed, then until the command of zero."""
    page = Page(Authority(SETTINGS))
    page.page.chosen = Command(5.0, 1.0)
    page.authority.take(page.page, 0.0)
    page.answer_pings(round_trip)
    page.run(6.0)
    page.press()
    limits, tick = Limits(5.0, 1.0, 1.0), 0.02
    for _ in range(40):
        page.send()
        speed = page.authority.command(limits, page.now)[0].linear
        page.now += PERIOD
    assert speed == pytest.approx(0.3 / (round_trip + 0.4))
    page.now -= PERIOD
    way = speed * round_trip / 2
    while (command := page.authority.command(limits, page.now)[0]) != Command():
        way += command.linear * tick
        page.now += tick
    assert 0.4 * 0.3 < way <= 0.3


def test_without_a_measured_link_no_speed_is_allowed():
    page = Page(Authority(SETTINGS))
    page.authority.take(page.page, 0.0)
    page.run(1.0)
    page.press()
    assert not moves(page.run(2.0))
