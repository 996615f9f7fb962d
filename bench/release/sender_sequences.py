"""Random sequences of stops, resets, suspensions, planning times and inputs for the shipped senders, in virtual time.

Each sequence asks whether anything moves that was requested, held or planned before the last stop. The judge knows the
times of the monitor's release, of the program's suspensions, and of the person's or client's request. A sequence is
given by its seed.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from robot_control.drive.path.follower import Motion
from robot_control.drive.path.waypoints import Waypoint
from robot_control.robot.command import Command
from robot_control.robot.interruptions import GAP, Status
from robot_control.robot.pose import Pose

from bench.release.path_jumps import MAX_EXCESS, excess
from bench.release.senders import CommandSender, GoalSender, PadSender, PathSender, TeleopSender
from bench.rows import Row, Say, plain
from bench.runs.runner import Runner

PERIOD = 0.02  # s between two passes
LONG = 20.0  # s of a sequence
LOOKS = round(LONG / PERIOD)
RESTARTS = 0.3  # share of the ends of a permission that no reset follows


@dataclass(frozen=True)
class Outcome:
    """Outcome of one sequence."""

    seed: int
    violation: str = ""  # empty: none
    moving: int = 0  # passes in which the sender requested motion; without any the sequence proves nothing

    def at(self, now: float, violation: str) -> Outcome:
        """The same with a violation at `now` s."""
        return replace(self, violation=f"{now:.2f} s: {violation}")


class Monitor:
    """Stops with resets, and restarts, at random. A subscriber may miss all its messages but the newest. With `first`
    it was just started and permits nothing yet.
    """

    def __init__(self, chance: random.Random, *, first: bool = False) -> None:
        self._chance = chance
        self.status = Status("INIT" if first else "READY", run=1)
        self.messages = [self.status]
        self.released = -1.0  # s: the last reset, or restart
        self._due = chance.uniform(1.0, 5.0)

    def step(self, now: float) -> None:
        """One pass."""
        if now < self._due:
            return
        status, withdrawals = self.status, self.status.withdrawals
        if status.drivable and self._chance.random() < RESTARTS:
            self.released = now
            self.status = Status("INIT", withdrawals=withdrawals + 1, run=1, withdrawn=now)
            self._due = now + self._chance.choice([0.05, 0.3, 1.5, 4.0])
        elif status.drivable:
            self.status = Status("STOPPED", "e_stop was called", withdrawals=withdrawals + 1, run=1, withdrawn=now)
            self._due = now + self._chance.choice([0.05, 0.3, 1.5, 4.0])
        else:
            self.released = now if status.stopped else self.released
            self.status = Status("READY", withdrawals=withdrawals, run=1, withdrawn=self.released)
            self._due = now + self._chance.uniform(0.5, 6.0)
        self.messages.append(self.status)

    def take(self) -> list[Status]:
        """The messages since the last call."""
        taken, self.messages = self.messages, []
        return taken[-1:] if self._chance.random() < 0.3 else taken


class Hand:
    """A key or a button that is held now and then, and the begin of the hold."""

    def __init__(self, chance: random.Random) -> None:
        self._chance = chance
        self.down, self.since, self._due = False, 0.0, 0.5

    def step(self, now: float) -> None:
        """One pass."""
        if now >= self._due:
            self.down, self.since = not self.down, now
            self._due = now + self._chance.choice([0.1, 0.5, 1.5, 4.0])


class Keyboard:
    """Bytes of the held key, which wait in the terminal while the program does not read."""

    def __init__(self, chance: random.Random) -> None:
        self.hand, self._waiting, self._next = Hand(chance), b"", 0.0

    def step(self, now: float) -> None:
        """One pass."""
        before = self.hand.down
        self.hand.step(now)
        if self.hand.down and (not before or now >= self._next):
            self._next = now + (0.4 if not before else 0.033)
            self._waiting += b"w"

    def take(self) -> bytes:
        """The bytes that wait."""
        taken, self._waiting = self._waiting, b""
        return taken


class Joystick:
    """The messages of a pad, which wait while the program does not read."""

    def __init__(self, chance: random.Random) -> None:
        self.hand = Hand(chance)
        self._waiting: list[tuple[Sequence[float], Sequence[int], str]] = []

    def step(self, now: float) -> None:
        """One pass."""
        self.hand.step(now)
        self._waiting.append(((0.0, 1.0), (0, 0, 0, 0, int(self.hand.down), 0), "/pad"))

    def take(self) -> list[tuple[Sequence[float], Sequence[int], str]]:
        """The waiting messages, at most a subscriber's queue of them."""
        taken, self._waiting = self._waiting[-100:], []
        return taken


