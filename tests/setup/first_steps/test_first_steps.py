"""first_steps.py without a robot: each step passes a healthy measurement and names one that is not."""

import math
from types import SimpleNamespace

import pytest
from nav_msgs.msg import Odometry
from robot_control.msg import SafetyStatus
from robot_control.robot.services import E_STOP, Answer
from robot_control.setup.first_steps import checks, robot
from robot_control.setup.first_steps.checks import StepError
from robot_control.setup.first_steps.main import parse_options, take
from robot_control.setup.first_steps.robot import speed_along
from robot_control.setup.first_steps.steps import STEPS
from robot_control.setup.terminal_dialog import NoAnswerError

LEGS = ("front_left", "front_right", "rear_left", "rear_right")
NAMES = [f"{leg}_{joint}_joint" for leg in LEGS for joint in ("hip", "thigh", "knee")]
ORDERED = 0.15
SHARE = 31.0
"""N, a quarter of the weight"""


def turns(**joints):
    """rad, of all joints: those that are named, the others tremble."""
    return [joints.get(name, 0.004) for name in NAMES]


def found(name, verdict):
    return {"name": name, "verdict": verdict, "value": "full", "remedy": "free it"}


def doctor(**verdicts):
    """The lines of doctor.py: those that must be green, and these."""
    return [found(name, verdict) for name, verdict in (dict.fromkeys(checks.GREEN, "ok") | verdicts).items()]


def test_a_healthy_robot_passes_every_check():
    checks.hung(dict.fromkeys(LEGS, -0.3), SHARE)
    checks.stood(dict.fromkeys(LEGS, 31.0), SHARE)
    checks.level(0.02, -0.05)
    checks.green(doctor(swap="warning"))
    checks.charged(["foot_load"], 28.4)
    checks.charged([], None)
    for cause in ("e_stop_input", "e_stop_topic"):
        checks.pressed(cause)
    checks.yielded(0.11)
    for index, name in enumerate(NAMES):
        checks.moved(NAMES, index, -ORDERED, turns(**{name: -0.13}))
    checks.walked("crawl", "crawl", 0.1, 0.093)


@pytest.mark.parametrize(
    ("check", "words"),
    [
        (lambda: checks.hung({"front_left": 0.1, "rear_left": 5.3}, SHARE), "rear_left carries 5.3 N, at most 3.1 N"),
        (
            lambda: checks.stood({"front_left": 30.0, "rear_left": 2.0}, SHARE),
            "rear_left carries 2.0 N, at least 12.4 N",
        ),
        (lambda: checks.hung({"front_left": float("nan")}, SHARE), "front_left carries nan N"),
        (lambda: checks.stood({"front_left": float("nan")}, SHARE), "front_left carries nan N"),
        (lambda: checks.level(0.02, 0.4), r"\+0.02 and \+0.40 rad, at most ±0.15 rad: level the body"),
        (lambda: checks.green(doctor(swap="fault")), "fault swap: full; remedy: free it"),
        (lambda: checks.green(doctor(can="warning")), "warning can: full; remedy: free it"),
        (lambda: checks.green([each for each in doctor() if each["name"] != "can"]), "doctor.py has no line can: use"),
        (lambda: checks.charged(["battery_low"], 21.04), "reports battery_low: 21.0 V: charge the battery"),
        (lambda: checks.pressed(""), "no stop was latched: check cable"),
        (lambda: checks.pressed("tilt"), "latched by tilt, not by an e_stop_… cause"),
        (lambda: checks.yielded(0.8), "0.80 rad/s, at most 0.5 rad/s: let go of the legs"),
        (lambda: checks.walked("trot", "crawl", 0.2, 0.2), "the gait is 'crawl', ordered 'trot'"),
        (lambda: checks.walked("trot", "trot", 0.2, 0.01), "0.010 m/s ahead, ordered 0.200 m/s, at most 30 % off"),
        (lambda: checks.walked("trot", "trot", 0.2, -0.2), "-0.200 m/s ahead, ordered 0.200 m/s"),
        (lambda: checks.walked("trot", "trot", 0.2, float("nan")), "nan m/s"),
    ],
)
def test_a_measurement_beyond_its_rule_is_named_with_rule_and_remedy(check, words):
    with pytest.raises(StepError, match=words):
        check()


