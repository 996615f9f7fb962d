"""The findings as lines, as JSON, and as commands."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from robot_control.setup.doctor.finding import Finding, Verdict

EXIT_CODES = {Verdict.WARNING: 1, Verdict.FAULT: 2}


@dataclass(frozen=True)
class Row:
    """A check with its finding, and the group to which it belongs."""

    group: str
    name: str
    why: str
    finding: Finding


def exit_code(rows: Sequence[Row]) -> int:
    """2 with a fault, else 1 with a warning, else 0."""
    return max((EXIT_CODES.get(row.finding.verdict, 0) for row in rows), default=0)


def lines(rows: Sequence[Row]) -> list[str]:
    """One line per check: verdict, name, value, why it matters, remedy; at last their numbers."""
    shown = []
    for row in rows:
        remedy = f"; remedy: {row.finding.remedy}" if row.finding.remedy else ""
        head = f"{row.finding.verdict.value:<8} {row.name:<21}"
        shown.append(one_line(f"{head} {row.finding.value} [{row.why}]{remedy}"))
    counts = [(sum(row.finding.verdict is verdict for row in rows), verdict) for verdict in reversed(Verdict)]
    return [*shown, ", ".join(f"{count} {verdict.value}" for count, verdict in counts)]


def as_json(rows: Sequence[Row]) -> str:
    """The same for programs."""
    checks = [
        {"group": row.group, "name": row.name, "why": row.why}
        | asdict(row.finding)
        | {"verdict": row.finding.verdict.value.lower()}
        for row in rows
    ]
    return json.dumps({"exit_code": exit_code(rows), "checks": checks}, indent=2, ensure_ascii=False)


def commands(rows: Sequence[Row]) -> list[str]:
    """The commands of all remedies; the worst first. They are printed, never run."""
    order = (Verdict.FAULT, Verdict.WARNING, Verdict.NOTE)
    listed = []
    for row in sorted(
        (row for row in rows if row.finding.verdict in order), key=lambda row: order.index(row.finding.verdict)
    ):
        listed.append(f"# {row.finding.verdict.value} {row.name}: {one_line(row.finding.value)}")
        listed += map(one_line, row.finding.commands or [f"#   {row.finding.remedy}"])
    return listed or ["# nothing to repair"]


def one_line(text: str) -> str:
    """The text with `?` for each control character: names of threads and files are foreign."""
    return "".join(sign if sign.isprintable() else "?" for sign in text)
