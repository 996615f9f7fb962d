"""The screen of teleop.py."""

import pytest
from robot_control.drive.keys.key_map import CLASSIC, KEY_MAPS, SAFETY_HELP
from robot_control.drive.teleop.screen import HEIGHT, WIDTH, View, render
from robot_control.loop.roles import CONTROLLER, LEGGED, LOOP, Kind
from robot_control.robot.command import Command
from robot_control.robot.diagnosis.state import Cause, Facts, Report, Safety

VIEW = View(
    keys=CLASSIC, topic="/cmd_vel_stamped", own_name="/teleop", chosen=Command(0.5, 1.0), requested=Command(0.25, 0.0)
)


def facts(**changes):
    healthy = {
        "master": "http://localhost:11311",
        "safety": Safety("DRIVE", "drive"),
        "reports": {node: Report() for node in LOOP},
        "limited": (0.25, 0.0),
        "measured": (0.24, -0.001),
    }
    return Facts(**{**healthy, **changes})


def screen(robot, view=VIEW):
    return "\n".join(render(robot, view))


def test_it_shows_speed_requested_limited_and_measured():
    lines = [" ".join(line.split()) for line in render(facts(), VIEW)]
    for line in ("chosen 0.50 1.00", "requested 0.25 0.00", "after limits 0.25 0.00", "measured 0.24 0.00"):
        assert line in lines


def test_of_a_robot_on_legs_it_shows_the_speed_sideways():
    legs = facts(kind=Kind(LEGGED, controller="leg_controller"), limited=(0.25, 0.0, 0.1))
    view = View(**{**vars(VIEW), "chosen": Command(0.5, 1.0, 0.3)})
    lines = [" ".join(line.split()) for line in render(legs, view)]
    for line in ("linear m/s angular rad/s sideways m/s", "chosen 0.50 1.00 0.30", "after limits 0.25 0.00 0.10"):
        assert line in lines


def test_it_shows_state_causes_and_remedy():
    cause = Cause(
        "e_stop_topic", "an emergency stop is requested on the topic e_stop", "publish false", "operator", first=True
    )
    text = screen(facts(safety=Safety("STOPPED", "brake", causes=(cause,))))
    for words in (
        "STOPPED, permit: brake",
        "Stopped: an emergency stop is requested on the topic e_stop",
        "operator: publish false",
    ):
        assert words in text


def test_it_shows_the_age_of_the_command_and_who_else_commands():
    reports = {**{node: Report() for node in LOOP}, CONTROLLER: Report(values={"senders": "/planner, /teleop"})}
    view = View(**{**vars(VIEW), "sent_age": 0.04})
    text = " ".join(screen(facts(reports=reports), view).split())
    assert "sent on /cmd_vel_stamped, 40 ms ago; also commanding: /planner;" in text


def test_an_idle_robot_needs_a_key_and_nothing_else():
    reports = {**{node: Report() for node in LOOP}, CONTROLLER: Report(values={"command: timed_out": "too old"})}
    text = screen(facts(reports=reports))
    assert "Ready: hold a key." in text
    assert "to do" not in text


def test_without_nodes_it_says_so():
    assert "no safety_status" in screen(Facts(master="http://localhost:11311"))


@pytest.mark.parametrize("keys", KEY_MAPS.values(), ids=KEY_MAPS)
def test_it_fits_80_by_24_whatever_there_is_to_say_and_the_safety_keys_are_last(keys):
    causes = tuple(Cause(f"cause_{n}", "a long sentence " * 9, "a long remedy " * 9, "operator") for n in range(9))
    robot = facts(
        safety=Safety("STOPPED", "brake", causes=causes, warnings=("a warning " * 30,)),
        reports={**facts().reports, CONTROLLER: Report(values={f"command: r{n}": "reason " * 9 for n in range(9)})},
        senders=("/a_sender_with_a_long_name",) * 9,
    )
    view = View(**{**vars(VIEW), "keys": keys, "message": "message " * 40, "answer": "answer " * 40})
    lines = render(robot, view)
    assert len(lines) == HEIGHT
    assert max(map(len, lines)) <= WIDTH
    assert "EMERGENCY STOP" in lines[-1]
    assert "\x1b" not in "".join(lines)


@pytest.mark.parametrize("height", [1, 3, 5, 10, 23, 24, 60])
def test_a_lower_terminal_cuts_the_body_and_keeps_the_keys_of_the_e_stop(height):
    lines = render(facts(), VIEW, height)
    assert len(lines) == min(height, HEIGHT)
    assert lines[-1] == SAFETY_HELP
    assert lines == (render(facts(), VIEW)[: len(lines) - 5] + render(facts(), VIEW)[-5:])[-len(lines) :]