@pytest.mark.parametrize(
    ("measured", "words"),
    [
        (turns(), r"front_left_thigh_joint moved by \+0.004 rad, ordered \+0.150 rad: check the supply"),
        (turns(front_left_thigh_joint=-0.15), "moved by -0.150 rad, ordered .* the wrong direction"),
        (turns(rear_right_thigh_joint=0.15), "and rear_right_thigh_joint moved by .* exchange their keys"),
        (
            turns(front_left_thigh_joint=0.15, front_left_knee_joint=0.1),
            "front_left_knee_joint .* only one joint may move",
        ),
        (
            turns(front_left_thigh_joint=0.15, rear_left_knee_joint=-0.9),
            "rear_left_knee_joint .* only one joint may move",
        ),
        (turns(front_left_thigh_joint=0.08), r"at most 0.06 rad off, check range, gear"),
        (turns(front_left_thigh_joint=1.2, front_left_knee_joint=0.4), r"at most 0.06 rad off, .* sign of torque"),
    ],
    ids=[
        "no motion",
        "wrong sign",
        "exchanged motors",
        "two joints",
        "one falls",
        "wrong size",
        "torque of wrong sign",
    ],
)
def test_a_joint_that_does_not_move_as_ordered_is_named(measured, words):
    with pytest.raises(StepError, match=words):
        checks.moved(NAMES, NAMES.index("front_left_thigh_joint"), ORDERED, measured)


def odometry(yaw, x, y=0.0):
    """Velocities of the body in m/s, at this heading in rad."""
    message = Odometry()
    message.pose.pose.orientation.z, message.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    message.twist.twist.linear.x, message.twist.twist.linear.y = x, y
    return message


def test_the_speed_of_a_walk_is_that_towards_its_first_heading():
    assert speed_along(2.0, odometry(2.0, 0.2)) == pytest.approx(0.2)
    assert speed_along(2.0, odometry(2.0, -0.2)) == pytest.approx(-0.2)
    assert speed_along(2.0, odometry(2.0 + math.pi / 3, 0.2)) == pytest.approx(0.1)
    assert speed_along(2.0, odometry(2.0 + math.pi / 2, 0.0, -0.2)) == pytest.approx(0.2)


class Requests:
    """The services of a robot: each request is followed by these answers."""

    def __init__(self, *answers):
        self._answers, self.e_stops = list(answers), 0

    def e_stop(self):
        self.e_stops += 1
        return self.e_stops == 2  # the first one repeats a stop of a moment ago

    def poll(self):
        answers, self._answers = self._answers[:1], self._answers[1:]
        return answers


RESET = Answer("e_stop_reset", accepted=True, text="late")
TAKEN, REFUSED = (Answer(E_STOP, accepted=accepted, text="") for accepted in (True, False))


@pytest.mark.parametrize(
    ("answers", "state", "stopped"),
    [
        ([RESET, TAKEN], "STOPPED", True),
        ([TAKEN], "FAULT", True),
        ([RESET], "READY", False),
        ([RESET], "STOPPED", False),
        ([TAKEN], "STOPPING", False),
        ([TAKEN], "READY", False),
        ([REFUSED], "STOPPED", False),
        ([], "STOPPED", False),
    ],
)
def test_a_robot_counts_as_stopped_by_the_answer_to_this_stop_and_by_its_state(monkeypatch, answers, state, stopped):
    monkeypatch.setattr(robot, "ANSWER", 0.15)
    stopping = robot.WatchedRobot.__new__(robot.WatchedRobot)
    stopping._services, stopping._watch = Requests(*answers), SimpleNamespace(message=SafetyStatus(state_name=state))
    assert stopping.stop() is stopped
    assert stopping._services.e_stops == 2


@pytest.mark.parametrize("error", [StepError("tail hurts"), NoAnswerError("interrupted")])
def test_the_first_step_that_fails_is_the_last_one(error, monkeypatch):
    done = []

    def fails(_):
        raise error

    monkeypatch.setitem(STEPS, "hang", ("", done.append))
    monkeypatch.setitem(STEPS, "doctor", ("", fails))
    results = dict.fromkeys(("hang", "doctor", "battery"), "not done")
    assert take(list(results), None, results) == ("doctor", str(error))
    assert results == {"hang": "passed", "doctor": "failed", "battery": "not done"}
    assert done == [None]


def test_the_command_line():
    assert parse_options(["--from", "joints"]).begin == "joints"
    assert parse_options([]).begin == next(iter(STEPS))
    with pytest.raises(SystemExit):
        parse_options(["--from", "jump"])
