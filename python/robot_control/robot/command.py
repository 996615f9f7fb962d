"""A velocity that a program commands, and the pace at which it is sent. Pure."""

from collections.abc import Callable
from dataclasses import dataclass

SEND_PERIOD = 0.05
"""s between two messages of the same command; a change is sent at once"""


@dataclass(frozen=True)
class Command:
    """A velocity."""

    linear: float = 0.0  # m/s
    angular: float = 0.0  # rad/s
    lateral: float = 0.0  # m/s, to the left; robots on wheels ignore it


class Pace:
    """Publishes a command when it changes, and again every SEND_PERIOD."""

    def __init__(self, send: Callable[[Command], None]) -> None:
        self._send = send
        self.last: Command | None = None  # command at the last call; None: there was nothing to send
        self.sent_at: float | None = None  # s, as `now`

    def step(self, command: Command | None, now: float) -> None:
        """Updates the pace with the present command; None means that nothing is commanded."""
        due = self.sent_at is None or now - self.sent_at >= SEND_PERIOD
        if command is not None and (due or command != self.last):
            self._send(command)
            self.sent_at = now
        self.last = command
