"""Figures against budgets."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import-untyped]

from robot_control.data.report.figures import Figure
from robot_control.files.files import check_input, printable

MAX_BUDGETS = 1 << 20
"""bytes"""
BOUNDS = ("most", "least")


class BudgetError(ValueError):
    """A file of budgets cannot be applied; the message names all errors in it."""


class Verdict(Enum):
    """Verdict on one figure."""

    OK = "ok"
    FAILED = "FAILED"
    UNKNOWN = "not in this log"
    UNJUDGED = ""


@dataclass(frozen=True)
class Judged:
    """A figure, its bounds and the verdict."""

    figure: Figure
    most: float | None = None
    least: float | None = None

    @property
    def bounds(self) -> list[tuple[str, float]]:
        """Sign and value."""
        return [(sign, bound) for sign, bound in (("≤", self.most), ("≥", self.least)) if bound is not None]

    @property
    def verdict(self) -> Verdict:
        """The verdict; a figure without a bound has none."""
        value = self.figure.value
        if self.most is None and self.least is None:
            return Verdict.UNJUDGED
        if math.isnan(value):
            return Verdict.UNKNOWN
        broken = (self.most is not None and value > self.most) or (self.least is not None and value < self.least)
        return Verdict.FAILED if broken else Verdict.OK


Budgets = Mapping[str, Mapping[str, float]]


def read_budgets(path: Path, known: Mapping[str, Figure]) -> Budgets:
    """Bounds by the figure's name.

    Raises:
        BudgetError: no budget at all, no such figure or bound, or a bound that is no number.
        OSError: it cannot be opened.
    """
    check_input(path, MAX_BUDGETS)
    try:
        tree: Any = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise BudgetError(f"{path}: {error}") from None
    if not isinstance(tree, dict) or not tree:
        raise BudgetError(f"{path}: contains no budgets; a line is NAME: {{most: NUMBER}} or {{least: NUMBER}}")
    problems = [problem for name, bounds in tree.items() for problem in _problems(str(name), bounds, known)]
    if problems:
        raise BudgetError(f"{path}: " + "; ".join(problems))
    return tree


def _problems(name: str, bounds: Any, known: Mapping[str, Figure]) -> list[str]:  # noqa: ANN401 (of YAML)
    if name not in known:
        return [f"unknown figure {printable(name)}; there are {', '.join(known)}"]
    if not isinstance(bounds, dict) or not bounds or not set(bounds) <= set(BOUNDS):
        return [f"{name}: {printable(str(bounds))} is not {{most: NUMBER}} or {{least: NUMBER}}"]
    return [
        f"{name}.{bound}: {printable(str(value))} is not a number"
        for bound, value in bounds.items()
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value)
    ]


def judge(found: Mapping[str, Figure], budgets: Budgets) -> list[Judged]:
    """All figures, those with a budget first."""
    judged = [
        Judged(figure, budgets.get(name, {}).get("most"), budgets.get(name, {}).get("least"))
        for name, figure in found.items()
    ]
    return sorted(judged, key=lambda one: one.verdict is Verdict.UNJUDGED)


def failed(judged: list[Judged]) -> list[Judged]:
    """Those that break their budget."""
    return [one for one in judged if one.verdict is Verdict.FAILED]
