"""The settings of a program in YAML files, each laid over the one before."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

import yaml  # type: ignore[import-untyped]

from robot_control.files.files import printable

MAX_OPENED = 200
"""brackets of a kind in a file; of settings that have a meaning, less than ten"""


Made = TypeVar("Made")
Check = Callable[[Any], bool]
"""True for a value that may be used"""
Rule = tuple[str, Check]
"""of a value: what it must be"""


class SettingsError(ValueError):
    """The settings cannot be used; the message names every problem."""


def in_range(least: float, most: float, kind: type = float) -> Check:
    """A finite number of this range; `kind` int: a whole one."""
    kinds = (int,) if kind is int else (int, float)
    return lambda value: isinstance(value, kinds) and not isinstance(value, bool) and least <= value <= most


def number(least: float, most: float, kind: type = float) -> Rule:
    """The same, for a message."""
    return f"a {'whole ' if kind is int else ''}number from {least:g} to {most:g}", in_range(least, most, kind)


def matching(pattern: str, words: str) -> Rule:
    """A text of this pattern."""
    return words, lambda value: isinstance(value, str) and bool(re.fullmatch(pattern, value))


def list_of(rule: Rule) -> Rule:
    """A list of such values."""
    return f"a list, each {rule[0]}", lambda value: isinstance(value, list) and all(map(rule[1], value))


TEXT: Rule = ("a text of characters that print", lambda value: isinstance(value, str) and value.isprintable())
FLAG: Rule = ("true or false", lambda value: isinstance(value, bool))
NUMBER: Rule = ("a number", in_range(-1e308, 1e308))
WHOLE: Rule = ("a whole number", in_range(-1e308, 1e308, int))
BY_DEFAULT = {bool: FLAG, int: WHOLE, float: NUMBER, str: TEXT, tuple: list_of(TEXT)}


def rules_of(settings: type, **own: Rule) -> dict[str, Rule]:
    """The rule of each field of a dataclass: its own, or that of the type of its default."""
    return {each.name: own.get(each.name) or BY_DEFAULT[type(each.default)] for each in fields(settings)}


def wrong_values(tree: object, rules: Mapping[str, Rule], of: str = "") -> Iterator[str]:
    """The values of a tree that break their rules; `of`: the beginning of their names."""
    if not isinstance(tree, dict):
        yield f"{of.rstrip('.') or 'the file'}: must hold keys with values"
        return
    for name, value in tree.items():
        if name not in rules:
            yield f"{of}{shown(name)}: is unknown; known are {', '.join(rules)}"
        elif not rules[name][1](value):
            yield f"{of}{name} = {shown(value)}: must be {rules[name][0]}"


def shown(value: object) -> str:
    """The value, in which a text may be a place; of a list or of a long number its kind alone."""
    plain = isinstance(value, str | bool | float) or (isinstance(value, int) and abs(value) < 1 << 64)
    return redacted(str(value)) if plain else f"a value of the kind {type(value).__name__}"


def redacted(place: str) -> str:
    """A place as rclone names it, for a message: without the options of a connection string and the user of a URL."""
    return printable(place if place.startswith("/") else re.sub(r"(?s)(,|//).*", r"\1…", place))


def settings_of(
    paths: Iterable[Path],
    problems_of: Callable[[Any], Iterable[str]],
    make: Callable[[dict[str, Any]], Made],
    together: Callable[[Made], Iterable[str]] = lambda _: (),
) -> Made:
    """The settings that `make` gives of all files, each laid over the one before; `together`: the rules across values.

    Raises:
        SettingsError: with all problems.
        OSError: a file cannot be read.
    """
    values, problems = dict[str, Any](), list[str]()
    for path in paths:
        data = path.read_bytes()
        try:
            text = data.decode()
            if max(map(text.count, "[{")) > MAX_OPENED:  # PyYAML takes the square of their number
                raise ValueError
            tree = yaml.safe_load(text) or {}
        except Exception as error:  # PyYAML raises any
            raise SettingsError(f"{path}: is not YAML{_place_of(error)}") from None
        found = [f"{path}: {problem}" for problem in problems_of(tree)]
        problems += found
        values |= {} if found else tree
    made = make(values)
    problems += together(made)
    if problems:
        raise SettingsError("; ".join(problems))
    return made


def _place_of(error: Exception) -> str:
    """Line and problem, without the text of the line, which may hold a password."""
    mark, problem = getattr(error, "problem_mark", None), getattr(error, "problem", "")
    return f", line {mark.line + 1}: {printable(str(problem))}" if mark else f": {type(error).__name__}"
