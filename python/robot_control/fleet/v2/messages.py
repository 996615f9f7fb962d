"""Bytes → messages that the standard's schemas allow, and back. What is malformed is refused with its place."""

import json
import math
import re
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

from robot_control.robot.pose import FARTHEST

Message = dict[str, Any]

VERSIONS = ("2.1.0", "2.0.0")
"""that the headers may declare; the first one is what the schemas describe"""
INBOUND = ("order", "instantActions")
MAX_BYTES = 1 << 18
MAX_DEPTH = 16
"""levels of brackets; an order of the standard has 7"""
MAX_VALUES = 20_000
"""fields and entries; an order of MAX_BYTES has fewer"""
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
MEASURES = (
    *("x", "y", "theta", "allowedDeviationXY", "allowedDeviationTheta", "orientation", "maxSpeed", "maxRotationSpeed"),
    *("minHeight", "maxHeight", "degree", "knotVector", "weight"),
)
"""numbers of an order with which the robot computes"""
BOUNDS = dict.fromkeys(COUNTS, (0, MAX_NUMBER)) | dict.fromkeys(MEASURES, (-FARTHEST, FARTHEST))
Where = tuple[Any, Any]
"""of a field: that of the object or array in which it stands, and its name or number there; empty for the message"""


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
            "errorDescription": self.description[:MAX_TEXT],
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
    check(message, topic)
    for name, own in (("manufacturer", manufacturer), ("serialNumber", serial_number)):
        if message[name] != own:
            raise _malformed(name, "belongs to another robot")
    if message["version"].split(".")[0] != "2":
        raise _malformed("version", "must be 2.0.0 or 2.1.0")
    if not is_time(message["timestamp"]):
        raise _malformed("timestamp", "must be UTC as 2026-01-31T12:00:00.00Z")
    return message


def is_connection(payload: bytes) -> bool:
    """True if these bytes say that a client is there, or was. Raises RefusedError: validationError."""
    return _read(payload).get("connectionState") in schema("connection")["properties"]["connectionState"]["enum"]


def check(message: Message, topic: str) -> None:
    """Raises RefusedError: validationError with the path of a field that the robot, or the schema, does not allow."""
    left: deque[tuple[Where | None, str, Any, int]] = deque([(None, "", message, 0)])
    values = 0
    while left:
        where, name, value, depth = left.popleft()
        values += len(value) if isinstance(value, dict | list) else 0
        if values > MAX_VALUES or depth > MAX_DEPTH:
            raise _malformed("", TOO_LARGE)
        if broken := _broken(name, value):
            raise _malformed(_path(where), broken)
        if isinstance(value, dict):
            left += [((where, key), key, each, depth + 1) for key, each in value.items()]
        elif isinstance(value, list):
            left += [((where, number), name, each, depth + 1) for number, each in enumerate(value)]
    for error in _validator(topic).iter_errors(message):
        place: Where | None = None
        for part in error.absolute_path:
            place = place, part
        raise _malformed(_path(place), f"breaks the schema: {error.message}")


def _path(where: Where | None) -> str:
    if where is None:
        return ""
    before, own = _path(where[0]), where[1]
    return f"{before}[{own}]" if isinstance(own, int) else f"{before}.{own[:MAX_ID]}" if before else own[:MAX_ID]


def _malformed(path: str, rule: str, **references: object) -> RefusedError:
    return RefusedError("validationError", f"{path or 'the message'} {rule}", parameter=path, **references)


def _read(payload: bytes) -> Message:
    if len(payload) > MAX_BYTES:
        raise _malformed("", f"has {len(payload)} bytes, more than {MAX_BYTES}")
    try:
        message = DECODER.decode(payload.decode())
    except RecursionError:
        raise _malformed("", TOO_LARGE) from None
    except ValueError as error:
        raise _malformed("", f"is not JSON in UTF-8: {str(error)[:80]}") from None
    if not isinstance(message, dict):
        raise _malformed("", "must be an object")
    return message


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is not a number")


def _unique(pairs: list[tuple[str, Any]]) -> Message:
    result = dict(pairs)
    if len(result) < len(pairs):
        raise ValueError("an object contains a name twice")
    return result


DECODER = json.JSONDecoder(parse_constant=_no_constant, object_pairs_hook=_unique)
TOO_LARGE = f"is more than {MAX_DEPTH} levels deep, or has more than {MAX_VALUES} values"


def _broken(name: str, value: Any) -> str:
    """The rule that the value of a field, or of an array, of this name breaks; empty if it breaks none."""
    if isinstance(value, float) and not math.isfinite(value):
        return "must be finite"
    if isinstance(value, int | float):
        least, most = BOUNDS.get(name, (-math.inf, math.inf))
        if not least <= value <= most:
            return f"must be from {least} to {most}"
        if isinstance(value, int) and abs(value) > 1 << 63:
            return "must fit into 64 bits"
    if isinstance(value, list) and len(value) > LIMITS.get(name, MAX_BYTES):
        return f"has {len(value)} entries, more than {LIMITS[name]}"
    wrong_id = isinstance(value, str) and (len(value) > MAX_ID or not value.isprintable() or set(value) & set(NO_ID))
    if name.endswith(("Id", "Type")) and wrong_id:
        return f"must be at most {MAX_ID} printable characters, without {' '.join(NO_ID)}"
    return ""


@cache
def schema(topic: str) -> Message:
    """The standard's schema of a topic."""
    path = Path(__file__).parent / "schemas" / f"{topic}.schema"
    result: Message = json.loads(path.read_text(encoding="utf-8-sig"))
    return result


@cache
def _validator(topic: str) -> Any:
    from jsonschema import Draft202012Validator

    return Draft202012Validator(schema(topic))


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


def headed(number: int, version: str, manufacturer: str, serial_number: str, message: Mapping[str, Any]) -> bytes:
    """The bytes of a message with its header, whose time is now. Raises ValueError: a number is not finite."""
    header = {"headerId": number, "timestamp": time_text(time.time()), "version": version}
    return encoded({**header, "manufacturer": manufacturer, "serialNumber": serial_number, **message})


def encoded(message: Mapping[str, Any]) -> bytes:
    """The bytes of a message. Raises ValueError: a number is not finite."""
    return json.dumps(message, allow_nan=False, separators=(",", ":")).encode()
