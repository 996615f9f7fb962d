"""The form of the answer of why.py."""

from dataclasses import dataclass
from enum import Enum


class Verdict(Enum):
    """The answer in one word."""

    STOPPED = "stopped"  # something prevents motion
    IDLE = "idle"  # it may move, but no motion is requested
    MOVING = "moving"


@dataclass(frozen=True)
class Answer:
    """The answer for a user."""

    verdict: Verdict
    headline: str
    actions: tuple[tuple[str, str], ...] = ()  # the role that has to act ("" if any may), and the action
    commands: tuple[str, ...] = ()  # lines for a shell
