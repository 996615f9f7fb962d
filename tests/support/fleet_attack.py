"""Messages of a hostile master: mutations of valid ones."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Iterator
from typing import Any

from bench.fleet.messages import Message, action, header, order

VALUES: tuple[Any, ...] = (
    None,
    True,
    -1,
    0,
    1.5,
    2**32,
    -(2**70),
    1e308,
    1e155,
    5e-324,
    "",
    "a/b",
    "+",
    "#",
    "\x00",
    "\u202e",
    "x" * 5000,
    [],
    {},
    [[]],
    "NaN",
)
RAW = (b"NaN", b"Infinity", b"-Infinity", b"1e999", b"\xff\xfe", b"{", b"]", b'"', b"\\ud800", b"\x00")


def seeds() -> list[Message]:
    """Valid messages."""
    places = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0, 0.5)]
    curve = {"degree": 1, "knotVector": [0, 0, 1, 1], "controlPoints": [{"x": 0, "y": 0}, {"x": 1, "y": 0}]}
    first = order(places, 2, actions={2: [action("horn", 1, "SOFT", n=1)], 1: [action("horn", 2)]}, maxSpeed=0.3)
    first["edges"][0]["trajectory"] = curve
    instant = {**header(), "actions": [action("startPause", 3, "HARD"), action("initPosition", 4, x=0.0, y=0.0)]}
    return [first, instant]


def _paths(value: Any) -> Iterator[tuple[Any, Any]]:
    """Containers and keys of every field."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in items:
        yield value, key
        yield from _paths(each)


def mutated(seed: int) -> tuple[str, bytes]:
    """Topic and payload."""
    source = random.Random(seed)
    message = copy.deepcopy(source.choice(seeds()))
    topic = "order" if "nodes" in message else "instantActions"
    for _ in range(source.randint(1, 3)):
        container, key = source.choice(list(_paths(message)))
        match source.randrange(3):
            case 0:
                container[key] = copy.deepcopy(source.choice(VALUES))
            case 1:
                del container[key]
            case _:
                container[key] = [container[key]] * source.randint(2, 40)
    payload = json.dumps(message).encode()
    if source.random() < 0.3:
        at = source.randrange(len(payload))
        payload = payload[:at] + source.choice(RAW) + payload[at + source.randint(0, 4) :]
    return topic, payload
