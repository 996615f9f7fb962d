"""Bytes of terminals → keys of teleop.py."""

import random

import pytest
from robot_control.drive.keys.key_map import E_STOPS, KEY_MAPS
from robot_control.drive.keys.keyboard import ESCAPE_WAIT, Decoder, Event, Key


def keys(data):
    return Decoder().feed(data, 0.0)


@pytest.mark.parametrize(
    ("data", "name"),
    [
        (b"w", "w"),
        (b"W", "w"),  # Caps Lock
        (b" ", "space"),
        (b"\r", "enter"),
        (b"!", "!"),
        (b"\x03", "interrupt"),
        (b"\x1b[A", "up"),
        (b"\x1bOA", "up"),  # application mode
        (b"\x9bA", "up"),  # eight-bit controls
        (b"\xc2\x9bA", "up"),  # and in UTF-8
        (b"\x1b[B", "down"),
        (b"\x1b[C", "right"),
        (b"\x1b[D", "left"),
        (b"\x1b[119u", "w"),
        (b"\x1b[119;1u", "w"),
        (b"\x1b[119:87;2u", "w"),  # Shift
        (b"\x1b[49:33;2u", "!"),
        (b"\x1b[27u", "escape"),
        (b"\x1b[32u", "space"),
        (b"\x1b[99;5u", "interrupt"),  # Ctrl-C
        (b"\x1b[1;129A", "up"),  # Num Lock
    ],
)
def test_a_press(data, name):
    assert keys(data) == [Key(name)]


@pytest.mark.parametrize(("number", "event"), [(1, Event.PRESS), (2, Event.REPEAT), (3, Event.RELEASE)])
def test_a_terminal_that_reports_releases(number, event):
    assert keys(f"\x1b[119;1:{number}u\x1b[1;1:{number}A".encode()) == [Key("w", event), Key("up", event)]


def test_the_answer_of_a_terminal_that_can_report_releases():
    assert keys(b"\x1b[?0u") == [Key("", Event.SPEAKS_KITTY)]


@pytest.mark.parametrize(
    "data",
    [
        b"\x00",
        b"\x7f",
        b"\xc3\xa4",
        b"\x1b[I",
        b"\x1b[200~",
        b"\x1b[57441u",
        b"\x1b[119;5u",
        b"\x1b[119;1:9u",
        b"\x1b[99999999999u",
        b"\x1b[\xb2u",  # a digit that is no decimal one
        b"\x1b[[C",  # F3 of the Linux console
    ],
)
def test_what_is_no_key_of_ours_is_none(data):
    assert keys(data) == []


def test_an_escape_alone_is_the_key_after_a_wait():
    decoder = Decoder()
    assert decoder.feed(b"\x1b", 1.0) == []
    assert decoder.flush(1.0 + ESCAPE_WAIT - 0.001) == []
    assert decoder.flush(1.0 + ESCAPE_WAIT) == [Key("escape")]
    assert decoder.flush(9.0) == []


def test_an_escape_before_another_key_is_the_key_at_once():
    assert keys(b"\x1bw") == [Key("escape"), Key("w")]
    assert keys(b"\x1b\x1b[A") == [Key("escape"), Key("up")]


def test_a_sequence_may_come_in_pieces_and_has_its_end_however_late():
    decoder = Decoder()
    assert decoder.feed(b"\x1b[", 0.0) == []
    assert decoder.feed(b"A", 9.0) == [Key("up")]
    assert decoder.feed(b"\x1b[1;", 10.0) == decoder.flush(20.0) == []
    assert decoder.feed(b"ww", 30.0) == [Key("w")]


def test_what_follows_an_escape_that_has_counted_as_the_key_completes_its_sequence():
    decoder = Decoder()
    decoder.feed(b"\x1b", 0.0)
    assert decoder.flush(9.0) == [Key("escape")]
    assert decoder.feed(b"[<35;119;97Mw", 9.0) == [Key("w")]


def test_an_escape_that_begins_nothing_ends_nothing():
    decoder = Decoder()
    assert decoder.feed(b"\x1b]w", 0.0) == []
    assert decoder.feed(b"\x1bwasd", 1.0) == [Key("escape")]
    assert decoder.feed(b"\x1b\\w", 2.0) == [Key("w")]


def test_a_stop_that_follows_an_escape_hides_it_not():
    decoder = Decoder()
    decoder.feed(b"\x1b", 1.0)
    assert decoder.feed(b" ", 2.0) == [Key("escape"), Key("space")]


@pytest.mark.parametrize("begun", [b"\x1b[", b"\x1bO", b"\x1b[1;2"])  # Alt-[ alone is such a beginning
@pytest.mark.parametrize(("stop", "name"), [(b" ", "space"), (b"!", "!")])
def test_a_sequence_that_was_begun_swallows_no_stop(begun, stop, name):
    """The stop may also be the sequence's end; it moves nothing."""
    assert keys(begun + stop + b"~w")[:1] == [Key(name)]
    assert keys(begun + stop + b"~w")[-1] == Key("w")


@pytest.mark.parametrize("seed", range(20))
def test_random_bytes_do_no_harm_and_plain_keys_are_read_after_ctrl_x(seed):
    decoder = Decoder()
    decoder.feed(random.Random(seed).randbytes(2000) + b"\x18", 0.0)
    assert decoder.feed(b"w", 2.0) == [Key("w")]


@pytest.mark.parametrize("name", KEY_MAPS)
def test_a_key_has_one_meaning(name):
    keys = KEY_MAPS[name]
    meanings = [keys.motions, keys.speeds, keys.stops, E_STOPS, {"r", "y"}]
    assert sum(map(len, meanings)) == len(set().union(*meanings))


@pytest.mark.parametrize("name", KEY_MAPS)
def test_the_e_stop_does_not_lie_beside_a_motion_key(name):
    """The keys are those of a US keyboard; Esc and ! (above 1) lie in its upper left corner."""
    beside = {"1", "2", "`", "tab"}
    assert not beside & set(KEY_MAPS[name].motions)


@pytest.mark.parametrize("name", KEY_MAPS)
def test_every_motion_has_its_opposite(name):
    motions = {(motion.linear, motion.angular, motion.lateral) for motion in KEY_MAPS[name].motions.values()}
    assert motions == {(-linear, -angular, -lateral) for linear, angular, lateral in motions}
    assert len(motions) == 10
