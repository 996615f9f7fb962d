"""Reports of a terminal are no keys: the mouse, the focus, pastes, answers to queries, letters of other alphabets."""

import random
import re

import pytest
from robot_control.drive.keys.key_map import ARROWS, E_STOPS, KEY_MAPS
from robot_control.drive.keys.keyboard import ESCAPE_WAIT, STOP_NAMES, Decoder, Event, Key
from robot_control.drive.keys.operator import Limits, Operator, Request
from robot_control.robot.command import Command

STILL = {None, Command()}
REPORTS = {
    "mouse, X10, at column and line 87": b"\x1b[M ww",
    "mouse, X10, middle button": b"\x1b[M!!!",
    "mouse, X10, at line 0x57 of column 163": b"\x1b[MC\xc3w",
    "mouse, UTF-8 (1005), at column 163": b"\x1b[MC\xc3\x83w",
    "mouse, SGR (1006)": b"\x1b[<35;119;97M\x1b[<0;119;97m",
    "mouse, urxvt (1015)": b"\x1b[67;119;97M",
    "mouse, highlight (1001)": b"\x1b[tww\x1b[Twwwwww",
    "mouse, eight-bit controls": b"\x9bMCww",
    "mouse, eight-bit controls in UTF-8": b"\xc2\x9bMCww\xc2\x9b<35;119;97M",
    "mouse, UTF-8 (1005), at line 123": b"\x1b[MCC\xc2\x9b",
    "focus": b"\x1b[I\x1b[O",
    "paste": b"\x1b[200~wasd \x1b[A!\r\x1bOA\x03w\x1b[201~",
    "title": b"\x1b]lwasd\x1b\\",
    "colour": b"\x1b]11;rgb:ww/aa/ss\x07",
    "clipboard": b"\x1b]52;c;" + b"wasd" * 2000 + b"\x1b\\",
    "version": b"\x1bP>|wasd(370)\x1b\\",
    "device": b"\x1bP!|77617364\x1b\\\x1b[?62;22c",
    "eight-bit strings in UTF-8": b"\xc2\x90w\xc2\x9c\xc2\x9d\xc4\x9cw\xc2\x9c\xc2\x9bI",
    "paste, eight-bit controls in UTF-8": b"\xc2\x9b200~wasd\xc4\x9b201~w\xc2\x9b201~",
    "eight-bit strings": b"\x90w\x9c\x9dw\x9c\x98w\x9c\x9ew\x9c\x9fw\x9c",
    "application program, privacy, start of string": b"\x1b_w\x1b\\\x1b^w\x1b\\\x1bXw\x1b\\",
    "string with a letter that holds the byte of its end": b"\x1b]2;\xc4\x9cw\x1b\\",
    "cursor, mode, window": b"\x1b[24;80R\x1b[?1003;1$y\x1b[8;24;80t\x1b[48;24;80;0;0t",
    "arrow with a private mark": b"\x1b[<1A\x1b[?1;2B\x1b[>C\x1b[5D",
    "arrow of no number": b"\x1b[;A\x1b[1;A\x1b[1;:1A\x1b[:1A",
    "keys of a pad": b"\x1bOw\x1bOj\x1bO5m",
    "function keys": b"\x1b[15~\x1b[[A\x1bOP\x1b[1;5P",
    "Windows": b"\x1b[87;17;119;1;0;1_",
    "more than a key has": b"\x1b[" + b"1;" * 40 + b"A",
    "letters": "wäżж中😀".encode()[1:],
    "letter that holds a control": b"\xc4\x9b",
}


def operator():
    operator = Operator(ARROWS, Command(0.5, 1.0), Limits(1.0, 2.0, reverse=1.0))
    operator.permit(True, 0.0)
    return operator


@pytest.mark.parametrize("name", REPORTS)
def test_a_report_is_no_key_and_the_key_after_it_is_one(name):
    assert Decoder().feed(REPORTS[name] + b"x", 0.0) == [Key("x")]


