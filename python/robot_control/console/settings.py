"""The values of config/console.yaml, and those that follow from them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import yaml  # type: ignore[import-untyped]

MARGIN = 0.1
"""s for the server's passes, the network beyond it and the robot's nodes; measured below 40 ms on an idle machine"""


class SettingsError(ValueError):
    """The settings cannot be used; the message names every problem."""


@dataclass(frozen=True)
class Settings:
    """The values; config/console.yaml explains them."""

    distance: float = 0.3  # m
    link_gap: float = 0.3  # s

    @property
    def command_life(self) -> float:
        """s for which one message moves the robot; then the command is zero until the next one."""
        return self.link_gap / 2

    @property
    def reaction(self) -> float:
        """s from the loss of a link to the first command of zero, without the link's own delay."""
        return self.link_gap + MARGIN


def read_settings(*paths: Path) -> Settings:
    """The values of these files, each laid over the one before. Raises SettingsError with all problems, OSError."""
    settings, problems = Settings(), []
    for path in paths:
        try:
            tree = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
        except (yaml.YAMLError, UnicodeDecodeError, RecursionError) as error:
            raise SettingsError(f"{path}: is no YAML: {error}") from None
        if not isinstance(tree, dict):
            raise SettingsError(f"{path}: must be a map of names and numbers")
        for name, value in tree.items():
            number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
            if name not in ("distance", "link_gap"):
                problems.append(f"{path}: {name}: unknown; known are distance, link_gap")
            elif not number or value <= 0:
                problems.append(f"{path}: {name} = {value!r}: must be a number above zero")
            else:
                settings = replace(settings, **{name: float(value)})
    if problems:
        raise SettingsError("; ".join(problems))
    return settings
