"""The quality of one operator's link, and the speed that it allows. It reads no clock: time is an argument, in s.

    round trip   of a ping of this server, by this server's clock alone; a ping without an answer counts with its age
    delay        receipt − time of sending by the page's clock: one-way delay plus the offset of two foreign clocks
    excess       delay − the least delay of the last WINDOW: what this message took longer than the fastest one
    speed cap    distance / (RTT95 + reaction), approached by FALL and RISE

RTT95 is the 95th percentile over ROUND_TRIPS pings.
"""

import math
from collections import deque

ROUND_TRIPS = 100
"""pings; at 10 per second those of 10 s"""
FIRST = 3
"""answered pings without which the quality is not known, and no speed is allowed"""
WINDOW = 30.0
"""s; two quartz clocks drift apart by at most 6 ms in it (200 ppm)"""
FALL, RISE = 1.0, 0.3
"""m/s²; below the deceleration of the default robot, and slow enough for an operator to follow"""


class RoundTrips:
    """Pings and their answers."""

    def __init__(self) -> None:
        self._waiting: dict[str, float] = {}  # sent and not answered, the oldest first
        self._measured: deque[float] = deque(maxlen=ROUND_TRIPS)

    def ping(self, name: str, now: float) -> None:
        """Notes that the ping `name`, which cannot be guessed, is sent now."""
        self._waiting[name] = now
        while len(self._waiting) > ROUND_TRIPS:
            self._waiting.pop(next(iter(self._waiting)))

    def pong(self, name: str, now: float) -> None:
        """Takes an answer; one without its ping does not count."""
        sent = self._waiting.pop(name, None)
        if sent is not None:
            self._measured.append(now - sent)

    def last(self) -> float:
        """s; infinite until it is known."""
        return self._measured[-1] if self._measured else math.inf

    def percentile95(self, now: float) -> float:
        """s; infinite until it is known."""
        if len(self._measured) < FIRST:
            return math.inf
        waiting = [now - sent for sent in self._waiting.values()]
        known = sorted([*self._measured, *(age for age in waiting if age > min(self._measured))])[-ROUND_TRIPS:]
        return known[math.ceil(0.95 * len(known)) - 1]


class Excess:
    """The time that a message took longer than the fastest one of its link."""

    def __init__(self) -> None:
        self._least = self._least_before = math.inf  # of this window and the one before
        self._since = -math.inf

    def of(self, sent: float, now: float) -> float:
        """s, from zero on; `sent` by the page's clock."""
        if now - self._since > WINDOW:
            self._since, self._least_before, self._least = now, self._least, math.inf
        self._least = min(self._least, now - sent)
        return now - sent - min(self._least, self._least_before)


class SpeedCap:
    """The speed that the link allows."""

    def __init__(self, distance: float, reaction: float) -> None:
        """`distance` in m, `reaction` in s."""
        self._distance, self._reaction = distance, reaction
        self._at: float | None = None
        self.value = 0.0  # m/s

    def step(self, round_trip: float, now: float) -> float:
        """m/s; `round_trip`: RTT95, infinite if it is not known."""
        elapsed, self._at = 0.0 if self._at is None else now - self._at, now
        target = self._distance / (round_trip + self._reaction)
        self.value = (
            max(target, self.value - FALL * elapsed)
            if target < self.value
            else (min(target, self.value + RISE * elapsed))
        )
        return self.value
