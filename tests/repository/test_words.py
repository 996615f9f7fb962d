"""The texts of the program use the terms of docs/glossary.md: no word that treats a node or a joint as a person."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BANNED = re.compile(r"\b(told|tells|believed|believes|anew|nobody|whoever|wish|wished)\b", re.IGNORECASE)
FOLDERS = ("src", "config", "msg", "srv", "scripts", "python", "bench", "tests")
SUFFIXES = {".h", ".cpp", ".py", ".sh", ".txt", ".yaml", ".msg", ".srv", ""}
LEFT_OUT = (
    "tests/estimation",
    "tests/control",
    "tests/log/rows",
    "tests/docs/language.py",
    "tests/repository/test_words.py",
)
"""Three to be rewritten with their laws, and two lists of words."""


def hits(folder):
    found = []
    for path in sorted((ROOT / folder).rglob("*")):
        if not path.is_file() or path.suffix not in SUFFIXES:
            continue
        if path.relative_to(ROOT).as_posix().startswith(LEFT_OUT):
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            found += [f"{path.relative_to(ROOT)}:{number}: {word}" for word in BANNED.findall(line)]
    return found


@pytest.mark.parametrize("folder", FOLDERS)
def test_banned_words_stay_out(folder):
    assert hits(folder) == []
