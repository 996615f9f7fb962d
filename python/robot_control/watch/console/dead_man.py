"""The dead-man law of a link: the input of one page, by keys, stick or pad. It reads no clock: time is an argument, s.

The page sends its state every 50 ms while it commands, held or not. The law of pad.py decides what that state moves.
Motion counts while it is held, was seen released before, and no stop or pause lies between (pad/law.py).

    number        rises by each message; one that does not rise is a replay and does not count
    excess        above link_gap: the message is late and is dropped
    stamp         receipt − excess, of the newest message that counts
    command_life  stamp older than that: zero, until the next message
    link_gap      stamp older than that: all ends, until a release that comes SETTLING after the gap
"""

import math
from dataclasses import dataclass, replace

from robot_control.drive.pad_law import Pad, PadParameters
from robot_control.robot.command import Command
from robot_control.watch.console.link import Excess, RoundTrips, SpeedCap
from robot_control.watch.console.settings import Settings


@dataclass(frozen=True)
class Drive:
    """One message of a page."""

    number: int
    sent: float  # s, by the page's clock
    held: bool
    linear: float = 0.0  # share of the chosen speed, −1 … 1, forward
    angular: float = 0.0  # the same, turning to the left
    lateral: float = 0.0  # the same, sideways to the left


class DeadMan:
    """The state of one page."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        axes = PadParameters(axis_linear=0, axis_angular=1, axis_lateral=2, enable_button=0)
        axes = replace(axes, scale_linear=1.0, scale_angular=1.0, scale_lateral=1.0)
        self.pad = Pad(replace(axes, enable_turbo_button=-1, joy_timeout=settings.link_gap))
        self._excess = Excess()
        self.round_trips = RoundTrips()
        self.cap = SpeedCap(settings.distance, settings.reaction)
        self._number, self._held = -1, False
        self.stamp = -math.inf  # s
        self._gap = True  # a gap has been noticed, and no message has come since
        self.gaps = self.late = self.replayed = 0
        self._ended = ""  # why the last motion ended without its release

    def receive(self, drive: Drive, now: float) -> None:
        """Receives a message."""
        if drive.number <= self._number:
            self.replayed += 1
            return
        self._number = drive.number
        self._notice_gap(now)
        excess = self._excess.of(drive.sent, now)
        if excess > self._settings.link_gap:
            self.late += 1
            return
        self.stamp, self._gap, self._held = now - excess, False, drive.held
        self._ended = self._ended if drive.held else ""
        self.pad.receive((drive.linear, drive.angular, drive.lateral), (int(drive.held),), now)

    def alive(self, now: float) -> bool:
        """True while messages arrive."""
        return now - self.stamp <= self._settings.link_gap

    def interrupt(self, now: float, why: str) -> None:
        """Ends the motion; a release has to come SETTLING later."""
        self._ended = why if self._held else self._ended
        self.pad.interrupt(now)

    def share(self, now: float) -> Command | None:
        """Shares of the chosen speeds to command now; None if nothing is sent."""
        self._notice_gap(now)
        share = self.pad.command(now)
        return share if share is None or now - self.stamp <= self._settings.command_life else Command()

    def state(self, now: float) -> str:
        """The state as text; empty if the page may drive."""
        if self._gap:
            return "no message on the link"
        words = self.pad.state(now)
        if words == "release the enable button once":
            return f"release everything once{f': {self._ended}' if self._ended else ''}"
        return words if words.startswith("drives") else ""

    def _notice_gap(self, now: float) -> None:
        if not self._gap and not self.alive(now):
            self._gap = True
            self.gaps += 1
            self.interrupt(now, f"no message on the link for {1000 * self._settings.link_gap:.0f} ms")
