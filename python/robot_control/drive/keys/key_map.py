"""Assigns a function to each key.

`arrows`   arrow keys and w a s d, curves with q e (forward) and z c (backward), sideways with j l
`classic`  the keys of teleop_twist_keyboard, where z and q change both speeds, w x the linear, e c the angular one;
           sideways with a d

The keys that move sideways have no effect on wheels. They change with the linear speed.

In both: space stops, Esc and ! are the e-stop, r and then y resets, Ctrl-C ends.
"""

from dataclasses import dataclass

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


SAFETY_HELP = "Space stop    Esc or ! EMERGENCY STOP    r, then y: reset    Ctrl-C end"

ARROWS = KeyMap(
    motions={
        **dict.fromkeys(("up", "w"), Motion(1, 0)),
        **dict.fromkeys(("down", "s"), Motion(-1, 0)),
        **dict.fromkeys(("left", "a"), Motion(0, 1)),
        **dict.fromkeys(("right", "d"), Motion(0, -1)),
        "q": Motion(1, 1),
        "e": Motion(1, -1),
        "z": Motion(-1, -1),
        "c": Motion(-1, 1),
        "j": Motion(0, 0, 1),
        "l": Motion(0, 0, -1),
    },
    speeds={
        **dict.fromkeys(("+", "="), Speeds(FASTER, 1)),
        **dict.fromkeys(("-", "_"), Speeds(SLOWER, 1)),
        **dict.fromkeys((".", ">"), Speeds(1, FASTER)),
        **dict.fromkeys((",", "<"), Speeds(1, SLOWER)),
    },
    stops=frozenset(("space",)),
    help=(
        "q  w  e     hold a key to drive, or an arrow key;    + -  linear speed",
        "a     d     release it to stop                       . ,  angular speed",
        "z  s  c     j  l  sideways, on legs",
        SAFETY_HELP,
    ),
)

CLASSIC = KeyMap(
    motions={
        "u": Motion(1, 1),
        "i": Motion(1, 0),
        "o": Motion(1, -1),
        "j": Motion(0, 1),
        "l": Motion(0, -1),
        "m": Motion(-1, -1),
        ",": Motion(-1, 0),
        ".": Motion(-1, 1),
        "a": Motion(0, 0, 1),
        "d": Motion(0, 0, -1),
    },
    speeds={
        "q": Speeds(FASTER, FASTER),
        "z": Speeds(SLOWER, SLOWER),
        "w": Speeds(FASTER, 1),
        "x": Speeds(SLOWER, 1),
        "e": Speeds(1, FASTER),
        "c": Speeds(1, SLOWER),
    },
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
