"""Reads what librobot_control_tripwire.so writes at the end of a node (tests/realtime/tripwire.cpp)."""

import subprocess
from dataclasses import dataclass, field
from pathlib import Path

PLANTED = {
    "planted_allocation": "allocation",
    "planted_contended_lock": "lock",
    "planted_log_line": "system call",
    "planted_first_touch": "page fault",
    "planted_file_read": "system call",
    "planted_exception": "exception",
    "planted_sleep": "system call",
}
"""Function → the kind of violation that it must be found as."""


@dataclass
class Violation:
    """One stack of one thread."""

    headline: str
    """kind, number of the system call, thread, count"""
    frames: list[tuple[str, str, str]] = field(default_factory=list)
    """object, offset, exported function; innermost first"""

    @property
    def planted(self) -> str:
        """The planted function in its stack; empty for a violation of the product."""
        return next((function for _, _, function in self.frames if function in PLANTED), "")

    def in_words(self) -> str:
        """With the names of functions that are not exported."""
        return "\n    ".join([self.headline, *(_named(*frame) for frame in self.frames)])


@dataclass
class Report:
    """The report of one process."""

    watched: int = 0
    unwatched: list[str] = field(default_factory=list)
    violations: list[Violation] = field(default_factory=list)

    def own(self) -> list[Violation]:
        """Those that were not planted."""
        return [violation for violation in self.violations if not violation.planted]

    def found(self) -> set[tuple[str, str]]:
        """The planted functions with the kinds as which they were found."""
        return {
            (each.planted, kind)
            for each in self.violations
            if each.planted
            for kind in set(PLANTED.values())
            if each.headline.startswith(kind)
        }


def read_report(path: Path) -> Report:
    report = Report()
    for line in path.read_text().splitlines():
        if line.startswith("  "):
            name, offset, function = line.split()
            report.violations[-1].frames.append((name, offset, function))
        elif line.startswith("watched "):
            report.watched = int(line.split()[1])
        elif line.startswith("unwatched "):
            report.unwatched.append(line)
        else:
            report.violations.append(Violation(line))
    return report


def _named(name: str, offset: str, exported: str) -> str:
    found = subprocess.run(
        ["addr2line", "-Cfe", name, offset], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
    ).stdout.splitlines()
    function = found[0] if found and not found[0].startswith("??") else exported
    return f"{Path(name).name} {offset} {function}"
