"""The Chinese table is complete: each name, each phrase of why.py and each text of the console has a row."""

import ast
import re
import time
from collections import defaultdict
from html.parser import HTMLParser
from pathlib import Path

import pytest
from robot_control._robot_control import signal_names
from robot_control.loop.signal_names import templates
from robot_control.watch.words.words import MAX_LENGTH, pairs_in, table_of, words_in

PACKAGE = Path(__file__).parents[3] / "python/robot_control"
PAGE = PACKAGE / "watch/console/page"
TABLE, CHINESE = table_of("zh"), words_in("zh")
ROWS = [(kind, name, *row) for kind, names in TABLE["names"].items() for name, row in names.items()]
HOLE = re.compile(r"\{\w+\}")
UNTRANSLATED = re.compile(r"[–⋯×?]|m|m/s|rad/s|[xy]|yaw|\{.*\}")
"""Units, axes and values that stand in the page as in the table's other texts"""
UNREAD = re.compile(r"^ros(run|launch) |^input, |void main")
"""Commands for a shell, selectors and parts of shaders in a script"""


def test_every_name_has_a_row_and_no_row_is_without_a_name():
    """A name: of a bit that is described by a sentence."""
    rows = {kind: [row for row in rows if isinstance(row, tuple)] for kind, rows in signal_names.items()}
    described = {kind: [name for name, sentence, *_ in rows if sentence] for kind, rows in rows.items()}
    roles = {"Role", "RobotKind"}
    assert {kind: list(names) for kind, names in TABLE["names"].items()} == {
        kind: names for kind, names in described.items() if names and kind not in roles
    }


@pytest.mark.parametrize(("kind", "name", "sentence", "remedy"), ROWS)
def test_a_row_says_as_much_as_the_english_one(kind, name, sentence, remedy):
    """It has a remedy where that one has, and the same nodes and topics."""
    (english,) = (row for row in templates(kind) if row.name == name)
    for ours, theirs in ((sentence, english.sentence), (remedy, english.remedy)):
        assert bool(ours) == bool(theirs)
        assert set(HOLE.findall(ours)) == set(HOLE.findall(theirs))
        assert not ours or re.search(r"[\u4e00-\u9fff]", ours)


def test_one_english_text_has_one_chinese_text():
    found = defaultdict(set)
    for kind, name, *chinese in ROWS:
        (english,) = (row for row in templates(kind) if row.name == name)
        for theirs, ours in zip((english.sentence, english.remedy), chinese, strict=True):
            found[theirs].add(ours)
    assert {english: ours for english, ours in found.items() if len(ours) > 1} == {}


def test_a_phrase_has_the_parts_of_the_english_one_once():
    for english, chinese in TABLE["phrases"].items():
        parts = HOLE.findall(english)
        assert sorted(parts) == sorted(HOLE.findall(chinese)), english
        assert len(set(parts)) == len(parts), english


def literals(path):
    """The texts of at least two words in a source, without docstrings and commands for a shell."""
    tree = ast.parse(path.read_text())
    documentation = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documentation:
            text = node.value.strip()
            if re.search(r"[a-z]{2}\W* \W*[a-z]{2}", text) and not re.match(r"ros(run|launch|service|topic) ", text):
                yield text


@pytest.mark.parametrize(
    "name",
    [
        "robot/diagnosis/diagnosis.py",
        "robot/diagnosis/legs.py",
        "robot/diagnosis/lateness.py",
        "watch/why/screen.py",
        "watch/console/authority.py",
        "watch/console/backend.py",
        "watch/console/calls.py",
        "watch/console/dead_man.py",
    ],
)
def test_every_text_of_why_and_of_the_console_is_part_of_a_phrase(name):
    phrases = [english for english, _ in pairs_in("zh")]
    assert [text for text in literals(PACKAGE / name) if not any(text in phrase for phrase in phrases)] == []


class Texts(HTMLParser):
    """The texts of a page, and the names of its elements for a reader that speaks."""

    def __init__(self, page):
        super().__init__()
        self.found = []
        self.feed(page.read_text())

    def handle_data(self, data):
        self.found.append(" ".join(data.split()))

    def handle_starttag(self, _, attributes):
        self.found += [value for name, value in attributes if name == "aria-label"]


