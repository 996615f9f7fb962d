"""A check examines one property of the machine; its finding is a verdict with value and remedy."""

from __future__ import annotations

import enum
from collections.abc import Callable
from dataclasses import dataclass

from robot_control.setup.doctor.system import System


class Verdict(enum.Enum):
    """The verdict on one property, from good to bad."""

    OK = "ok"
    NOTE = "note"
    """It works; the remedy makes it better."""
    UNSEEN = "unseen"
    """This machine does not show it, so nothing is claimed."""
    WARNING = "WARNING"
    """It disturbs the robot at times, or will."""
    FAULT = "FAULT"
    """The robot cannot work as it is configured."""

    def __call__(self, value: str, remedy: str = "", *commands: str) -> Finding:
        """A finding with this verdict."""
        return Finding(self, value, remedy, commands)


@dataclass(frozen=True)
class Finding:
    """The result of one check."""

    verdict: Verdict
    value: str
    remedy: str = ""
    commands: tuple[str, ...] = ()
    """Commands of the shell that carry out the remedy, for --fix."""


@dataclass(frozen=True)
class Check:
    """A property that is examined, and the reason why it matters."""

    name: str
    why: str
    examine: Callable[[System], Finding]


ok, note, warning, fault, unseen = Verdict.OK, Verdict.NOTE, Verdict.WARNING, Verdict.FAULT, Verdict.UNSEEN
