"""The answer of why.py as lines of text, as wide as the screen; no ROS in here."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from robot_control.files.files import escaped
from robot_control.robot.diagnosis.answer import Answer, Verdict
from robot_control.robot.diagnosis.diagnosis import judge, missing_nodes, senders_in_words
from robot_control.robot.diagnosis.state import Facts, Safety, speeds
from robot_control.ui.columns import padded, wrapped
from robot_control.watch.words.words import ENGLISH, Words

LABEL = 11
"""columns for the word before each line"""
NARROWEST = 40
"""columns; below that words no longer fit beside their label"""

COLOURS = {Verdict.STOPPED: "31;1", Verdict.IDLE: "33;1", Verdict.MOVING: "32;1"}
"""SGR of ECMA-48: red, yellow, green; bold."""
DIM = "2"
BOLD = "1"
COMMAND = "$ "
"""Begin of a line for a shell, which stays as it is."""


@dataclass(frozen=True)
class Layout:
    """Format of the answer."""

    width: int = 80  # columns; no line is longer
    colour: bool = False  # with escape sequences, for a terminal
    times: bool = True  # with values that change by themselves, speeds and seconds
    words: Words = ENGLISH

    def paint(self, text: str, style: str) -> str:
        """The text in SGR `style`."""
        return f"\x1b[{style}m{text}\x1b[0m" if self.colour and style and text.strip() else text


PLAIN = Layout()


def render(facts: Facts, layout: Layout = PLAIN) -> list[str]:
    """One screen, a line each."""
    answer = judge(facts)
    width = max(layout.width, NARROWEST)
    lines = [layout.paint(line, COLOURS[answer.verdict]) for line in wrapped(_headline(answer, layout), width)]
    lines.append("")
    for label, text, style in _rows(facts, answer, layout):
        shown = text if text.startswith(COMMAND) else layout.words.of(text)
        for number, line in enumerate(_wrap(shown, width - LABEL)):
            head = padded(layout.words.of(label) if number == 0 else "", LABEL)
            lines.append((layout.paint(head, DIM) + layout.paint(line, style)).rstrip())
    return lines


def _headline(answer: Answer, layout: Layout) -> str:
    still = answer.verdict is Verdict.MOVING and not layout.times
    return escaped(layout.words.of("Moving." if still else answer.headline))


def _wrap(text: str, width: int) -> list[str]:
    line = escaped(text.replace("\n", " "))
    return wrapped(line, width, indent="  ") or [""]


Rows = Iterator[tuple[str, str, str]]


def _rows(facts: Facts, answer: Answer, layout: Layout) -> Rows:
    yield from _to_do(answer)
    safety = facts.received()
    if safety is not None:
        yield from _safety(safety, facts, layout)
    yield from _nodes(facts)
    if any(facts.there(node) for node in facts.loop):
        yield from _command(facts, layout)
        yield from _gate(facts)
    yield from _circumstances(facts)


def _list(label: str, texts: Iterable[str], style: str = "") -> Rows:
    for text in texts:
        yield label, text, style
        label = ""


def _to_do(answer: Answer) -> Rows:
    yield from _list("to do", (f"{actor}: {text}" if actor else text for actor, text in answer.actions), BOLD)
    for command in answer.commands:
        yield "", f"{COMMAND}{command}", ""
    if answer.actions or answer.commands:
        yield "", "", ""


def _safety(safety: Safety, facts: Facts, layout: Layout) -> Rows:
    since = f" for {_duration(safety.held)}" if layout.times else ""
    yield "safety", f"{safety.state}{since}, permit: {safety.permit}", ""
    causes = []
    for cause in sorted(safety.causes, key=lambda cause: not cause.first):
        marks = [word for word, true in (("first", cause.first), ("still true", cause.active)) if true]
        measured = f": {cause.detail}" if cause.detail else ""
        mark = f" [{', '.join(marks)}]" if marks else ""
        causes.append(f"{cause.name}: {cause.sentence}{measured}{mark}")
    yield from _list("causes", causes)
    yield from _list("warnings", safety.warnings, "33")
    if facts.speed_limit < float("inf"):
        what = "" if facts.kind.legged else " at each rim"
        whose = "a warning or clearance" if safety.warnings else "clearance"
        yield "limit", f"at most {facts.speed_limit:.3g} m/s{what}, by {whose}", ""
    yield from _list("last reset", (f"refused: {refusal}" for refusal in safety.refusal))


def _nodes(facts: Facts) -> Rows:
    absent = missing_nodes(facts)
    words = []
    for node in facts.loop:
        if node in absent or (not facts.there(node) and facts.received() is None):
            words.append(f"{node} MISSING")
        elif not facts.there(node):
            words.append(f"{node} silent")
        else:
            words.append(node)
    yield "nodes", ", ".join(words), ""


def _command(facts: Facts, layout: Layout) -> Rows:
    yield "requests", f"published by {senders_in_words(facts)}", ""
    sources = facts.sources()
    if sources:
        yield "sources", ", ".join(f"{name}: {state}" for name, state in sources.items()), ""
    posture = facts.value(facts.controller, "posture")
    if posture:
        yield "posture", posture, ""
    if layout.times and (not facts.kind.legged or posture == "walking"):
        yield from _speeds(facts)
    reasons = "; ".join(facts.reasons(facts.controller, "command").values())
    if reasons:
        yield "controller", reasons, ""


def _speeds(facts: Facts) -> Rows:
    requested = [facts.value(facts.controller, key) for key in ("requested_m_s", "requested_rad_s")]
    parts = []
    if all(requested):
        parts.append(f"requested {speeds((float(requested[0]), float(requested[1])))}")
    if facts.limited is not None:
        parts.append(f"after limits {speeds(facts.limited)}")
    if facts.measured is not None:
        parts.append(f"measured {speeds(facts.measured)}")
    if parts:
        yield "", "; ".join(parts), ""


def _gate(facts: Facts) -> Rows:
    verdict = facts.value(facts.driver, "gate_verdict")
    if not verdict:
        return
    reasons = "; ".join(facts.reasons(facts.driver, "gate").values())
    yield "gate", f"{verdict}: {reasons}" if reasons else verdict, ""


def _circumstances(facts: Facts) -> Rows:
    estimator = facts.kind.estimator
    faults, machine, suspicious = (facts.value(facts.driver, key) for key in ("injected", "machine", "suspicious"))
    if faults not in {"", "none"}:
        yield "injected", faults, "33"
    said = {node: facts.reports[node].message for node in facts.loop if facts.there(node)}
    yield from _list("real time", (f"{node}: {text}" for node, text in said.items() if "not real-time" in text), "33")
    if machine:
        yield "machine", machine, ""
    if suspicious:
        yield "suspicious", suspicious, "33"
    slip = facts.reasons(estimator, "slip").values()
    if slip or "slip" in facts.value(estimator, "flags").split():
        yield "slip", "; ".join(slip) or "wheels and inertial sensors disagree", "33"
    for key, prefix in (("estimate", ""), ("degraded", "degraded: ")):
        reasons = facts.reasons(estimator, key).values()
        if reasons:
            yield "odometry", prefix + "; ".join(reasons), "33"
    detection = facts.value(estimator, "slip_detection")
    if detection.startswith(("slow", "off")):
        yield "odometry", f"slip detection is {detection}", ""
    if not facts.master_answers and facts.received() is not None:
        yield (
            "master",
            f"{facts.master} does not answer: connected nodes continue, no new one can connect; restart the nodes",
            "33",
        )


def _duration(seconds: float) -> str:
    if seconds < 60:
        return f"{max(0.0, seconds):.0f} s"
    if seconds < 3600:
        return f"{seconds // 60:.0f} min {seconds % 60:.0f} s"
    return f"{seconds // 3600:.0f} h {seconds % 3600 // 60:.0f} min"
