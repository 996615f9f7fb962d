"""What was requested, held or planned before a stop, or before a program was suspended, moves nothing after it."""

import random

import pytest
from lab.senders import CommandSender, PadSender, PathSender, TeleopSender
from robot_control.common.command import Command
from robot_control.common.interruptions import GAP, RESTARTED, Interruptions, Status
from robot_control.path.follower import Motion, Pose
from robot_control.path.waypoints import Waypoint
from robot_control.teleop.dead_man import DeadMan, HoldParameters

READY, STOPPED = Status("READY", resets=3, run=7), Status("STOPPED", "e_stop was called", resets=3, run=7)
RELEASED = Status("READY", resets=4, run=7)
PERIOD, LONG = 0.02, 20.0  # s


def interruptions(*statuses):
    made = Interruptions(0.0)
    made.step(0.1, statuses)
    return made


@pytest.mark.parametrize(
    ("statuses", "words"),
    [
        ([READY, STOPPED], "STOPPED: e_stop was called"),
        ([READY, STOPPED, RELEASED], "e_stop_reset was called"),
        ([READY, RELEASED], "stopped and released"),
        ([READY, Status("DRIVE", resets=3, run=8)], "started again"),
        ([READY, Status("INIT")], RESTARTED),
    ],
)
def test_what_was_requested_before_it_is_revoked_and_what_is_requested_afterwards_counts(statuses, words):
    made = interruptions(*statuses)
    assert made.count == 1
    assert words in made.revoked(0.05)
    assert made.revoked(0.1001) == ""


@pytest.mark.parametrize(
    "statuses", [[READY, Status("DRIVE", resets=3, run=7)], [Status("INIT"), READY], [Status("INIT", run=1), READY]]
)
def test_what_is_no_stop_interrupts_nothing(statuses):
    made = interruptions(*statuses)
    assert (made.count, made.revoked(0.0)) == (0, "")


def test_what_is_requested_during_a_stop_does_not_begin_with_its_reset():
    made = interruptions(STOPPED)
    made.step(0.3, [RELEASED])
    assert made.revoked(0.2) == "e_stop_reset was called"
    assert made.revoked(0.31) == ""


def test_a_pause_of_the_program_interrupts_what_it_did():
    made = interruptions(READY)
    made.step(0.1 + GAP)
    assert made.count == 0
    made.step(0.11 + 2 * GAP)
    assert made.revoked(0.1 + GAP) == "this program stood still for 0.5 s"
    assert made.revoked(0.2 + 2 * GAP) == ""


def test_a_program_that_plans_for_long_is_none_that_was_suspended():
    made = interruptions(READY)
    made.step(60.0, waited=True)
    assert made.revoked(0.1) == ""
    made.step(60.1, [RELEASED], waited=True)
    assert "stopped and released" in made.revoked(0.1)


def test_a_terminal_that_reports_releases_unblocks_with_the_last_one():
    dead_man, now = DeadMan(HoldParameters()), 1.0
    for key in ("w", "a"):
        now += 0.05
        dead_man.press(key, now)
    dead_man.end(now)
    dead_man.release("a")
    dead_man.press("w", now + 0.1, repeat=True)
    assert dead_man.look(now + 0.1) is None
    dead_man.release("w")
    dead_man.press("w", now + 0.2)
    assert dead_man.look(now + 0.2) is not None


class Monitor:
    """Stops and resets at random; its messages, of which a subscriber may miss all but the newest."""

    def __init__(self, chance):
        self.chance, self.status = chance, Status("READY", run=1)
        self.messages, self.stop_began, self.released = [self.status], -1.0, -1.0
        self.due = chance.uniform(1.0, 5.0)

    def step(self, now):
        if now < self.due:
            return
        resets = self.status.resets
        if self.status.drivable:
            self.status, self.stop_began = Status("STOPPED", "e_stop was called", resets=resets, run=1), now
            self.due = now + self.chance.choice([0.05, 0.3, 1.5, 4.0])
        else:
            self.status, self.released = Status("READY", resets=resets + 1, run=1), now
            self.due = now + self.chance.uniform(0.5, 6.0)
        self.messages.append(self.status)

    def take(self):
        taken, self.messages = self.messages, []
        return taken[-1:] if self.chance.random() < 0.3 else taken


