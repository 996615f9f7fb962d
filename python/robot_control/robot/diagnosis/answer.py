"""The form of the answer of why.py."""

from dataclasses import dataclass
from enum import Enum

RESET, THEN_RESET = "call e_stop_reset", "then call e_stop_reset"
"""The last action after a stop; for an operator with a console it is a button."""


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

    @property
    def sentence(self) -> str:
        """The headline for an operator: of a robot that is ready without the reason behind it."""
        parts = self.headline.split(": ")
        return self.headline if len(parts) < 3 or parts[0] != "Ready" else f"{parts[0]}: {parts[1]}."

    @property
    def steps(self) -> tuple[str, ...]:
        """The operator's actions before the reset."""
        return tuple(text for actor, text in self.actions if _is_operators(actor) and text not in {RESET, THEN_RESET})

    @property
    def integrator(self) -> tuple[tuple[str, str], ...]:
        """The actions of all others."""
        return tuple((actor, text) for actor, text in self.actions if not _is_operators(actor))


def _is_operators(actor: str) -> bool:
    return actor in {"", "operator"}
