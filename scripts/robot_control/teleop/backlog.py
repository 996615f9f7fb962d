"""Which keys were typed while this program did not run. Pure."""

LATE = 0.3
"""s that the program did not run, after which what is read may be old"""


class Backlog:
    """Old are all bytes after such a gap until a look finds none: a terminal holds more than one read returns."""

    def __init__(self, now: float) -> None:
        """Of a program that runs since `now`, s."""
        self._looked, self._late = now, False

    def late(self, data: bytes, now: float) -> bool:
        """Once per look: may these bytes be old?"""
        self._late = now - self._looked > LATE or (self._late and bool(data))
        self._looked = now
        return self._late
