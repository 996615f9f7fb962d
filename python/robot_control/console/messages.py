"""The messages of a page: a fixed schema, and nothing beside it. Pure.

A message is a JSON object of at most MAX_SIZE bytes with exactly the fields of its type. Every number is finite, every
text bounded. All else is refused, and the refusal names the field.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from robot_control.common.files import printable

MAX_SIZE = 64 * 1024
"""bytes"""
RATE, BURST = 100.0, 200.0
"""messages per second and client, and what may come at once after a stall"""

Check = Callable[[Any], bool]
"""True for a value that may be used."""


class MessageError(ValueError):
    """The message is not used; the text names the reason."""


def _number(lowest: float, highest: float) -> Check:
    def check(value: Any) -> bool:  # noqa: ANN401 (JSON)
        known = isinstance(value, int | float) and not isinstance(value, bool)
        return known and lowest <= value <= highest  # false for NaN and infinity

    return check


def _whole(lowest: int, highest: int) -> Check:
    return lambda value: isinstance(value, int) and not isinstance(value, bool) and lowest <= value <= highest


def _text(longest: int) -> Check:
    return lambda value: isinstance(value, str) and len(value) <= longest


def _flag(value: Any) -> bool:  # noqa: ANN401 (JSON)
    return isinstance(value, bool)


def _points(value: Any) -> bool:  # noqa: ANN401 (JSON)
    coordinate = _number(-1e6, 1e6)
    return (
        isinstance(value, list)
        and 2 <= len(value) <= 1000
        and all(isinstance(point, list) and len(point) == 2 and all(map(coordinate, point)) for point in value)
    )


COUNT = _whole(0, 1 << 53)
SHARE = _number(-1.0, 1.0)
METRES = _number(-1e6, 1e6)
SPEED = _number(0.0, 100.0)

TYPES: Mapping[str, Mapping[str, Check]] = {
    "drive": {"number": COUNT, "sent": _number(0.0, 1e12), "held": _flag, "linear": SHARE, "angular": SHARE},
    "pong": {"name": _text(32)},
    "take": {"force": _flag},
    "hand_over": {"to": COUNT},
    "give_back": {},
    "speeds": {"linear": SPEED, "angular": SPEED},
    "heartbeat": {"on": _flag},
    "call": {"number": COUNT, "name": _text(32), "arguments": lambda value: isinstance(value, dict)},
}
"""Type → its fields."""

CALLS: Mapping[str, Mapping[str, Check]] = {
    "reset_asked": {},
    "reset": {"key": _text(32)},
    "reset_odometry": {},
    "set_odometry": {"x": METRES, "y": METRES, "yaw": _number(-7.0, 7.0)},
    "set_parameters": {"parameters": _text(8192)},
    "path_points": {"points": _points, "speed": SPEED},
    "path_shape": {"shape": _text(16), "size": _number(0.1, 100.0), "speed": SPEED},
    "path_csv": {"text": _text(60_000), "speed": SPEED},
    "path_pause": {},
    "path_resume": {},
    "path_cancel": {},
    "pause": {"on": _flag},
    "step": {"cycles": _whole(1, 10_000)},
    "simulation_reset": {},
    "inject_fault": {"component": _text(32), "kind": _text(32)},
}
"""Name of a call → its arguments."""


def parse(text: str) -> dict[str, Any]:
    """The message, a call's arguments checked, too.

    Raises:
        MessageError: it is none.
    """
    try:
        message = json.loads(text, parse_constant=_no_constant)
    except (ValueError, RecursionError):
        raise MessageError("no JSON") from None
    if not isinstance(message, dict) or not isinstance(message.get("type"), str):
        raise MessageError("no object with a type")
    kind = message.pop("type")
    if kind not in TYPES:
        raise MessageError(f"type: {printable(kind)} is unknown")
    _check(kind, message, TYPES[kind])
    if kind == "call":
        if message["name"] not in CALLS:
            raise MessageError(f"call: {printable(message['name'])} is unknown")
        _check(message["name"], message["arguments"], CALLS[message["name"]])
    return {"type": kind, **message}


def _check(name: str, given: Mapping[str, Any], fields: Mapping[str, Check]) -> None:
    for field in given.keys() - fields.keys():
        raise MessageError(f"{name}: the field {printable(field)} is unknown")
    for field, check in fields.items():
        if field not in given:
            raise MessageError(f"{name}: the field {field} is missing")
        if not check(given[field]):
            raise MessageError(f"{name}: the value of {field} is none that may be used")


def _no_constant(name: str) -> float:
    raise ValueError(name)


class Rate:
    """Bounds the messages of one client: a bucket of BURST that RATE fills."""

    def __init__(self, now: float) -> None:
        self._left, self._at = BURST, now

    def admits(self, now: float) -> bool:
        """Takes one message; False if it is one too many."""
        self._left, self._at = min(BURST, self._left + RATE * (now - self._at)), now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True
