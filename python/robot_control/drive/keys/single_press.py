"""Lets a key act once per press, on a terminal that reports no releases. It reads no clock: time is an argument.

first byte                       acts at once: no byte of this key within MAX_DELAY before it
byte after SLOWEST_REPEAT        a tap or the keyboard's first repeat; it acts after SLOWEST_REPEAT, unless a
                                 further byte comes within that time and shows that the key repeats
byte sooner than SLOWEST_REPEAT  a repeat, which does not act
"""

from robot_control.drive.keys.dead_man import SLOWEST_REPEAT, HoldParameters

MAX_DELAY = HoldParameters.first_hold
"""s until a keyboard's first repeat"""


class SinglePress:
    """All keys that act once per press."""

    def __init__(self) -> None:
        self._key = ""
        self._last_byte = float("-inf")
        self._undecided = False  # the last byte may be a tap

    def press(self, key: str, now: float, *, repeat: bool = False) -> list[str]:
        """The keys that act now, after a byte of `key`; `repeat`: the terminal reports it as a repeat."""
        acts = self.due(now)
        gap = now - self._last_byte if key == self._key else float("inf")
        if key != self._key and self._undecided:
            acts.append(self._key)
        self._key, self._last_byte = key, now
        self._undecided = not repeat and SLOWEST_REPEAT < gap <= MAX_DELAY
        return [*acts, key] if gap > MAX_DELAY and not repeat else acts

    def release(self, key: str) -> list[str]:
        """The keys that act now, after the terminal reported the release of `key`: its next byte is another press."""
        if key != self._key:
            return []
        acts = [key] if self._undecided else []
        self._key, self._undecided = "", False
        return acts

    def due(self, now: float) -> list[str]:
        """The keys that act now, because no repeat has followed."""
        if not self._undecided or now - self._last_byte <= SLOWEST_REPEAT:
            return []
        self._undecided = False
        return [self._key]
