"""Bytes of a terminal → keys. Pure.

A key is named by its lower-case character, or `up`, `down`, `left`, `right`, `escape`, `enter`, `space`, `interrupt`.
Read are plain bytes, the arrows of ECMA-48 terminals (ESC [ A, ESC O A), and kitty's keyboard protocol
(https://sw.kovidgoyal.net/kitty/keyboard-protocol): CSI code:shifted;modifiers:event u, which also reports releases.
The Linux console's function keys (ESC [ [ A) are read and mean nothing.

An ESC alone is the key Esc once ESCAPE_WAIT has passed, or a byte has followed that begins no sequence.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

ESCAPE_WAIT = 0.05
"""s; the bytes of one sequence come together, on a slow link within this time"""
SEQUENCE_WAIT = 1.0
"""s after which a sequence that was begun is dropped"""
LONGEST = 32
"""bytes of a sequence"""

QUERY_RELEASES = b"\x1b[?u"
"""does this terminal speak kitty's protocol?"""
REPORT_RELEASES = b"\x1b[>15u"
"""1 disambiguate, 2 event types, 4 shifted keys, 8 all keys as sequences"""
END_RELEASES = b"\x1b[<u"

ESC = 0x1B
STOPS = b" !"
"""in no key's sequence: there they end it and count, so that none swallows a stop"""
ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}
NAMES = {3: "interrupt", 4: "interrupt", 10: "enter", 13: "enter", 27: "escape", 32: "space"}
SHIFT, CONTROL = 1, 4


class Event(Enum):
    """What happened to a key; a terminal without releases reports presses only."""

    PRESS = 1
    REPEAT = 2
    RELEASE = 3
    SPEAKS_KITTY = 4  # no key: the answer to QUERY_RELEASES


@dataclass(frozen=True)
class Key:
    """One event."""

    name: str
    event: Event = Event.PRESS


class Decoder:
    """Keeps what of a sequence has come."""

    def __init__(self) -> None:
        self._pending = b""
        self._since = 0.0

    def feed(self, data: bytes, now: float) -> list[Key]:
        """The keys that these bytes complete."""
        keys: list[Key] = []
        for byte in data:
            keys += self._byte(byte, now)
        return keys

    def look(self, now: float) -> list[Key]:
        """The key Esc, if an ESC has stayed alone."""
        wait = ESCAPE_WAIT if self._pending == b"\x1b" else SEQUENCE_WAIT
        if not self._pending or now - self._since < wait:
            return []
        alone, self._pending = self._pending == b"\x1b", b""
        return [Key("escape")] if alone else []

    def _byte(self, byte: int, now: float) -> Iterator[Key]:
        if not self._pending:
            if byte == ESC:
                self._pending, self._since = b"\x1b", now
            else:
                yield from plain(byte)
            return
        if self._pending == b"\x1b":
            if byte in b"[O":
                self._pending += bytes([byte])
                return
            self._pending = b""
            yield Key("escape")
            yield from self._byte(byte, now)
            return
        if byte in STOPS:
            self._pending = b""
            yield from plain(byte)
            return
        self._pending += bytes([byte])
        if 0x40 <= byte <= 0x7E and self._pending != b"\x1b[[":
            sequence, self._pending = self._pending, b""
            yield from sequence_key(sequence)
        elif byte == ESC:
            self._pending, self._since = b"\x1b", now
        elif len(self._pending) > LONGEST:
            self._pending = b""


def plain(byte: int) -> Iterator[Key]:
    """One byte outside a sequence."""
    if byte in NAMES:
        yield Key(NAMES[byte])
    elif 0x21 <= byte <= 0x7E:
        yield Key(chr(byte).lower())


def sequence_key(sequence: bytes) -> Iterator[Key]:
    """ESC [ … or ESC O …, complete."""
    text = sequence.decode("latin-1")
    body, final = text[2:-1], text[-1]
    if body == "[":
        return
    if final == "u" and body.startswith("?"):
        yield Key("", Event.SPEAKS_KITTY)
        return
    fields = [part.split(":") for part in body.split(";")]
    codes, modifiers = fields[0], fields[1] if len(fields) > 1 else [""]
    pressed = _number(modifiers[0], 1) - 1
    event = _number(modifiers[1], 1) if len(modifiers) > 1 else 1
    if event not in {1, 2, 3}:
        return
    if final in ARROWS:
        yield Key(ARROWS[final], Event(event))
    elif final == "u":
        shifted = _number(codes[1], 0) if len(codes) > 1 and pressed & SHIFT else 0
        name = _name(shifted or _number(codes[0], 0), pressed)
        if name:
            yield Key(name, Event(event))


def _name(code: int, modifiers: int) -> str:
    if modifiers & CONTROL:
        return "interrupt" if code in {ord("c"), ord("d")} else ""
    return NAMES.get(code, "") or (chr(code).lower() if 0x21 <= code <= 0x7E else "")


def _number(text: str, default: int) -> int:
    return int(text) if text.isdecimal() and len(text) < 8 else default
