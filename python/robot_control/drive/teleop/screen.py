"""The screen of teleop.py: lines of text for 80 × 24, in one colour. Pure."""

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass

from robot_control.drive.keys.key_map import KeyMap
from robot_control.robot.command import Command
from robot_control.robot.diagnosis.answer import Verdict
from robot_control.robot.diagnosis.diagnosis import judge
from robot_control.robot.diagnosis.state import Facts

WIDTH, HEIGHT = 80, 24
LABEL = 10
"""columns of the word before each line"""
MAX_LINES = {"to do": 3, "causes": 3, "answer": 3, "warnings": 2, "limits": 2}
"""lines of each label, so that all of them find room"""


@dataclass(frozen=True)
class View:
    """The values that are shown beside the facts about the robot."""

    keys: KeyMap
    topic: str  # absolute
    own_name: str  # of this node
    chosen: Command  # the speeds of a held key
    requested: Command | None  # what is sent now; None: nothing
    held: str = ""  # the held key and the kind of hold
    sent_age: float | None = None  # s since the last command; None: none was sent
    message: str = ""  # of this program
    answer: str = ""  # of the last e-stop or reset
    releases: bool = False  # the terminal reports releases


def render(facts: Facts, view: View, height: int = HEIGHT) -> list[str]:
    """The screen, at most HEIGHT lines of at most WIDTH columns, for a terminal of `height` lines. In a lower terminal
    the body is cut. The foot with the keys of the emergency stop stays, if need be its last line alone.
    """
    height = min(height, HEIGHT)
    safety = facts.received()
    state = "no safety_status" if safety is None else f"{safety.state}, permit: {safety.permit}"
    left, legged = f"teleop {facts.namespace}", facts.kind.legged
    foot = ["-" * WIDTH, *view.keys.help][-height:]
    body = [
        f"{left}{state:>{WIDTH - len(left)}}",
        "-" * WIDTH,
        f"{'':14}{'linear m/s':>12}{'angular rad/s':>16}{'sideways m/s' if legged else '':>15}".rstrip(),
        _speeds("chosen", view.chosen, legged=legged),
        _speeds("requested", view.requested, view.held, legged=legged),
        _speeds("after limits", None if facts.limited is None else Command(*facts.limited), legged=legged),
        _speeds("measured", None if facts.measured is None else Command(*facts.measured), legged=legged),
        "",
        *_wrapped(_headline(facts), "", 2),
    ]
    for label, text in _rows(facts, view):
        body += _wrapped(text, label, MAX_LINES.get(label, 2))
    body = body[: height - len(foot)]
    body += [""] * (height - len(foot) - len(body))
    return [line[:WIDTH].rstrip() for line in body + foot]


def _headline(facts: Facts) -> str:
    answer = judge(facts)
    return "Ready: hold a key." if answer.verdict is Verdict.IDLE else answer.headline


def _speeds(label: str, speeds: Command | None, note: str = "", *, legged: bool = False) -> str:
    values = ["-"] * 3 if speeds is None else [_number(one) for one in (speeds.linear, speeds.angular, speeds.lateral)]
    return f"{label:<14}{values[0]:>12}{values[1]:>16}{values[2] if legged else '':>{15 if legged else 0}}    {note}"


def _number(value: float) -> str:
    return f"{round(value, 2) + 0.0:.2f}"  # + 0.0: no minus sign before a zero


def _rows(facts: Facts, view: View) -> Iterator[tuple[str, str]]:
    answer, safety = judge(facts), facts.received()
    if view.message:
        yield "keys", view.message
    if view.answer:
        yield "answer", view.answer
    yield "command", _command(facts, view)
    idle = answer.verdict is Verdict.IDLE
    if answer.actions and not idle:
        yield "to do", "; ".join(f"{actor}: {text}" if actor else text for actor, text in answer.actions)
    if safety is not None and safety.causes:
        first = sorted(safety.causes, key=lambda cause: not cause.first)
        yield "causes", "; ".join(f"{c.sentence} ({c.detail})" if c.detail else c.sentence for c in first)
    reasons = facts.reasons(facts.controller, "command").values()
    if reasons and not idle:
        yield "limits", "; ".join(reasons)
    if safety is not None and safety.warnings:
        yield "warnings", "; ".join(safety.warnings)


def _command(facts: Facts, view: View) -> str:
    if view.requested is None or view.sent_age is None:
        own = f"no command is sent on {view.topic} now"
    else:
        own = f"sent on {view.topic}, {1000 * view.sent_age:.0f} ms ago"
    others = [name for name in facts.commanders() if name != view.own_name]
    end = "a release ends the motion" if view.releases else "a key counts while it repeats"
    return f"{own}; also commanding: {', '.join(others) or 'no node'}; {end}"


def _wrapped(text: str, label: str, max_lines: int) -> list[str]:
    width = WIDTH - LABEL if label else WIDTH
    lines = textwrap.wrap(text, width, max_lines=max_lines, placeholder=" ... (why.py)", break_on_hyphens=False)
    return [f"{label if number == 0 else '':<{LABEL if label else 0}}{line}" for number, line in enumerate(lines)]