class Suspensions:
    """The times in which the program does not run, from `begin` s on."""

    def __init__(self, chance: random.Random, begin: int = 1) -> None:
        self._pauses = [(second, chance.choice([0.1, 0.4, 1.0, 3.0])) for second in chance.sample(range(begin, 18), 2)]

    def lasting(self, now: float) -> float:
        """s of the suspension at `now`; 0 if it runs."""
        return max((length for begin, length in self._pauses if begin <= now < begin + length), default=0.0)


def moves(command: Command | None) -> bool:
    """True if it requests motion."""
    return command not in (None, Command())


def held(seed: int, sender: Callable[[float], Any], source: Callable[[random.Random], Any]) -> Outcome:
    """A key or button that is held over a stop or a suspension moves nothing before its release."""
    chance = random.Random(seed)  # noqa: S311 (a seeded sequence)
    monitor, person, suspensions = Monitor(chance), source(chance), Suspensions(chance)
    made, woke, outcome = sender(0.0), -1.0, Outcome(seed)
    for number in range(LOOKS):
        now = number * PERIOD
        monitor.step(now)
        person.step(now)
        if lasting := suspensions.lasting(now):
            woke = now if lasting > GAP else woke
            continue
        if not moves(made.step(now, monitor.take(), person.take())):
            continue
        outcome = replace(outcome, moving=outcome.moving + 1)
        if not monitor.status.drivable:
            return outcome.at(now, "motion during a stop")
        if person.hand.since < max(monitor.released, woke):
            return outcome.at(now, "motion of what was held before the stop or the suspension")
    return outcome


def teleop(seed: int) -> Outcome:
    """A key of teleop.py."""
    return held(seed, TeleopSender, Keyboard)


def pad(seed: int) -> Outcome:
    """The hold button of pad.py."""
    return held(seed, PadSender, Joystick)


def path(seed: int) -> Outcome:
    """A drive_path.py that was started before the end of a stop moves nothing after it, however long it plans."""
    chance = random.Random(seed)  # noqa: S311 (a seeded sequence)
    monitor, suspensions = Monitor(chance, first=chance.random() < 0.2), Suspensions(chance, 0)
    outcome, made, x, linear = Outcome(seed), None, 0.0, 0.0
    requested, begins, planned = 0.0, chance.choice([0.0, 3.0]), chance.uniform(0.0, 3.0)
    for number in range(LOOKS):
        now = number * PERIOD
        monitor.step(now)
        if suspensions.lasting(now) or now < begins:
            continue
        if made is None:
            made = PathSender(now, requested=requested)
            monitor.messages = [monitor.status]  # it is latched
        if planned <= now:
            made.plan([Waypoint(x, 0.0), Waypoint(x + 3.0, 0.0)])
            planned = 1e9
        command = made.step(now, monitor.take(), (Pose(x, 0.0, 0.0), Motion(linear, 0.0)))
        linear = command.linear if command is not None else 0.0
        x += linear * PERIOD
        if made.reason or chance.random() < 0.001:
            requested, made, planned = now, None, now + chance.uniform(0.0, 3.0)
            begins = now + chance.choice([0.0, 0.3, 5.0])
        if not moves(command):
            continue
        outcome = replace(outcome, moving=outcome.moving + 1)
        if not monitor.status.drivable:
            return outcome.at(now, "motion during a stop")
        if requested < monitor.released:
            return outcome.at(now, "motion along a path that was requested before the reset")
    return outcome


