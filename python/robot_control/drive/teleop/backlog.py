"""Detects keys that were typed while this program did not run."""

LATE = 0.3
"""s without a pass of the program, after which the bytes read may be old"""


class Backlog:
    """After such a gap all bytes are old until a pass reads none: a terminal holds more than one read returns."""

    def __init__(self, now: float) -> None:
        """The program runs since `now`, s."""
        self._looked, self._late = now, False

    def late(self, data: bytes, now: float) -> bool:
        """True if these bytes may be old; it is called once per pass."""
        self._late = now - self._looked > LATE or (self._late and bool(data))
        self._looked = now
        return self._late
