"""Lines on a terminal, in English and Chinese."""

import textwrap

import pytest
from robot_control.ui.columns import columns, padded, wrapped

ENGLISH = "causes     stall: a wheel does not turn although motion is commanded: 0.5031 rad, limit 0.5015 rad"
CHINESE = "已停机：有运动指令，但车轮不转（堵转）（0.5031 rad，限值 0.5015 rad，left_wheel_joint）。"


def test_a_chinese_sign_is_two_columns_wide():
    assert columns("限速 0.3 m/s") == 4 + len(" 0.3 m/s")
    assert columns(padded("限速", 11)) == 11


@pytest.mark.parametrize("width", range(14, 60))
def test_an_english_text_is_wrapped_as_textwrap_does(width):
    assert wrapped(ENGLISH, width, "  ") == textwrap.wrap(
        ENGLISH, width, subsequent_indent="  ", break_on_hyphens=False
    )


@pytest.mark.parametrize("width", range(20, 60))
def test_a_chinese_text_fills_the_lines_and_none_begins_with_a_closing_sign(width):
    lines = wrapped(CHINESE, width)
    assert "".join(line.replace(" ", "") for line in lines) == CHINESE.replace(" ", "")
    assert max(map(columns, lines)) <= width
    assert not any(line.startswith(("，", "。", "）")) for line in lines)


def test_a_word_longer_than_a_line_is_broken():
    assert wrapped("a " + 25 * "x", 10) == ["a", 10 * "x", 10 * "x", 5 * "x"]
    assert wrapped("", 10) == []
