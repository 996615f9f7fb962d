"""The messages of a page: a fixed schema, and nothing beside it. Pure.

A message is a JSON object of at most MAX_SIZE bytes with exactly the fields of its type. Every number is finite, every
text bounded. All else is refused, and the refusal names the field.
"""

import json
import re
from collections.abc import Mapping
from typing import Any

from robot_control.files.files import printable
from robot_control.settings.files import FLAG, Check, in_range

MAX_SIZE = 64 * 1024
"""bytes"""
SURROGATE = re.compile("[\ud800-\udfff]")
"""Half a character of UTF-16, which JSON can name alone"""
RATE, BURST = 100.0, 200.0
"""messages per second and client, and what may come at once after a stall"""

Fields = Mapping[str, Check]


class MessageError(ValueError):
    """The message is not used; the text names the reason."""


def text(longest: int) -> Check:
    """A text of at most so many characters, which UTF-8 can hold."""
    return lambda value: isinstance(value, str) and len(value) <= longest and not SURROGATE.search(value)


flag = FLAG[1]
COUNT, SHARE, SPEED = in_range(0, 1 << 53, int), in_range(-1.0, 1.0), in_range(0.0, 100.0)
AXES = ("linear", "angular", "lateral")
TYPES: Mapping[str, Fields] = {
    "drive": {"number": COUNT, "sent": in_range(0.0, 1e12), "held": flag, **dict.fromkeys(AXES, SHARE)},
    "pong": {"name": text(32)},
    "take": {"force": flag},
    "hand_over": {"to": COUNT},
    "give_back": {},
    "speeds": dict.fromkeys(AXES, SPEED),
    "heartbeat": {"on": flag},
    "play": {"at": in_range(0.0, 1e7), "speed": in_range(0.0, 10.0)},
    "call": {"number": COUNT, "name": text(32), "arguments": lambda value: isinstance(value, dict)},
}
"""Type → its fields; those of `arguments` stand in calls.py"""


def parse(data: str) -> dict[str, Any]:
    """The message. Raises MessageError."""
    try:
        message = json.loads(data, parse_constant=_no_constant)
    except (ValueError, RecursionError):
        raise MessageError("no JSON") from None
    kind = message.get("type") if isinstance(message, dict) else None
    if not isinstance(kind, str) or kind not in TYPES:
        raise MessageError(f"type: {printable(str(kind))} is unknown")
    check_fields(kind, {name: value for name, value in message.items() if name != "type"}, TYPES[kind])
    return dict(message)


def check_fields(name: str, given: Mapping[str, Any], fields: Fields) -> None:
    """Raises MessageError unless exactly these fields are there, each with a value that may be used."""
    for field in given.keys() ^ fields.keys():
        raise MessageError(f"{name}: the field {printable(field)} is {'unknown' if field in given else 'missing'}")
    for field, check in fields.items():
        if not check(given[field]):
            raise MessageError(f"{name}: the value of {field} is not allowed")


def _no_constant(name: str) -> float:
    raise ValueError(name)


class Rate:
    """Bounds the messages of one client: a bucket of BURST that RATE fills."""

    def __init__(self, now: float) -> None:
        self._left, self._at = BURST, now

    def admits(self, now: float) -> bool:
        """Counts one message; False if it is one too many."""
        self._left, self._at = min(BURST, self._left + RATE * (now - self._at)) - 1.0, now
        return self._left >= 0.0