@pytest.mark.parametrize("name", REPORTS)
def test_nor_where_it_comes_byte_by_byte(name):
    decoder, now = Decoder(), 0.0
    for byte in REPORTS[name][:600]:
        now += ESCAPE_WAIT / 2
        assert decoder.feed(bytes([byte]), now) == []
        assert decoder.flush(now + ESCAPE_WAIT / 4) == []


@pytest.mark.parametrize("begun", [b"\x1b[M", b"\x1b]", b"\x1bP", b"\x1b[200~", b"\x1b[<"])
@pytest.mark.parametrize(("stop", "name"), [(b" ", "space"), (b"!", "!"), (b"\x1b", "escape")])
def test_a_report_without_an_end_swallows_no_stop_that_is_typed_later(begun, stop, name):
    decoder = Decoder()
    assert decoder.feed(begun, 0.0) == []
    assert [*decoder.feed(stop, 2 * ESCAPE_WAIT), *decoder.flush(4 * ESCAPE_WAIT)] == [Key(name)]


LONG = 100 * ESCAPE_WAIT
"""s; a link that stalls"""


@pytest.mark.parametrize("name", REPORTS)
def test_nor_where_the_link_stalls_within_it(name):
    data = REPORTS[name]
    for tear in range(1, min(len(data), 50)):
        decoder = Decoder()
        found = decoder.feed(data[:tear], 0.0) + decoder.flush(LONG) + decoder.feed(data[tear:], LONG)
        assert {key.name for key in found} <= STOP_NAMES
        assert decoder.feed(b"x", LONG) == [Key("x")]


@pytest.mark.parametrize("begun", [b"\x1b[M", b"\x1b]w", b"\x1bPw", b"\x1b[<0;1", b"\x1bO", b"\x1b]w\x1b"])
def test_a_report_without_an_end_is_over_after_ctrl_x(begun):
    decoder = Decoder()
    decoder.feed(begun, 0.0)
    decoder.flush(LONG)
    decoder.feed(b"\x18", LONG)
    assert decoder.unfinished == ""
    assert decoder.feed(b"w", 2 * LONG) == [Key("w")]


@pytest.mark.parametrize(
    ("begun", "remedy"),
    [(b"\x1b]w", "Ctrl-X"), (b"\x1bP\x1b", "Ctrl-X"), (b"\x1b[200~w\x1b]", "restart teleop.py")],
)
def test_what_takes_the_keys_is_named_with_its_remedy(begun, remedy):
    decoder = Decoder()
    assert decoder.unfinished == ""
    decoder.feed(begun, 0.0)
    assert remedy in decoder.unfinished


@pytest.mark.parametrize(
    ("stop", "name"), [(b"\x1b[32u", "space"), (b"\x1b[49:33;2u", "!"), (b"\x1b[99;5u", "interrupt")]
)
def test_a_paste_without_an_end_swallows_no_stop_that_the_terminal_reports_later(stop, name):
    decoder = Decoder()
    decoder.feed(b"\x1b[200~" + stop, 0.0)
    assert decoder.feed(stop, LONG) == [Key(name)]
    assert decoder.feed(b"\x1b[119u", 2 * LONG) == []


def unbound(chance):
    """A byte that is no key of teleop.py and begins no sequence."""
    bound = {*"wasdqezc+-=_.>,<uiojlm,.kxry", *E_STOPS, " "}
    letters = [byte for byte in range(0x21, 0x7F) if chr(byte).lower() not in bound]
    return bytes([chance.choice([*letters, 0x00, 0x05, 0x7F])])


def mouse(chance):
    """A mouse report in one of four encodings."""
    numbers = ";".join(str(chance.randrange(300)) for _ in range(3))
    places = "".join(chr(32 + chance.randrange(1, 2000)) for _ in range(2))
    return chance.choice(
        [
            b"\x1b[M" + bytes(chance.randrange(0x20, 0x100) for _ in range(3)),
            b"\x1b[M" + bytes([chance.randrange(0x21, 0x80)]) + places.encode(),
            f"\x1b[<{numbers}{chance.choice('Mm')}".encode(),
            f"\x1b[{numbers}M".encode(),
        ]
    )


