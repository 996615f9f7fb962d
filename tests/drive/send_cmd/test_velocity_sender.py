"""Tests the commands of send_cmd.py, without ROS."""

import pytest
from robot_control.robot.send_plan import SendPlan, parse_plan


def test_default_is_the_articles_command() -> None:
    assert parse_plan([]) == SendPlan(linear=0.5, angular=0.2, period=0.5, count=None)


def test_goes_on_until_interrupted_by_default() -> None:
    assert SendPlan().sends_left(10**6)


def test_count_ends_it() -> None:
    plan = parse_plan(["--count", "2"])
    assert plan.sends_left(1)
    assert not plan.sends_left(2)


@pytest.mark.parametrize(("seconds", "count"), [("2", 4), ("0.1", 1), ("2.1", 5)])
def test_seconds_become_whole_sends(seconds: str, count: int) -> None:
    assert parse_plan(["--seconds", seconds]).count == count


def test_line_for_the_log_has_both_speeds_and_their_units() -> None:
    assert SendPlan(linear=-0.25, angular=1.5).describe(3) == "cmd_vel 3: -0.25 m/s, 1.5 rad/s"


def test_a_speed_sideways_is_sent_and_named() -> None:
    plan = parse_plan(["--lateral", "-0.2"])
    assert plan == SendPlan(lateral=-0.2)
    assert plan.describe(1) == "cmd_vel 1: 0.5 m/s, -0.2 m/s to the left, 0.2 rad/s"


@pytest.mark.parametrize(
    "wrong",
    [
        ["--period", "0"],
        ["--period", "nan"],
        ["--seconds", "-1"],
        ["--linear", "fast"],
        ["--count", "-3"],
        ["--count", "0"],
        ["--count", "2.5"],
    ],
)
def test_refuses_what_is_no_plan(wrong: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parse_plan(wrong)
    assert ended.value.code == 2
    assert wrong[0] in capsys.readouterr().err


def test_help_names_what_to_use_in_lockstep(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        parse_plan(["--help"])
    assert "command_script" in capsys.readouterr().out
