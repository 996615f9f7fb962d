"""Bytes → messages that the standard's schemas allow, and back. What is malformed is refused with its place."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

Message = dict[str, Any]

VERSIONS = ("2.1.0", "2.0.0")
"""that the headers may declare; the first one is what the schemas describe"""
INBOUND = ("order", "instantActions")
MAX_BYTES = 1 << 18
MAX_DEPTH = 16
"""levels of brackets; an order of the standard has 7"""
MAX_NUMBER = 2**32 - 1
"""uint32 of headerId, orderUpdateId and sequenceId"""
MAX_ID = 128
"""characters"""
MAX_TEXT = 300
"""characters of a description, in which texts of a master may stand"""
NO_ID = "/+#$"
"""They structure topics (6.3); none of the recommended characters of an id (6.1.2)"""
LIMITS = {"nodes": 500, "edges": 499, "actions": 32, "actionParameters": 32, "knotVector": 220, "controlPoints": 200}
"""entries of each array of that name"""
TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d{1,9})?Z")
COUNTS = ("headerId", "orderUpdateId", "sequenceId")


@dataclass(frozen=True)
class Error:
    """An entry of `errors` in the state."""

    kind: str
    description: str
    references: tuple[tuple[str, str], ...] = ()
    hint: str = ""
    fatal: bool = False

    def message(self) -> Message:
        """As the schema wants it."""
        result: Message = {
            "errorType": self.kind,
            "errorLevel": "FATAL" if self.fatal else "WARNING",
            "errorDescription": self.description,
            "errorReferences": [{"referenceKey": key, "referenceValue": value} for key, value in self.references],
        }
        return result | ({"errorHint": self.hint} if self.hint else {})


class RefusedError(ValueError):
    """A message, an order or an action that is not taken."""

    def __init__(self, kind: str, description: str, **references: object) -> None:
        description = description[:MAX_TEXT]
        super().__init__(description)
        pairs = tuple((key, str(value)[:MAX_ID]) for key, value in references.items())
        self.error = Error(kind, description, pairs)


def decoded(payload: bytes, topic: str, manufacturer: str, serial_number: str) -> Message:
    """The message of these bytes.

    Raises:
        RefusedError: validationError with the path of the field.
    """
    message = _read(payload)
    if topic == "instantActions" and "instantActions" in message:
        message.setdefault("actions", message.pop("instantActions"))  # its name in some masters of 2.0.0
    for path, value in _fields(message):
        _check_field(path, value)
    _check_schema(message, topic)
    for name, own in (("manufacturer", manufacturer), ("serialNumber", serial_number)):
        if message[name] != own:
            raise _malformed(name, "is that of another robot")
    if message["version"].split(".")[0] != "2":
        raise _malformed("version", "must be 2.0.0 or 2.1.0")
    if not is_time(message["timestamp"]):
        raise _malformed("timestamp", "must be UTC as 2026-01-31T12:00:00.00Z")
    return message


def _malformed(path: str, rule: str, **references: object) -> RefusedError:
    return RefusedError("validationError", f"{path or 'the message'} {rule}", parameter=path, **references)


def _read(payload: bytes) -> Message:
    if len(payload) > MAX_BYTES:
        raise _malformed("", f"has {len(payload)} bytes, more than {MAX_BYTES}")
    outside = re.sub(rb'"(?:\\.|[^"\\])*"', b"", payload)
    depth = deepest = 0
    for sign in re.findall(rb"[\[\]{}]", outside):
        depth += 1 if sign in b"[{" else -1
        deepest = max(deepest, depth)
    if deepest > MAX_DEPTH:
        raise _malformed("", f"is {deepest} levels deep, more than {MAX_DEPTH}")
    try:
        message = json.loads(payload.decode(), parse_constant=_no_constant, object_pairs_hook=_unique)
    except (ValueError, RecursionError) as error:
        raise _malformed("", f"is no JSON of UTF-8: {str(error)[:80]}") from None
    if not isinstance(message, dict):
        raise _malformed("", "must be an object")
    return message


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no number")


def _unique(pairs: list[tuple[str, Any]]) -> Message:
    result = dict(pairs)
    if len(result) < len(pairs):
        raise ValueError("an object has a name twice")
    return result


def _fields(value: Any, path: str = "") -> Any:
    """Path and value of every field."""
    yield path, value
    if isinstance(value, dict):
        for name, each in value.items():
            yield from _fields(each, f"{path}.{name}" if path else name)
    elif isinstance(value, list):
        for number, each in enumerate(value):
            yield from _fields(each, f"{path}[{number}]")


def _check_field(path: str, value: Any) -> None:
    name = path.rpartition(".")[2]
    if isinstance(value, float) and not math.isfinite(value):
        raise _malformed(path, "must be finite")
    if isinstance(value, int) and abs(value) > 1 << 63:
        raise _malformed(path, "must fit into 64 bits")
    if isinstance(value, list) and len(value) > LIMITS.get(name, MAX_BYTES):
        raise _malformed(path, f"has {len(value)} entries, more than {LIMITS[name]}")
    if name in COUNTS and isinstance(value, int | float) and not 0 <= value <= MAX_NUMBER:
        raise _malformed(path, f"must be from 0 to {MAX_NUMBER}")
    wrong_id = isinstance(value, str) and (len(value) > MAX_ID or not value.isprintable() or set(value) & set(NO_ID))
    if name.endswith(("Id", "Type")) and wrong_id:
        raise _malformed(path, f"must be at most {MAX_ID} printable characters, without {' '.join(NO_ID)}")


@cache
def schema(topic: str) -> Message:
    """The standard's schema of a topic."""
    path = Path(__file__).parent / "schemas" / f"{topic}.schema"
    result: Message = json.loads(path.read_text(encoding="utf-8-sig"))
    return result


@cache
def _validator(topic: str) -> Any:
    import jsonschema  # Debian's package of the section fleet; the order rules do not need it

    return jsonschema.Draft202012Validator(schema(topic))


def _check_schema(message: Message, topic: str) -> None:
    for error in _validator(topic).iter_errors(message):
        raise _malformed(error.json_path.removeprefix("$").removeprefix("."), error.message[:120])


def is_time(text: str) -> bool:
    """True for a time as the header wants it."""
    if not TIME.fullmatch(text):
        return False
    try:
        datetime.fromisoformat(text)
    except ValueError:
        return False
    return True


def time_text(seconds: float) -> str:
    """UTC, of seconds since 1970."""
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%dT%H:%M:%S.%f")[:-4] + "Z"


def encoded(message: Mapping[str, Any]) -> bytes:
    """The bytes of a message. Raises ValueError: a number is not finite."""
    return json.dumps(message, allow_nan=False, separators=(",", ":")).encode()
