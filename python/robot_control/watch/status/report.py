"""What the robot's nodes said lately → RobotStatus. Pure but for the message types."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from diagnostic_msgs.msg import DiagnosticStatus

from robot_control.loop.roles import Kind
from robot_control.msg import RobotStatus, SafetyStatus
from robot_control.robot.diagnosis.lateness import REMEDY, SENTENCE, late, load_in_words
from robot_control.robot.diagnosis.recent import values_of
from robot_control.robot.safety_states import DRIVABLE

MANUAL_SOURCES = frozenset({"joy_vel", "key_vel", "console_vel"})
MANUAL_NODES = ("teleop", "pad", "console")
"""Begins of the names of nodes with which a person drives"""


@dataclass(frozen=True)
class Reports:
    """The last report of each node that is recent enough to count."""

    safety: SafetyStatus | None = None
    diagnostics: Mapping[str, DiagnosticStatus] = field(default_factory=dict)  # by node, below the namespace
    kind: Kind = field(default_factory=Kind)
    commander: str = ""  # from drive_state, if there is a list of command sources
    posture: str = ""  # from leg_state
    busy: bool = False  # more programs want to run than there are cores

    def value(self, node: str, key: str) -> str:
        """A value in a node's report; empty if it is not there."""
        report = self.diagnostics.get(node)
        return "" if report is None else values_of(report).get(key, "")


def status_of(reports: Reports) -> RobotStatus:
    """All but stamp, version and uptime."""
    status = RobotStatus()
    senders = reports.value(reports.kind.controller, "senders")
    status.senders = senders.split(", ") if senders else []
    status.commander = reports.commander
    status.posture = reports.posture
    status.health, status.problems = _health(reports)
    if reports.safety is not None:
        status.safety_state = reports.safety.state_name
        status.causes, status.sentences = reports.safety.causes, reports.safety.sentences
        status.remedies, status.warnings = reports.safety.remedies, reports.safety.warning_sentences
    status.mode = _mode(status)
    status.odometry_confidence = _confidence(reports)
    status.machine = _machine(reports)
    status.data_return = reports.value("data_return", "progress")
    status.odometry_degraded = bool(reports.value(reports.kind.estimator, "degraded"))
    return status


def _mode(status: RobotStatus) -> str:
    if not status.safety_state:
        return "offline"
    if status.safety_state == "INIT":
        return "starting"
    if status.safety_state not in DRIVABLE:
        return "stopped"
    if status.commander:
        return "manual" if status.commander in MANUAL_SOURCES else "automatic"
    names = [sender.rpartition("/")[2] for sender in status.senders]
    if not names:
        return "idle"
    return "manual" if all(name.startswith(MANUAL_NODES) for name in names) else "automatic"


def _health(reports: Reports) -> tuple[int, list[str]]:
    levels, problems = [RobotStatus.OK], []
    silent = [
        node for node in reports.kind.loop[1:] if node not in reports.diagnostics
    ]  # the driver has other names, too
    levels += [RobotStatus.ERROR] * len(silent)
    problems += [f"{node} is silent" for node in silent]
    for node, report in sorted(reports.diagnostics.items()):
        if report.level != DiagnosticStatus.OK:
            levels.append(RobotStatus.WARN if report.level == DiagnosticStatus.WARN else RobotStatus.ERROR)
            problems.append(f"{node}: {report.message}")
    if reports.safety is not None and late(reports.safety.first_cause, silent, delayed=reports.busy):
        problems.insert(0, f"{SENTENCE}: {load_in_words()}; {REMEDY}")
    return max(levels), problems


def _machine(reports: Reports) -> str:
    """The description by the driver, whichever node that is."""
    return next((text for node in sorted(reports.diagnostics) if (text := reports.value(node, "machine"))), "")


def _confidence(reports: Reports) -> float:
    flags = reports.value(reports.kind.estimator, "flags")
    if reports.kind.estimator not in reports.diagnostics:
        return math.nan
    if "valid" not in flags.split():
        return 0.0
    try:
        return float(reports.value(reports.kind.estimator, "odometry_confidence"))
    except ValueError:
        return math.nan


def changed(new: RobotStatus, old: RobotStatus) -> bool:
    """True if the state differs, not merely its numbers; it is then published at once."""
    names = [name for name in new.__slots__ if name not in {"header", "uptime", "odometry_confidence", "data_return"}]
    return any(getattr(new, name) != getattr(old, name) for name in names)
