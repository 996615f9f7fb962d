"""Assigns a function to each key.

`arrows`   arrow keys and w a s d, curves with q e (forward) and z c (backward), sideways with j l
`classic`  the keys of teleop_twist_keyboard, where z and q change both speeds, w x the linear, e c the angular one;
           sideways with a d

The keys that move sideways have no effect on wheels. They change with the linear speed.

In both: space stops, Esc and ! are the e-stop, r and then y resets, Ctrl-C ends.
"""

from dataclasses import dataclass
from itertools import starmap

FASTER, SLOWER = 1.1, 0.9
"""as in teleop_twist_keyboard"""


@dataclass(frozen=True)
class Motion:
    """Shares of the chosen speeds, −1, 0 or 1: forward, turning to the left, sideways to the left."""

    linear: int
    angular: int
    lateral: int = 0


@dataclass(frozen=True)
class Speeds:
    """Factors of the chosen speeds."""

    linear: float
    angular: float


@dataclass(frozen=True)
class KeyMap:
    """One set of keys."""

    motions: dict[str, Motion]
    speeds: dict[str, Speeds]
    stops: frozenset[str]
    help: tuple[str, ...]  # lines of at most 78 columns


TURNS = ((1, 1), (1, 0), (1, -1), (0, 1), (0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 0, 1), (0, 0, -1))
"""forward turning left, straight, turning right; left and right on the spot; backward likewise; sideways"""
FACTORS = ((FASTER, FASTER), (SLOWER, SLOWER), (FASTER, 1), (SLOWER, 1), (1, FASTER), (1, SLOWER))


def _motions(keys: str) -> dict[str, Motion]:
    return dict(zip(keys, starmap(Motion, TURNS), strict=True))


def _speeds(keys: str, first: int = 0) -> dict[str, Speeds]:
    return dict(zip(keys, starmap(Speeds, FACTORS[first:]), strict=True))


SAFETY_HELP = "Space stop    Esc or ! EMERGENCY STOP    r, then y: reset    Ctrl-C end"

ARROWS = KeyMap(
    motions=_motions("qweadzscjl")
    | {"up": Motion(1, 0), "down": Motion(-1, 0), "left": Motion(0, 1), "right": Motion(0, -1)},
    speeds=_speeds("+-.,", 2) | _speeds("=_><", 2),
    stops=frozenset(("space",)),
    help=(
        "q  w  e     hold a key to drive, or an arrow key;    + -  linear speed",
        "a     d     release it to stop                       . ,  angular speed",
        "z  s  c     j  l  sideways, on legs",
        SAFETY_HELP,
    ),
)

CLASSIC = KeyMap(
    motions=_motions("uiojlm,.ad"),
    speeds=_speeds("qzwxec"),
    stops=frozenset(("space", "k")),
    help=(
        "u  i  o     hold a key to drive;                     q z  both speeds",
        "j  k  l     release it to stop                       w x  linear speed",
        "m  ,  .     a  d  sideways, on legs                  e c  angular speed",
        SAFETY_HELP,
    ),
)

KEY_MAPS = {"arrows": ARROWS, "classic": CLASSIC}
E_STOPS = frozenset(("escape", "!"))
