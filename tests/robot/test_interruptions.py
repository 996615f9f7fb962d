"""A request, hold or plan from before a stop, or before a suspension of the program, moves nothing after it."""

import math
import subprocess
import sys
import time

import pytest
from robot_control.drive.keys.dead_man import DeadMan, HoldParameters
from robot_control.robot.interruptions import GAP, RESTARTED, Interruptions, Status, requested_at

from bench.release.sender_sequences import command, goal, pad, path, teleop

READY, STOPPED = Status("READY", withdrawals=3, run=7), Status("STOPPED", "e_stop was called", withdrawals=4, run=7)
RELEASED = Status("READY", withdrawals=4, run=7)


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
        ([READY, Status("DRIVE", withdrawals=3, run=8)], "restarted"),
        ([READY, Status("INIT")], RESTARTED),
    ],
)
def test_what_was_requested_before_it_is_revoked_and_what_is_requested_afterwards_counts(statuses, words):
    made = interruptions(*statuses)
    assert made.count == 1
    assert words in made.revoked(0.05)
    assert made.revoked(0.1001) == ""


@pytest.mark.parametrize(
    "statuses",
    [[READY, Status("DRIVE", withdrawals=3, run=7)], [Status("INIT"), READY], [Status("INIT", run=1), READY]],
)
def test_what_is_no_stop_interrupts_nothing(statuses):
    made = interruptions(*statuses)
    assert (made.count, made.revoked(0.0)) == (0, "")


def test_what_is_requested_during_a_stop_does_not_begin_with_its_reset():
    made = interruptions(STOPPED)
    made.step(0.3, [RELEASED])
    assert made.revoked(0.2) == "e_stop_reset was called"
    assert made.revoked(0.31) == ""


def before_the_first_look(status, *, heard=()):
    """A program that began at 1 s and made its first pass at 3 s."""
    made = Interruptions(3.0, 1.0)
    made.step(3.0, [*heard, status], waited=True)
    return made


@pytest.mark.parametrize("heard", [[], [Status("INIT")]])
def test_a_stop_and_its_reset_that_a_program_did_not_see_revoke_what_it_was_started_for(heard):
    made = before_the_first_look(Status("READY", withdrawals=4, run=7, withdrawn=3.0 if heard else 2.0), heard=heard)
    assert made.count == 1
    assert "stopped and released" in made.revoked(1.0)
    assert made.revoked(3.1) == ""


def test_a_restart_that_is_not_over_at_the_first_look_revokes_what_the_program_was_started_for():
    made = before_the_first_look(Status("INIT", withdrawals=4, run=8, withdrawn=2.0))
    made.step(3.5, [Status("READY", withdrawals=4, run=8, withdrawn=2.0)], waited=True)
    assert made.count == 1
    assert "restarted" in made.revoked(1.0)
    assert made.revoked(2.1) == "", "what was requested after the restart begins with its permission"


@pytest.mark.parametrize("withdrawn", [-math.inf, 0.9])
def test_what_was_withdrawn_before_a_program_began_revokes_nothing_of_it(withdrawn):
    made = before_the_first_look(Status("READY", withdrawals=4, run=7, withdrawn=withdrawn))
    assert (made.count, made.revoked(1.0)) == (0, "")


def test_a_process_began_before_its_first_line():
    code = "import time; from robot_control.robot.process_start import process_began; time.sleep(0.5); "
    before = time.monotonic()
    printed = subprocess.run(
        [sys.executable, "-c", f"{code}print(process_began())"], capture_output=True, check=True, text=True
    )
    assert before - 0.01 <= float(printed.stdout) <= before + 0.3


def test_a_pause_of_the_program_interrupts_what_it_did():
    made = interruptions(READY)
    made.step(0.1 + GAP)
    assert made.count == 0
    made.step(0.11 + 2 * GAP)
    assert made.revoked(0.1 + GAP) == "this program did not run for 1.0 s"
    assert made.revoked(0.2 + 2 * GAP) == ""


def test_a_program_that_plans_for_long_is_none_that_was_suspended():
    made = interruptions(READY)
    made.step(60.0, waited=True)
    assert made.revoked(0.1) == ""
    made.step(60.1, [RELEASED], waited=True)
    assert "stopped and released" in made.revoked(0.1)


@pytest.mark.parametrize("sent", [None, 5.001])
def test_a_request_without_a_time_of_this_clock_may_have_waited_in_a_queue(sent):
    assert requested_at(5.0, sent) == 5.0 - GAP
    assert requested_at(5.0, 2.0) == 2.0


def test_a_terminal_that_reports_releases_unblocks_with_the_last_one():
    dead_man, now = DeadMan(HoldParameters()), 1.0
    for key in ("w", "a"):
        now += 0.05
        dead_man.press(key, now)
    dead_man.end(now)
    dead_man.release("a")
    dead_man.press("w", now + 0.1, repeat=True)
    assert dead_man.held(now + 0.1) is None
    dead_man.release("w")
    dead_man.press("w", now + 0.2)
    assert dead_man.held(now + 0.2) is not None


@pytest.mark.parametrize("kind", [teleop, pad, path, goal, command])
def test_nothing_that_was_requested_before_a_stop_moves_after_it(kind):
    outcomes = [kind(seed) for seed in range(150)]
    violated = [outcome for outcome in outcomes if outcome.violation]
    assert not violated
    assert sum(outcome.moving > 0 for outcome in outcomes) > 120
