"""Bytes of a terminal → keys. Pure.

A key is named by its lower-case character, or `up`, `down`, `left`, `right`, `escape`, `enter`, `space`, `interrupt`.
Read are plain bytes, the arrows of ECMA-48 terminals (ESC [ A, ESC O A), and kitty's keyboard protocol
(https://sw.kovidgoyal.net/kitty/keyboard-protocol): CSI code:shifted;modifiers:event u, which also reports releases.

Everything else that a terminal sends is consumed to its end and means nothing (ECMA-48, section 5; xterm's ctlseqs):

    ESC [ … final            final: 0x40 to 0x7E; also as the byte 0x9B, in UTF-8 C2 9B
    ESC [ M, t, T            mouse reports of raw characters follow: 3, 2, 6; ESC [ [ of the Linux console: 1
    ESC O … final            also as 0x8F
    ESC P ] X ^ _ … ST        strings; ST: ESC and a backslash, 0x9C or BEL; also as 0x90 and others
    ESC [200~ … ESC [201~    a paste
    UTF-8                    letters of several bytes

Bytes end a sequence, time does not: a link may stall anywhere in it. A paste ends with its end mark, and every other
sequence also with Ctrl-X.

An ESC alone is the key Esc once ESCAPE_WAIT has passed, or after a byte that begins no sequence; it ends none. No
sequence swallows a stop. Space and ! count inside ESC [ and ESC O, where no report has them. Elsewhere they count when
they come ESCAPE_WAIT after the byte before, as a typed key does. Stops that a terminal reports during a paste count as
well.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum, auto

ESCAPE_WAIT = 0.05
"""s; the bytes of one sequence come together, on a slow link within this time"""
MAX_SEQUENCE = 32
"""bytes of a sequence that may mean something"""

QUERY_RELEASES = b"\x1b[?u"
"""asks whether the terminal speaks kitty's protocol"""
REPORT_RELEASES = b"\x1b[>15u"
"""1 disambiguate, 2 event types, 4 shifted keys, 8 all keys as sequences"""
END_RELEASES = b"\x1b[<u"

ESC, BEL, STRING_END = 0x1B, 0x07, 0x9C
CANCELS = b"\x18\x1a"
"""Ctrl-X, Ctrl-Z; they end a sequence"""
STOPS = b" !"
STOP_NAMES = frozenset(("space", "!", "escape", "interrupt"))
STRINGS = "PX]^_"
"""after ESC"""
RAW_CHARACTERS = {"M": 3, "t": 2, "T": 6, "[": 1}
"""after ESC [ and this final byte"""
PASTE, PASTE_END = "200~", "201~"
ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}
NAMES = {3: "interrupt", 4: "interrupt", 10: "enter", 13: "enter", 27: "escape", 32: "space"}
ARROW = re.compile(r"(1(;(?P<modifiers>[0-9]+)(:(?P<event>[0-9]+))?)?)?")
CODE = re.compile(
    r"(?P<code>[0-9]+)(:(?P<shifted>[0-9]*)(:[0-9]*)?)?(;(?P<modifiers>[0-9]*)(:(?P<event>[0-9]+))?(;[0-9:]*)?)?"
)
SHIFT, CONTROL = 1, 4


class Event(Enum):
    """The kind of a key event; a terminal without releases reports presses only."""

    PRESS = 1
    REPEAT = 2
    RELEASE = 3
    SPEAKS_KITTY = 4  # no key: the answer to QUERY_RELEASES


@dataclass(frozen=True)
class Key:
    """One event."""

    name: str
    event: Event = Event.PRESS


class Part(Enum):
    """The part of a sequence to which a byte belongs."""

    KEYS = auto()
    ESCAPE = auto()
    CONTROL = auto()  # after ESC [
    SINGLE = auto()  # after ESC O
    STRING = auto()
    RAW = auto()


