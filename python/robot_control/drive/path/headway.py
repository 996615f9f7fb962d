"""Judges whether a motion brings the robot nearer to its end.

    in vain = max(0, in vain + (1 − scale_error)·moved − what the remaining way became less than ever before)

A pose that jumps, however little and often, would let the robot move without progress; `in vain` is the length of that.
"""


class Headway:
    """Progress on the pieces of a path [m], or in its turns [rad]."""

    def __init__(self, allowed: float, scale_error: float) -> None:
        """`allowed`: largest motion in vain; `scale_error`: share by which the speed and the poses may differ."""
        self._allowed, self._share = allowed, 1.0 - scale_error
        self._least = self._in_vain = 0.0

    def begin(self, whole: float) -> None:
        """Begins the next piece or turn, whose length is `whole`."""
        self._least = whole

    def step(self, moved: float, left: float) -> bool:
        """True if too much was in vain. `moved`: towards the end since the last step; `left`: until the end."""
        gained = max(0.0, self._least - left)
        self._least = min(self._least, left)
        self._in_vain = max(0.0, self._in_vain + self._share * moved - gained)
        return self._in_vain > self._allowed
