"""The place in a recording that is shown. It reads no clock: time is an argument, s."""

from dataclasses import dataclass


@dataclass
class Playback:
    """A recording of `length` s that plays at `speed` times its own time; 0: it stands."""

    length: float
    speed: float = 0.0
    _at: float = 0.0  # s from the begin of the recording
    _since: float = 0.0  # s, when it was there

    def at(self, now: float) -> float:
        """s from the begin of the recording."""
        return min(self.length, self._at + self.speed * (now - self._since))

    def play(self, at: float, speed: float, now: float) -> None:
        """Goes on from there with this speed."""
        self._at, self._since, self.speed = min(at, self.length), now, speed