def goal(seed: int) -> Outcome:
    """A goal for follow_path.py that waited in its queue over a stop or a suspension moves nothing."""
    chance = random.Random(seed)  # noqa: S311 (a seeded sequence)
    monitor, suspensions, outcome = Monitor(chance), Suspensions(chance), Outcome(seed)
    made, woke, sent, x, linear = GoalSender(0.0), -1.0, 0.0, 0.0, 0.0
    waiting: list[tuple[float, float | None]] = []  # times of sending, and the times that the goals state
    read_from = 0.0  # after a suspension the thread that reads goals may be later than that of safety_status
    for number in range(LOOKS):
        now = number * PERIOD
        monitor.step(now)
        if chance.random() < 0.01:
            waiting.append((now, chance.choice([now, None])))
        if lasting := suspensions.lasting(now):
            woke = now if lasting > GAP else woke
            read_from = now + chance.choice([0.0, 0.1, 0.5])
            continue
        goals: list[tuple[list[Waypoint], float | None]] = []
        if waiting and now >= read_from:
            sent, says = waiting[-1]
            goals, waiting = [([Waypoint(x, 0.0), Waypoint(x + 3.0, 0.0)], says)], []
        command = made.step(now, monitor.take(), (Pose(x, 0.0, 0.0), Motion(linear, 0.0)), goals)
        linear = command.linear if command is not None else 0.0
        x += linear * PERIOD
        if not moves(command):
            continue
        outcome = replace(outcome, moving=outcome.moving + 1)
        if not monitor.status.drivable:
            return outcome.at(now, "motion during a stop")
        if sent < max(monitor.released, woke):
            return outcome.at(now, "motion along a goal that was sent before the stop or the suspension")
    return outcome


def command(seed: int) -> Outcome:
    """A send_cmd.py that was started before the end of a stop moves nothing after it."""
    chance = random.Random(seed)  # noqa: S311 (a seeded sequence)
    monitor, suspensions = Monitor(chance, first=chance.random() < 0.2), Suspensions(chance, 0)
    outcome, made, begun, begins = Outcome(seed), None, 0.0, chance.choice([0.0, 3.0])
    for number in range(LOOKS):
        now = number * PERIOD
        monitor.step(now)
        if chance.random() < 0.003:
            begun, made, begins = now, None, now + chance.choice([0.0, 0.3, 5.0])
        if suspensions.lasting(now) or now < begins:
            continue
        if made is None:
            made = CommandSender(now, begun)
            monitor.messages = [monitor.status]
        if not moves(made.step(now, monitor.take())):
            continue
        outcome = replace(outcome, moving=outcome.moving + 1)
        if begun < monitor.released:
            return outcome.at(now, "motion of a program that was started before the reset")
    return outcome


def jumps(seed: int) -> Outcome:
    """A path whose pose jumps drives the robot no farther than its length and `MAX_EXCESS`."""
    farther = excess(seed)
    violation = "" if farther < MAX_EXCESS else f"{farther:.2f} m farther than the path is long"
    return Outcome(seed, violation, moving=1)


KINDS = (teleop, pad, path, goal, command, jumps)


def run_sequence(seed: int) -> Outcome:
    """The outcome of the sequence of this seed; the kinds take turns."""
    return KINDS[seed % len(KINDS)](seed)


def sender_rows(first: int, runs: int, say: Say, runner: Runner) -> list[Row]:
    """Rows of `scripts/bench release`: the numbers of sequences, of failures, and of passes in motion."""
    failed = moving = 0
    for one in runner.outcomes(run_sequence, range(first, first + runs), say, chunk=50):
        moving += one.moving
        if one.violation:
            failed += 1
            say(f"seed {one.seed}, {KINDS[one.seed % len(KINDS)].__name__}: {one.violation}")
    return [
        plain("sender sequences", runs, "of 20 s"),
        plain("sender sequences failed", failed, ""),
        plain("in motion", moving, ""),
    ]
