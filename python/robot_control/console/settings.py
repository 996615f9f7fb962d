"""Values of config/console.yaml."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import-untyped]

MARGIN = 0.1
"""s for the server's passes, the network beyond it and the robot's nodes; measured below 40 ms on an idle machine"""


class SettingsError(ValueError):
    """The settings cannot be used; the message names every problem."""


@dataclass(frozen=True)
class Settings:
    """Units and meaning stand in config/console.yaml."""

    hold: float = 0.15  # s
    link_gap: float = 0.3  # s
    late_after: float = 0.3  # s
    distance: float = 0.3  # m
    reaction: float = 0.4  # s
    max_hold: float = 30.0  # s
    linear: float = 0.5  # m/s
    angular: float = 1.0  # rad/s


def read_settings(*paths: Path) -> Settings:
    """The values of these files, each laid over the one before.

    Raises:
        SettingsError: with all problems.
        OSError: a file cannot be read.
    """
    values, problems = asdict(Settings()), []
    known = {field.name for field in fields(Settings)}
    for path in paths:
        for name, value in _tree(path).items():
            number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
            if name not in known:
                problems.append(f"{path}: {name}: unknown; known are {', '.join(sorted(known))}")
            elif not number or value <= 0:
                problems.append(f"{path}: {name} = {value!r}: must be a number above zero")
            else:
                values[name] = float(value)
    settings = Settings(**values)
    if not problems and settings.reaction < settings.link_gap + MARGIN - 1e-9:
        problems.append(
            f"reaction = {settings.reaction:g} s: must be at least link_gap + {MARGIN:g} s = "
            f"{settings.link_gap + MARGIN:g} s, because a broken link is noticed only after link_gap"
        )
    if not problems and settings.hold > settings.link_gap:
        problems.append(f"hold = {settings.hold:g} s: must be at most link_gap = {settings.link_gap:g} s")
    if problems:
        raise SettingsError("; ".join(problems))
    return settings


def _tree(path: Path) -> dict[str, Any]:
    try:
        tree = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (yaml.YAMLError, UnicodeDecodeError, RecursionError) as error:
        raise SettingsError(f"{path}: is no YAML: {error}") from None
    if tree is None:
        return {}
    if not isinstance(tree, dict):
        raise SettingsError(f"{path}: must be a map of names and numbers")
    return {str(name): value for name, value in tree.items()}
