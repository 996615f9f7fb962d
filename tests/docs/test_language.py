"""The rules of tests/docs/language.py on short texts, and that the committed counts can only fall."""

import pytest
from language import cpp_texts, differences, lowered, of_page, of_source, python_texts


def kinds(text):
    return [finding.kind for finding in of_page(text)]


def words_of(text):
    return [finding.text.split("'")[1] for finding in of_page(text) if finding.kind == "word"]


LONG = "The robot " + "stops and " * 12 + "stands."
"""27 words."""


def test_a_sentence_of_more_than_25_words_is_found():
    assert kinds(LONG) == ["sentence"]
    assert kinds(LONG.replace("stops and ", "stops. And ", 1)) == []


def test_a_sentence_ends_with_its_paragraph_and_its_list_item():
    half = LONG.removesuffix(" and stands.").rsplit(" and ", 5)[0]
    assert kinds(f"{half}\n{LONG[len(half) + 1 :]}") == ["sentence"]
    assert kinds(f"{half}\n\n{LONG[len(half) + 1 :]}") == []
    assert kinds(f"- {half}\n- {LONG[len(half) + 1 :]}") == []


def test_code_blocks_and_comments_are_no_prose_and_inline_code_is_one_word():
    assert kinds(f"```sh\n{LONG}\n```\n\n    {LONG}\n\n<!-- {LONG} -->\n") == []
    assert kinds(f"It prints `{LONG}` here.") == []


def test_a_link_counts_as_the_words_it_shows():
    assert words_of("See [the list](the_way_of_a_law.md).") == []
    assert words_of("See [the law](list.md).") == ["law"]


def test_a_cell_of_more_than_15_words_is_found():
    assert kinds("| a | b |\n|---|---|\n| " + "word " * 15 + "| c |") == []
    assert kinds("| a | b |\n|---|---|\n| " + "word " * 16 + "| c |") == ["cell"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("The robot drives the way, too.", ["the way", ", too"]),
        ("Look whether it gets its core.", ["Look whether", "gets its core"]),
        ("There is no map. Such a file is no map.", ["There", "is no"]),
        ("## What moves the robot", ["What"]),
        ("## What moves the robot?", []),
        ("The wheels bear the load of the one side.", ["bear", "the one"]),
    ],
)
def test_words_of_the_list_are_found(text, words):
    assert words_of(text) == words


def test_texts_of_a_c_source_are_its_literals_without_comments():
    source = '#include "a.h"\nfail("two parts"  // "none"\n     " of one");\n/// "none"\n'
    assert list(cpp_texts(source)) == [(2, "two parts of one")]


def test_texts_of_a_python_source_are_its_strings_without_docstrings():
    assert list(python_texts('"""A docstring."""\nprint("a text", f"with {value} in it")\n')) == [
        (2, "a text"),
        (2, "with x in it"),
    ]


def test_a_message_has_at_least_four_words():
    assert [*of_source("a.def", 'A("the one way")')] == []
    assert [finding.kind for finding in of_source("a.def", 'A("the one, in a way")')] == ["word", "word"]


def test_a_count_may_only_fall_and_its_row_falls_with_it():
    rows = {"a.md": [2, 0, 1], "b.md": [0, 0, 1]}
    assert differences(rows, rows) == []
    assert "3, at most 2" in differences({**rows, "a.md": [3, 0, 1]}, rows)[0]
    assert "only 0 of 1" in differences({"a.md": [2, 0, 1]}, rows)[0]
    assert "at most 0" in differences({**rows, "new.md": [0, 1, 0]}, rows)[0]
    assert lowered({"a.md": [3, 0, 0]}, rows) == {"a.md": [2, 0, 0]}
