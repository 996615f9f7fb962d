"""Answers from a pipe."""

import os

import pytest
from robot_control.setup.terminal_dialog import NoAnswerError, Questions


@pytest.fixture
def asked():
    """A function: Questions that will receive this text, then the end."""
    descriptors = []

    def make(text, going_on=lambda: True):
        reader, writer = os.pipe()
        os.write(writer, text.encode())
        os.close(writer)
        descriptors.append(reader)
        return Questions(going_on, reader)

    yield make
    for descriptor in descriptors:
        os.close(descriptor)


def test_reads_lines_one_by_one(asked):
    questions = asked("one\n two \nthree\n")
    assert [questions.line("?") for _ in range(3)] == ["one", "two", "three"]


def test_asks_again_until_the_answer_is_one(asked, capsys):
    assert asked("maybe\nYES\n").yes("way free?") is True
    assert asked("n\n").yes("way free?") is False
    assert "y or n" in capsys.readouterr().out


def test_a_value_is_asked_for_until_it_is_taken(asked, capsys):
    value = asked("three\n9\n3\n").value("m?", float, lambda x: "too far" if x > 5 else "")
    assert value == 3
    said = capsys.readouterr().out
    assert "three" in said
    assert "too far" in said


def test_an_answer_given_twice_is_accepted(asked):
    assert asked("9\n9\n").value("m?", float, lambda x: "too far" if x > 5 else "") == 9


def test_the_end_of_the_input_is_reported(asked):
    with pytest.raises(NoAnswerError, match="no terminal"):
        asked("half").line("how far?")


def test_a_signal_ends_the_question():
    reader, writer = os.pipe()
    try:
        with pytest.raises(NoAnswerError, match="interrupted"):
            Questions(lambda: False, reader).line("?")
    finally:
        os.close(reader)
        os.close(writer)