class Decoder:
    """Keeps the bytes of a sequence that is not complete yet."""

    def __init__(self) -> None:
        self._part = self._before_escape = Part.KEYS
        self._escape_due = False  # the last byte is an ESC, which may yet be the key
        self._pasting = False
        self._typed = False  # true if the key or the sequence began ESCAPE_WAIT after the byte before
        self._sequence = ""  # after ESC [ or ESC O
        self._raw = 0  # characters that are still to come
        self._letter = 0  # bytes of a UTF-8 letter that may still come
        self._may_be_control = False  # the letter began with C2
        self._last = 0.0

    def feed(self, data: bytes, now: float) -> list[Key]:
        """The keys that these bytes complete."""
        keys: list[Key] = []
        for byte in data:
            typed, inside = now - self._last >= ESCAPE_WAIT, self._part is not Part.KEYS
            if byte == ESC or not inside:
                self._typed = typed
            self._last = now
            found = [key for key in self._byte(byte) if self._counts(key)]
            if inside and typed and byte in STOPS:
                found += [key for key in plain(byte) if key not in found]
            keys += found
        return keys

    def flush(self, now: float) -> list[Key]:
        """The key Esc if no byte has followed an ESC."""
        if not self._escape_due or now - self._last < ESCAPE_WAIT:
            return []
        self._escape_due = False
        return [key for key in [Key("escape")] if self._counts(key)]

    @property
    def unfinished(self) -> str:
        """Description of a sequence that has no end yet and takes all keys but stops; empty if there is none."""
        if self._pasting:
            return "a paste has started, and no key drives before its end; if the end is lost, restart teleop.py"
        if Part.STRING in {self._part, self._before_escape}:
            return "this terminal has started a report (also by Alt-]), and no key drives before its end: press Ctrl-X"
        return ""

    def _counts(self, key: Key) -> bool:
        return not self._pasting or (self._typed and key.name in STOP_NAMES)

    def _byte(self, byte: int) -> Iterator[Key]:
        if self._letter and 0x80 <= byte <= 0xBF:
            self._letter -= 1
            if not (self._may_be_control and byte < 0xA0):
                return
        else:
            raw = self._part is Part.RAW
            self._letter = int(0xC2 <= byte <= 0xDF) if raw else letter_bytes(byte)
            self._may_be_control = byte == 0xC2 and not raw
        if self._part is Part.ESCAPE:
            yield from self._after_escape(byte)
        elif byte == ESC:
            self._before_escape, self._part, self._escape_due = self._part, Part.ESCAPE, True
        elif byte in CANCELS:
            self._part = Part.KEYS
        elif self._part is Part.RAW:
            self._raw -= 1
            self._part = Part.RAW if self._raw else Part.KEYS
        elif self._part is Part.STRING:
            self._part = Part.KEYS if byte in (BEL, STRING_END) else Part.STRING
        elif not (0x80 <= byte < 0xA0 and self._begins(chr(byte - 0x40))):
            yield from plain(byte) if self._part is Part.KEYS else self._control(byte)

    def _after_escape(self, byte: int) -> Iterator[Key]:
        before, self._before_escape = self._before_escape, Part.KEYS
        due, self._escape_due = self._escape_due, False
        if before is Part.STRING and chr(byte) == "\\":
            self._part = Part.KEYS
        elif not self._begins(chr(byte)):
            if due:
                yield Key("escape")
            self._part = before
            yield from self._byte(byte)

    def _begins(self, introducer: str) -> bool:
        part = {"[": Part.CONTROL, "O": Part.SINGLE, **dict.fromkeys(STRINGS, Part.STRING)}.get(introducer)
        self._part, self._sequence = part or self._part, ""
        return part is not None

    def _control(self, byte: int) -> Iterator[Key]:
        """Takes a byte after ESC [ or ESC O."""
        if 0x40 <= byte <= 0x7E:
            single, self._part = self._part is Part.SINGLE, Part.KEYS
            yield from self._complete(chr(byte), single=single)
            return
        self._sequence = (self._sequence + chr(byte))[: MAX_SEQUENCE + 1]
        if byte in STOPS or byte < 0x20:
            yield from plain(byte)

    def _complete(self, final: str, *, single: bool) -> Iterator[Key]:
        body = self._sequence
        if single:
            if not body and final in ARROWS:
                yield Key(ARROWS[final])
        elif body + final in RAW_CHARACTERS:
            self._part, self._raw = Part.RAW, RAW_CHARACTERS[final]
        elif body + final in (PASTE, PASTE_END):
            self._pasting = body + final == PASTE
        elif len(body) <= MAX_SEQUENCE:
            yield from control_key(body, final)


def letter_bytes(byte: int) -> int:
    """Number of bytes that follow the first one of a UTF-8 letter; 0 if it is no first one."""
    return (0xC2 <= byte <= 0xF4) + (0xE0 <= byte <= 0xF4) + (0xF0 <= byte <= 0xF4)


def plain(byte: int) -> Iterator[Key]:
    """The keys of one byte outside a sequence."""
    if byte in NAMES:
        yield Key(NAMES[byte])
    elif 0x21 <= byte <= 0x7E:
        yield Key(chr(byte).lower())


def control_key(body: str, final: str) -> Iterator[Key]:
    """The keys of the sequence ESC [ body final."""
    if final == "u" and re.fullmatch(r"\?[0-9]+", body):
        yield Key("", Event.SPEAKS_KITTY)
        return
    form = ARROW if final in ARROWS else CODE if final == "u" else None
    found = form and form.fullmatch(body)
    event = _number(found["event"], 1) if found else 0
    if not found or event not in {1, 2, 3}:
        return
    pressed = max(_number(found["modifiers"], 1) - 1, 0)
    if form is ARROW:
        yield Key(ARROWS[final], Event(event))
        return
    shifted = _number(found["shifted"], 0) if pressed & SHIFT else 0
    name = _name(shifted or _number(found["code"], 0), pressed)
    if name:
        yield Key(name, Event(event))


def _name(code: int, modifiers: int) -> str:
    if modifiers & CONTROL:
        return "interrupt" if code in {ord("c"), ord("d")} else ""
    return NAMES.get(code, "") or (chr(code).lower() if 0x21 <= code <= 0x7E else "")


def _number(text: str | None, default: int) -> int:
    return int(text) if text and len(text) < 8 else default
