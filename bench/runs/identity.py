"""A process that runs seeds proves its identity before its outcomes count: same sources, same robots, same numbers."""

from __future__ import annotations

import hashlib
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from robot_control.loop.closed_loop import ClosedLoop

from bench.robot_corpus import robot_names, urdf_of

UNKNOWN = "unknown"
"""The commit of sources that are no git checkout."""


@dataclass(frozen=True)
class Identity:
    """Identity of one process."""

    commit: str  # with "-dirty" where files differ from it
    robots: str  # SHA-256 of the descriptions of all robots there
    reference: str  # SHA-256 of the log of a reference run

    def difference(self, other: Identity) -> str:
        """The part in which `other` differs; empty if there is none."""
        if self.commit != other.commit:
            return f"its commit is {other.commit}, here it is {self.commit}"
        if self.robots != other.robots:
            return f"its robot descriptions have the checksum {other.robots:.12}, those here {self.robots:.12}"
        if self.reference != other.reference:
            return f"its reference run has the checksum {other.reference:.12}, the one here {self.reference:.12}"
        return ""


@cache
def identity() -> Identity:
    """Identity of this process; the first call takes a second."""
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
    """Sum of all columns of the log of half a second in a curve."""
    log = ClosedLoop(seed=1).run(0.5, (0.5, 0.2))
    digest = hashlib.sha256()
    for name in sorted(log):
        digest.update(f"{name}\n".encode())
        digest.update(log[name].tobytes())
    return digest.hexdigest()
