"""The dead-man switch of a terminal, which reports no key release: a key is held while its byte repeats. Pure.

    press              the first byte of a key; it holds for `first_hold`, and only slowly until the first repeat
    repeat             a later byte of the same key; it holds for `hold`
    burst              bytes less than BURST apart, which no keyboard sends: a link that had stalled delivers them. They
                       count as one byte, and begin no motion, since they are old: that key has to pause. After a stop
                       among them no motion key of the same burst counts
    change of keys     while one key is held, another takes over at once and at the same speed
    max_hold           a motion whose keys repeat for so long without a pause ends in zero, until all of its keys have
                       paused for `first_hold`

`first_hold` has to exceed the keyboard's delay until the first repeat, which is measured (RepeatDelay).
Times are s of any one clock that never turns back.
"""

from collections import deque
from collections.abc import Hashable, Mapping
from dataclasses import dataclass

BURST = 0.01
"""s; the fastest keyboards repeat every 20 ms"""
MIN_DELAY = 0.15
"""s; below the shortest usual delay until the first repeat (0.25 s), above the time between two quick taps"""
SLOWEST_REPEAT = 0.12
"""s; keyboards repeat at 10 to 50 Hz"""
MARGIN = 0.1
"""s that the first hold exceeds the measured delay by"""


@dataclass(frozen=True)
class HoldParameters:
    """Durations of the holds."""

    first_hold: float = 0.7  # s; most desktops repeat after 0.25 to 0.66 s
    hold: float = 0.3  # s
    max_hold: float = 30.0  # s
    announce: float = 5.0  # s before the end of max_hold
    slow: float = 0.5  # share of the chosen speed until the first repeat


@dataclass(frozen=True)
class Held:
    """The present hold."""

    key: str
    share: float  # of the chosen speed
    left: float  # s until max_hold


class RepeatDelay:
    """Measures the keyboard's delay until the first repeat, from presses with a regular train of bytes after them."""

    def __init__(self, longest: float) -> None:
        self._longest = longest
        self._key = ""
        self._times: list[float] = []
        self._measured: deque[float] = deque(maxlen=5)

    @property
    def measured(self) -> float | None:
        """s, the longest of the last five; None until one is known."""
        return max(self._measured) if self._measured else None

    def byte(self, key: str, now: float) -> None:
        """Takes one byte of a motion key."""
        if key != self._key or (self._times and now - self._times[-1] > self._longest):
            self._key, self._times = key, []
        if len(self._times) == 4:
            self._times[-1] = now  # a train is measured once
            return
        self._times.append(now)
        if len(self._times) == 4:
            delay, second, third = (b - a for a, b in zip(self._times, self._times[1:], strict=False))
            if delay >= MIN_DELAY and max(second, third) <= SLOWEST_REPEAT:
                self._measured.append(delay)


class DeadMan:
    """Determines which motion key is held."""

    def __init__(self, parameters: HoldParameters | None = None, motions: Mapping[str, Hashable] | None = None) -> None:
        """`motions`: the motion of each key; a key that is not among them has one of its own."""
        self._parameters = parameters or HoldParameters()
        self._motions = motions or {}
        self._delay = RepeatDelay(self._parameters.first_hold)
        self._key = ""
        self._until = 0.0
        self._since = 0.0
        self._bytes = 0
        self._fast = False
        self._last_key, self._last_byte = "", float("-inf")
        self._stopped_in_burst = False
        self._down: set[str] = set()  # keys that are down; without reports of releases all that were pressed
        self._blocked: set[Hashable] | None = None  # None: no motion is blocked; else these, or all if it is empty
        self._blocked_byte = 0.0

    @property
    def first_hold(self) -> float:
        """s for which the first byte of a press holds, at present."""
        measured = self._delay.measured
        longest = self._parameters.first_hold
        return longest if measured is None else min(longest, measured + MARGIN)

    def press(self, key: str, now: float, *, repeat: bool = False) -> None:
        """Takes a byte of a motion key; `repeat`: the terminal reports that it is a repeat."""
        self._down.add(key)
        burst = now - self._last_byte < BURST
        again = key == self._last_key
        gap = now - self._last_byte
        self._last_key, self._last_byte = key, now
        if burst and (again or self._stopped_in_burst):
            if key == self._key and self._bytes == 1:
                self.block(key, now)
            return
        self._stopped_in_burst = False
        self._delay.byte(key, now)
        held = self.held(now)
        if self._is_blocked(key, now):
            return
        if held is None:
            self._begin(key, now, fast=False)
        elif held.key != key:
            begin = self._since if self._motion(key) == self._motion(held.key) else now
            self._begin(key, now, fast=self._fast)
            self._since = begin
        else:
            self._bytes += 1
            tapped = self._bytes == 2 and gap < MIN_DELAY and not repeat
            self._fast = self._fast or not tapped
            self._until = now + (self.first_hold if tapped else self._parameters.hold)

    def release(self, key: str) -> None:
        """The terminal reports that this key was released; the release of the last one ends a block of all motions."""
        self._down.discard(key)
        if key == self._key:
            self._key = ""
        if self._blocked is not None and (self._motion(key) in self._blocked or not (self._blocked or self._down)):
            self._blocked = None

    def stop(self, now: float) -> None:
        """Takes a key that stops."""
        self._key = ""
        self._last_key, self._last_byte = "", now
        self._stopped_in_burst = True

    def block(self, key: str, now: float) -> None:
        """Blocks all motions until all keys have paused: a byte of `key` came too late, or while nothing may move."""
        self._down.add(key)
        self._key = ""
        self._last_key, self._last_byte = key, now
        self._blocked, self._blocked_byte = set(), now

    def end(self, now: float) -> None:
        """Ends the motion for another reason than the keys: a key that is pressed now has to pause first."""
        self._key = ""
        if now - self._last_byte <= self._parameters.first_hold:
            self._blocked, self._blocked_byte = set(), self._last_byte

    def held(self, now: float) -> Held | None:
        """The present hold; None if there is none."""
        if not self._key or now >= self._until:
            self._key = ""
            return None
        left = self._since + self._parameters.max_hold - now
        if left <= 0:
            self._blocked, self._blocked_byte = {self._motion(self._key)}, now
            self._key = ""
            return None
        return Held(self._key, 1.0 if self._fast else self._parameters.slow, left)

    def ends_soon(self, held: Held) -> bool:
        """True if the end by max_hold is to be announced."""
        return held.left <= self._parameters.announce

    @property
    def overlong(self) -> bool:
        """True if max_hold ended the last motion."""
        return bool(self._blocked)

    def blocked(self, now: float) -> bool:
        """True if a key has to be released first."""
        return self._blocked is not None and now - self._blocked_byte <= self._parameters.first_hold

    def _motion(self, key: str) -> Hashable:
        return self._motions.get(key, key)

    def _begin(self, key: str, now: float, *, fast: bool) -> None:
        self._key, self._since, self._bytes, self._fast = key, now, 1, fast
        self._until = now + self.first_hold

    def _is_blocked(self, key: str, now: float) -> bool:
        if self._blocked is None:
            return False
        if self._blocked and self._motion(key) not in self._blocked:
            self._blocked = None  # another motion shows that a person is there
            return False
        paused = now - self._blocked_byte > self._parameters.first_hold
        self._blocked_byte = now
        if paused:
            self._blocked = None
        return not paused