@pytest.mark.parametrize("name", ["index.html", "login.html"])
def test_every_text_of_a_page_has_a_row(name):
    found = [text for text in Texts(PAGE / name).found if text and not UNTRANSLATED.fullmatch(text)]
    assert len(found) > 5
    assert [text for text in found if text not in TABLE["phrases"]] == []


@pytest.mark.parametrize("path", sorted(PAGE.glob("*.js")), ids=lambda path: path.name)
def test_every_text_of_a_script_is_part_of_a_phrase(path):
    """A text: two words of letters at least, between quotes, or in a template between its values."""
    code = re.sub(r"^\s*(//|/?\*).*$|\s//\s.*$", "", path.read_text(), flags=re.MULTILINE)
    quoted = re.findall(r'"([^"\n]*)"', code)
    between = [part for text in re.findall(r"`([^`]*)`", code) for part in re.split(r"\$\{.*?\}", text)]
    texts = [text.strip() for text in (*quoted, *between) if re.search(r"[a-z]{2},? [a-z]{2}", text)]
    read = [text for text in texts if not UNREAD.search(text)]
    assert [text for text in read if not any(text in phrase for phrase in TABLE["phrases"])] == []


@pytest.mark.parametrize(
    ("english", "chinese"),
    [
        (
            "Stopped: a wheel is faster than allowed (17.3 rad/s, limit 15 rad/s, left_wheel_joint).",
            "已停机：车轮转速超过允许值（17.3 rad/s，限值 15 rad/s，left_wheel_joint）。",
        ),
        ("operator: then call e_stop_reset", "操作员：然后调用 e_stop_reset"),
        (
            "stall: a wheel does not turn although motion is commanded: 0.5 rad, limit 0.5 rad [first]",
            "stall：有运动指令，但车轮不转（堵转）：0.5 rad，限值 0.5 rad [首个]",
        ),
        (
            "the battery is low: 20.9 V, limit 21 V (charge the battery soon)",
            "电池电量低：20.9 V，限值 21 V（请尽快充电）",
        ),
        (
            "nothing was received on cmd_vel or body_pose in this run",
            "本次运行中尚未在 cmd_vel 或 body_pose 上收到消息",
        ),
        (
            "left coasts (as stated), right coasts (as stated); load at most 62 %",
            "left coasts（as stated），right coasts（as stated）；load at most 62 %",
        ),
        (
            "Walking: 0.30 m/s; a foot hit an obstacle, and is lifted over it. The ground rises 9.9 deg to the left.",
            "正在行走：0.30 m/s；有一只脚碰到障碍物，正被抬起越过。地面向左侧升高 9.9 度。",
        ),
        (
            "Walking in place until its feet are in position, then standing; a foot hit an obstacle, and is lifted over"
            " it. The ground rises 9.9 deg to the rear right.",
            "原地踏步，足端到位后站住；有一只脚碰到障碍物，正被抬起越过。地面向右后升高 9.9 度。",
        ),
        (
            "Walking: 0.30 m/s; a foot hit an obstacle, and is lifted over it; a foot finds no ground where it was to"
            " land, and goes farther down.",
            "正在行走：0.30 m/s；有一只脚碰到障碍物，正被抬起越过；有一只脚在落点处没有踩到地面，正继续下探。",
        ),
        ("mujoco_plant, state_estimator MISSING", "mujoco_plant，state_estimator 缺失"),
        ("anna (page 2), watch", "anna（页面 2），只看（watch）"),
        ("a text of another program", "a text of another program"),
    ],
)
def test_a_text_is_translated_with_its_parts(english, chinese):
    assert CHINESE.of(english) == chinese


def test_a_long_text_of_another_program_stays_and_one_that_fits_everywhere_costs_little_time():
    assert CHINESE.of("; ".join(["Moving."] * MAX_LENGTH)).startswith("Moving.")
    began = time.process_time()
    CHINESE.of("Walking: " + "; , : ( " * ((MAX_LENGTH - 9) // 8))
    assert time.process_time() - began < 1.0


def test_english_stays_as_it_is():
    assert words_in("en").of("Moving.") == "Moving."
