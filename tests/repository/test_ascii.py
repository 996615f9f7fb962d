"""Texts that cross a ROS interface are ASCII: rosservice and rostopic print anything else as escapes."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BRIDGE = sorted((ROOT / "src/ros").rglob("*.cpp"))
KNOWN = set(re.findall(r'\{"([^"\x00-\x7f]+)",', (ROOT / "src/files/ascii.cpp").read_text()))


DEFINITIONS = sorted(path for name in ("msg", "srv", "action") for path in (ROOT / name).iterdir())


@pytest.mark.parametrize("path", DEFINITIONS, ids=lambda path: path.name)
def test_definitions_of_messages_and_services_are_ascii(path):
    assert path.read_text().isascii()


def literals(path):
    """The string literals of a source without its comments."""
    code = re.sub(r"//[^\n]*", lambda match: "" if match[0].count('"') % 2 == 0 else match[0], path.read_text())
    return re.findall(r'"(?:[^"\\\n]|\\.)*"', code)


def test_every_sign_in_a_message_of_any_layer_has_a_spelling_in_ascii():
    unknown = {}
    for path in sorted((ROOT / "src").rglob("*.[hc]*")):
        for sign in {sign for text in literals(path) for sign in text if not sign.isascii()} - KNOWN:
            unknown[f"{path.relative_to(ROOT)}: {sign}"] = f"add it to src/files/ascii.cpp: U+{ord(sign):04X}"
    assert not unknown


@pytest.mark.parametrize("path", BRIDGE, ids=lambda path: path.name)
def test_every_answer_of_a_service_goes_through_ascii_or_is_a_literal(path):
    code = re.sub(r'"(?:[^"\\\n]|\\.)*"', '""', path.read_text())
    for built in re.findall(r"\bresponse\.message \+?=\s*([^;]+);", code):
        assert "ascii(" in built or not re.search(r"\w", built), built
