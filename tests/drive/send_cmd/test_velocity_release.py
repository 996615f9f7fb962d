"""Tests when send_cmd.py may send its command by safety_status, without ROS."""

import random

import pytest
from robot_control.drive.send_cmd.release import GONE, NO_MONITOR, TIMEOUT, Phase, Release, Status

READY, DRIVE, INIT = Status("READY"), Status("DRIVE"), Status("INIT", missing=("state_estimator",))
STOPPED = Status(
    "STOPPED",
    sentence="a wheel does not turn although motion is commanded",
    detail="0.6 rad, limit 0.5 rad",
    remedy="check for a blocked wheel, then call e_stop_reset",
    causes=1,
)


def texts(lines) -> str:
    return "\n".join(line.text for line in lines)


@pytest.fixture
def release() -> Release:
    return Release(0.0)


@pytest.fixture
def sending(release) -> Release:
    release.update(0.1, READY)
    assert release.phase is Phase.SENDING
    return release


@pytest.mark.parametrize("status", [READY, DRIVE])
def test_the_command_is_sent_when_the_robot_may_drive_for_the_first_time(release, status) -> None:
    assert release.phase is Phase.WAITING
    release.update(0.1, INIT)
    assert release.phase is Phase.WAITING
    assert release.update(0.2, status) == []
    assert release.phase is Phase.SENDING


@pytest.mark.parametrize("state", ["STOPPING", "STOPPED", "FAULT"])
def test_a_stop_ends_the_command_for_good_and_says_why_and_what_to_do(sending, state) -> None:
    stop = Status(state, STOPPED.sentence, STOPPED.detail, STOPPED.remedy, 1)
    lines = sending.update(1.0, stop)
    assert sending.phase is Phase.STOPPED
    assert len(lines) == 1
    for words in (
        f"{state}: a wheel does not turn although motion is commanded (0.6 rad, limit 0.5 rad)",
        "has no effect",
        "zeros are sent",
        "check for a blocked wheel, then call e_stop_reset, then start send_cmd.py again",
    ):
        assert words in lines[0].text
    assert sending.update(1.5, stop) == [], "once"


def test_a_release_after_a_stop_does_not_begin_the_command_again(sending) -> None:
    sending.update(1.0, STOPPED)
    assert "start send_cmd.py again" in texts(sending.update(2.0, READY))
    assert sending.phase is Phase.RELEASED
    for status in (DRIVE, INIT, READY, STOPPED, READY):
        assert sending.update(3.0, status) == []
        assert sending.phase is Phase.RELEASED


def test_a_robot_that_was_started_again_does_not_get_the_old_command(sending) -> None:
    assert "restarted" in texts(sending.update(1.0, INIT))
    assert sending.phase is Phase.STOPPED


def test_a_command_that_is_requested_during_a_stop_does_not_begin_with_its_reset(release) -> None:
    lines = release.update(0.1, STOPPED)
    assert "motion is commanded (0.6 rad, limit 0.5 rad). The command has no" in texts(lines)
    assert release.update(5.0, STOPPED) == []
    assert "start send_cmd.py again" in texts(release.update(6.0, READY))
    assert release.phase is Phase.RELEASED


@pytest.mark.parametrize(("began", "phase"), [(0.0, Phase.STOPPED), (2.0, Phase.SENDING)])
def test_a_program_that_was_suspended_at_its_start_belongs_to_the_time_of_its_start(began, phase) -> None:
    release = Release(3.0, began)
    release.update(3.1, Status("READY", withdrawals=4, withdrawn=1.0))
    assert release.phase is phase


@pytest.mark.parametrize(("timeout", "silence"), [(1.25, " for 1.25 s"), (0.6, " for 0.6 s"), (0.0, "")])
def test_a_wait_for_a_zero_of_another_sender_is_said_once_in_one_line(release, timeout, silence) -> None:
    release.command_timeout = timeout
    waiting = Status("INIT", awaiting_zero=True)
    said = [line for i in range(100) for line in release.update(0.1 * i, waiting)]
    assert [line.text for line in said] == [
        f"waiting for a zero velocity command; stop the other sender{silence}, or publish zero from it"
    ]


