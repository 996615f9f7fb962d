"""The settings of a program in YAML files, each laid over the one before."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import-untyped]

from robot_control.common.files import printable

MAX_OPENED = 200
"""brackets of a kind in a file; of settings that have a meaning, less than ten"""


class SettingsError(ValueError):
    """The settings cannot be used; the message names every problem."""


def overlaid(paths: Iterable[Path], problems_of: Callable[[Any], Iterable[str]]) -> tuple[dict[str, Any], list[str]]:
    """The values of all files without a problem, and the problems of the others, each with the file.

    Raises:
        SettingsError: a file is no YAML.
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
            raise SettingsError(f"{path}: is no YAML{_place_of(error)}") from None
        found = [f"{path}: {problem}" for problem in problems_of(tree)]
        problems += found
        values |= {} if found else tree
    return values, problems


def _place_of(error: Exception) -> str:
    """Line and problem, without the text of the line, which may hold a password."""
    mark, problem = getattr(error, "problem_mark", None), getattr(error, "problem", "")
    return f", line {mark.line + 1}: {printable(str(problem))}" if mark else f": {type(error).__name__}"