def unknown_sequence(chance):
    body = "".join(chance.choice("0123456789;:<=>?") for _ in range(chance.randrange(10)))
    final = chr(chance.choice([byte for byte in range(0x40, 0x7F) if chr(byte) not in "MTtu["]))
    arrow = final in "ABCD" and re.fullmatch(r"(1(;[\d:]*)?)?", body)
    return b"" if arrow or body + final == "200~" else f"\x1b[{body}{final}".encode()


def random_unit(chance):
    """One report, a letter, or keys without a meaning."""
    text = bytes(chance.choice(b"wasdqezcuiojlm,.+-ABCD;0123456789 !\r") for _ in range(chance.randrange(12)))
    letter = chr(chance.choice([chance.randrange(0xA0, 0x3000), chance.randrange(0x10000, 0x20000)]))
    return chance.choice(
        [
            mouse(chance),
            unknown_sequence(chance),
            chance.choice([b"\x1b]", b"\x1bP", b"\x1b_", b"\x1b^", b"\x1bX"]) + text + b"\x1b\\",
            b"\x1b[200~" + text + b"\x1b[201~",
            b"\x1bO" + bytes([chance.randrange(0x45, 0x7F)]),
            letter.encode(),
            unbound(chance),
        ]
    )


@pytest.fixture(params=KEY_MAPS)
def operator_of_a_key_map(request):
    made = Operator(KEY_MAPS[request.param], Command(0.5, 1.0), Limits(1.0, 2.0, reverse=1.0))
    made.permit(True, 0.0)
    return made


@pytest.mark.parametrize("seed", range(150))
def test_random_input_without_a_bound_key_never_moves_the_robot(seed, operator_of_a_key_map):
    chance, operator = random.Random(seed), operator_of_a_key_map
    decoder, now = Decoder(), 0.0
    data = b"".join(random_unit(chance) for _ in range(100))
    while data:
        size = chance.choice([1, 2, 5, 40, 4096])
        now += chance.uniform(0.0, 0.9 * ESCAPE_WAIT)
        for key in [*decoder.feed(data[:size], now), *decoder.flush(now)]:
            assert key.event is not Event.SPEAKS_KITTY
            assert operator.key(key, now) is not Request.END
        data = data[size:]
        assert operator.command(now) in STILL


@pytest.mark.parametrize("seed", range(150))
def test_nor_does_random_input_that_is_torn_in_time(seed, operator_of_a_key_map):
    """Each stop that a pause makes of a byte is taken back at once, so that it hides no motion."""
    chance, operator = random.Random(seed), operator_of_a_key_map
    decoder, now = Decoder(), 0.0
    data = b"".join(random_unit(chance) for _ in range(100))
    while data:
        size = chance.choice([1, 2, 5, 40])
        for _ in range(chance.choice([1, 1, 1, 3, 70, 300])):  # passes until more comes
            now += 0.02
            for key in [*decoder.feed(b"", now), *decoder.flush(now)]:
                operator.key(key, now)
        for key in [*decoder.feed(data[:size], now), *decoder.flush(now)]:
            assert operator.key(key, now) not in {Request.END, Request.RESET}
            operator.reset_accepted()
        data = data[size:]
        assert operator.command(now) in STILL


@pytest.mark.parametrize("seed", range(100))
def test_a_stop_within_a_sequence_lets_its_rest_move_nothing(seed):
    chance = random.Random(seed)
    decoder, pilot, now = Decoder(), operator(), 0.0
    for _ in range(50):
        stop = chance.choice([b" ", b"!"])
        for byte in b"\x1b[" + chance.choice([b"", b"1", b"?1;"]) + stop + chance.choice([b"w", b"A", b"1A"]):
            now += chance.uniform(0.0, 0.9 * ESCAPE_WAIT)
            for key in decoder.feed(bytes([byte]), now):
                pilot.key(key, now)
            assert pilot.command(now) in STILL
        pilot.reset_accepted()