class Hand:
    """A key or a button that is held now and then; since when."""

    def __init__(self, chance):
        self.chance, self.down, self.due, self.since = chance, False, 0.5, 0.0

    def step(self, now):
        if now >= self.due:
            self.down, self.since = not self.down, now
            self.due = now + self.chance.choice([0.1, 0.5, 1.5, 4.0])


class Keyboard:
    """Bytes of the held key, which wait in the terminal while the program does not read."""

    def __init__(self, chance):
        self.hand, self.waiting, self.next = Hand(chance), b"", 0.0

    def step(self, now):
        before = self.hand.down
        self.hand.step(now)
        if self.hand.down and (not before or now >= self.next):
            self.next = now + (0.4 if not before else 0.033)
            self.waiting += b"w"

    def take(self):
        taken, self.waiting = self.waiting, b""
        return taken


class Joystick:
    """The messages of a pad, likewise."""

    def __init__(self, chance):
        self.hand, self.waiting = Hand(chance), []

    def step(self, now):
        self.hand.step(now)
        self.waiting.append(((0.0, 1.0), (0, 0, 0, 0, int(self.hand.down), 0), "/pad"))

    def take(self):
        taken, self.waiting = self.waiting[-100:], []
        return taken


def suspended(chance):
    """For how long, at a time?"""
    pauses = [(begin, chance.choice([0.1, 0.4, 1.0, 3.0])) for begin in chance.sample(range(18), 2)]
    return lambda now: max((length for begin, length in pauses if begin <= now < begin + length), default=0.0)


def moves(command):
    return command not in (None, Command())


@pytest.mark.parametrize("seed", range(150))
@pytest.mark.parametrize(("sender", "source"), [(TeleopSender, Keyboard), (PadSender, Joystick)])
def test_what_a_person_holds_over_a_stop_or_a_pause_moves_nothing(seed, sender, source):
    chance = random.Random(seed)
    monitor, person, sleeps = Monitor(chance), source(chance), suspended(chance)
    made, woke, driven = sender(0.0), -1.0, 0
    for number in range(round(LONG / PERIOD)):
        now = number * PERIOD
        monitor.step(now)
        person.step(now)
        if sleeps(now):
            woke = now if sleeps(now) > GAP else woke
            continue
        command = made.step(now, monitor.take(), person.take())
        if moves(command):
            driven += 1
            assert monitor.status.drivable
            assert person.hand.since >= max(monitor.released, woke)
    assert driven > 0 or seed % 10


@pytest.mark.parametrize("seed", range(150))
def test_a_path_that_is_planned_or_driven_over_a_stop_moves_nothing(seed):
    chance = random.Random(seed)
    monitor, sleeps = Monitor(chance), suspended(chance)
    requested, made, planned, x = 0.0, PathSender(0.0), chance.uniform(0.0, 3.0), 0.0
    command = None
    for number in range(round(LONG / PERIOD)):
        now = number * PERIOD
        monitor.step(now)
        if planned <= now:
            made.plan([Waypoint(x, 0.0), Waypoint(x + 3.0, 0.0)])
            planned = 1e9
        if sleeps(now):
            continue
        if (made.reason or chance.random() < 0.001) and monitor.status.drivable:
            requested, made, planned = now, PathSender(now), now + chance.uniform(0.0, 3.0)
            monitor.messages = [monitor.status]  # it is latched
        linear = command.linear if command is not None else 0.0
        command = made.step(now, monitor.take(), (Pose(x, 0.0, 0.0), Motion(linear, 0.0)))
        x += command.linear * PERIOD
        assert not moves(command) or requested >= monitor.released
        assert not moves(command) or monitor.status.drivable


@pytest.mark.parametrize("seed", range(150))
def test_a_command_that_was_given_before_a_stop_moves_nothing(seed):
    chance = random.Random(seed)
    monitor, sleeps = Monitor(chance), suspended(chance)
    begun, made = 0.0, CommandSender(0.0)
    for number in range(round(LONG / PERIOD)):
        now = number * PERIOD
        monitor.step(now)
        if sleeps(now):
            continue
        if chance.random() < 0.003:
            begun, made = now, CommandSender(now)
            monitor.messages = [monitor.status]
        command = made.step(now, monitor.take())
        assert not moves(command) or begun >= monitor.stop_began