def test_a_start_that_takes_a_moment_needs_no_words(release) -> None:
    assert release.update(0.1, Status("INIT", awaiting_zero=True)) == []
    assert release.update(TIMEOUT, INIT) == []
    assert release.update(TIMEOUT + 0.1, READY) == []


def test_a_missing_node_is_named_when_the_wait_lasts(release) -> None:
    release.update(0.1, INIT)
    assert "waits: state_estimator" in texts(release.update(0.2 + TIMEOUT, INIT))


def test_without_a_monitor_the_command_is_sent_and_that_is_said_once(release) -> None:
    assert release.update(NO_MONITOR - 0.1, None) == []
    assert release.phase is Phase.WAITING
    assert "no safety_status within 3 s" in texts(release.update(NO_MONITOR, None))
    assert release.phase is Phase.SENDING
    assert release.update(NO_MONITOR + 1, None) == []


@pytest.mark.parametrize(("status", "phase"), [(INIT, Phase.WAITING), (STOPPED, Phase.STOPPED), (READY, Phase.SENDING)])
def test_a_monitor_that_comes_later_decides_as_at_the_start(release, status, phase) -> None:
    release.update(NO_MONITOR, None)
    release.update(NO_MONITOR + 1, status)
    assert release.phase is phase
    release.update(NO_MONITOR + 2, READY)
    assert release.phase is (Phase.RELEASED if status is STOPPED else Phase.SENDING)


def test_a_monitor_that_ends_is_a_stop(sending) -> None:
    assert sending.update(1.0, DRIVE, 0.0, connected=False) == []
    assert sending.update(1.0 + GONE, DRIVE, GONE, connected=True) == [], "a connection that comes back at once"
    sending.update(2.0, DRIVE, 0.0, connected=False)
    assert "safety_monitor is gone" in texts(sending.update(2.1 + GONE, DRIVE, GONE, connected=False))
    assert sending.phase is Phase.STOPPED
    assert sending.update(3.0, DRIVE, 1.0, connected=False) == []
    assert sending.phase is Phase.STOPPED


def test_a_monitor_that_hangs_is_named_once(sending) -> None:
    assert "may hang" in texts(sending.update(5.0, DRIVE, NO_MONITOR + 0.1))
    assert sending.update(6.0, DRIVE, NO_MONITOR + 1.1) == []


def test_a_way_that_is_not_free_is_named(sending) -> None:
    blocked = Status("DRIVE", speed_limit=0.0)
    assert "clearance leaves the robot no speed" in texts(sending.update(1.0, blocked))
    assert sending.update(1.1, blocked) == []
    assert sending.update(1.2, DRIVE) == []
    assert len(sending.update(1.3, blocked)) == 1


def test_other_causes_are_counted() -> None:
    assert Status("STOPPED", "the robot hit something", causes=3).why() == (
        "STOPPED: the robot hit something, and 2 more: see why.py"
    )


@pytest.mark.parametrize("seed", range(200))
def test_whatever_the_robot_says_a_stop_is_followed_by_no_command(seed) -> None:
    """Random sequences: after the first status that is not READY or DRIVE while the command was sent, never again."""
    chance = random.Random(seed)
    release = Release(0.0)
    statuses = [None, READY, DRIVE, INIT, STOPPED, *(Status(state) for state in ("STOPPING", "FAULT", "INIT"))]
    now, last, ended = 0.0, None, False
    for _ in range(60):
        now += chance.choice([0.05, 0.05, 1.0, 4.0])
        status = chance.choice(statuses)
        last = last if status is None else status
        before = release.phase
        release.update(now, last, 0.0)
        if last is not None and before is Phase.SENDING and not last.drivable and release.phase is Phase.STOPPED:
            ended = True
        assert not (ended and release.phase in {Phase.SENDING, Phase.WAITING})
        if release.phase is Phase.SENDING and last is not None:
            assert last.drivable
