"""Whether a motion brings the robot nearer to its end. Pure.

    in vain = max(0, in vain + (1 − scale_error)·moved − what the remaining way became less than ever before)

A pose that jumps, however little and often, lets the robot move for nothing; this is the way that it moves so.
"""


class Headway:
    """Of the pieces of a path [m], or of its turns [rad]."""

    def __init__(self, allowed: float, scale_error: float) -> None:
        """`allowed`: to be moved in vain; `scale_error`: share by which the speed and the poses may differ."""
        self._allowed, self._share = allowed, 1.0 - scale_error
        self._least = self._in_vain = 0.0

    def begin(self, whole: float) -> None:
        """The next piece or turn, by the way that has to be moved."""
        self._least = whole

    def step(self, moved: float, left: float) -> bool:
        """True: too much was in vain. `moved` towards the end since the last step; `left` until the end."""
        gained = max(0.0, self._least - left)
        self._least = min(self._least, left)
        self._in_vain = max(0.0, self._in_vain + self._share * moved - gained)
        return self._in_vain > self._allowed
