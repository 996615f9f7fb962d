"""What a process that runs seeds proves before its outcomes count: same sources, same robots, same numbers."""

from __future__ import annotations

import hashlib
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from robot_control.closed_loop import ClosedLoop

from lab.robot_corpus import robot_names, urdf_of

UNKNOWN = "unknown"
"""The commit where the sources are no git checkout."""


@dataclass(frozen=True)
class Identity:
    """Of one process."""

    commit: str  # with "-dirty" where files differ from it
    robots: str  # SHA-256 of the descriptions of all robots there
    reference: str  # SHA-256 of the log of a reference run

    def difference(self, other: Identity) -> str:
        """In which of the three `other` differs; empty where in none."""
        if self.commit != other.commit:
            return f"its commit is {other.commit}, here it is {self.commit}"
        if self.robots != other.robots:
            return f"its robot descriptions have the checksum {other.robots:.12}, those here {self.robots:.12}"
        if self.reference != other.reference:
            return f"its reference run has the checksum {other.reference:.12}, the one here {self.reference:.12}"
        return ""


@cache
def identity() -> Identity:
    """Of this process; the first call takes a second."""
    return Identity(_commit(), _robots(), _reference())


def _commit() -> str:
    command = ["git", "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    folder = Path(__file__).resolve().parent
    described = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return described.stdout.strip() or UNKNOWN


def _robots() -> str:
    digest = hashlib.sha256()
    for name in robot_names():
        digest.update(f"{name}\n".encode())
        digest.update(Path(urdf_of(name)).read_bytes())
    return digest.hexdigest()


def _reference() -> str:
    """Of half a second of driving a curve, all columns of the log."""
    log = ClosedLoop(seed=1).run(0.5, (0.5, 0.2))
    digest = hashlib.sha256()
    for name in sorted(log):
        digest.update(f"{name}\n".encode())
        digest.update(log[name].tobytes())
    return digest.hexdigest()
