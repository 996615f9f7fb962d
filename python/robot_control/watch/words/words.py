"""Translates a text for display: sentences and remedies by their names, all others by their English text."""

import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import-untyped]

from robot_control.loop.signal_names import templates

LANGUAGES = ("en", "zh")
MAX_LENGTH = 500
"""characters; a longer text stays as it is, for a text of another program may not cost time"""
_HOLE = re.compile(r"\{(\w+)\}")

Pair = tuple[str, str]
"""An English text and its translation; a word in braces stands for a part that is translated by itself."""


class Words:
    """The translation into one language: the first row that fits counts, and a text without a row stays as it is.

    A row does not fit if it cuts a text between two parentheses.
    """

    def __init__(self, pairs: Iterable[Pair] = ()) -> None:
        given = list(pairs)
        self._whole = {english: other for english, other in given if not _HOLE.search(english)}
        self._patterns = [(_pattern(english), other) for english, other in given if _HOLE.search(english)]

    def of(self, text: str) -> str:
        """The text in this language."""
        if text in self._whole or not self._patterns or len(text) > MAX_LENGTH:
            return self._whole.get(text, text)
        for pattern, other in self._patterns:
            found = pattern.fullmatch(text)
            if found and all(map(_closed, found.groups())):
                return other.format_map({name: self.of(part) for name, part in found.groupdict().items()})
        return text


ENGLISH = Words()


@cache
def words_in(language: str) -> Words:
    """The words of a language of LANGUAGES."""
    return Words(pairs_in(language))


@cache
def pairs_in(language: str) -> tuple[Pair, ...]:
    """All rows of a language, in the order in which they are tried; names also with remedy and measured value."""
    if language == "en":
        return ()
    table = table_of(language)
    rows: dict[str, str] = {}
    for kind, names in table["names"].items():
        english = {row.name: row for row in templates(kind)}
        for name, (sentence, remedy) in names.items():
            rows |= dict(_uses(english[name].sentence, english[name].remedy, sentence, remedy))
    return tuple(sorted((rows | table["phrases"]).items(), key=_generality))


def table_of(language: str) -> dict[str, Any]:
    """The file of a language: names and phrases."""
    content: dict[str, Any] = yaml.safe_load((Path(__file__).parent / f"{language}.yaml").read_text(encoding="utf-8"))
    return content


def _uses(sentence: str, remedy: str, other: str, other_remedy: str) -> Iterator[Pair]:
    yield sentence, other
    yield f"{sentence}: {{measured}}", f"{other}：{{measured}}"
    yield f"{sentence} ({{measured}})", f"{other}（{{measured}}）"
    if remedy:
        yield remedy, other_remedy
        remedy, other_remedy = (_HOLE.sub(r"{\1_}", text) for text in (remedy, other_remedy))  # names of their own
        yield f"{sentence} ({remedy})", f"{other}（{other_remedy}）"
        yield f"{sentence}: {{measured}} ({remedy})", f"{other}：{{measured}}（{other_remedy}）"


def _generality(pair: Pair) -> tuple[int, int]:
    """Patterns with more letters are tried first, then longer ones. Lists fit most: the last, in their order."""
    if pair[0].endswith("{more}"):
        return 0, 0
    fixed = _HOLE.sub("", pair[0])
    letters = len(re.findall(r"\w", fixed))
    return -letters, -len(fixed) if letters else 0


def _closed(part: str) -> bool:
    """No parenthesis opens or ends in it alone, and no sentence ends within it."""
    return not re.search(r"[()]|\. [A-Z]", re.sub(r"\([^()]*\)", "", part))


def _pattern(english: str) -> re.Pattern[str]:
    return re.compile(re.sub(r"\\\{(\w+)\\\}", r"(?P<\1>.+?)", re.escape(english)))
