"""The values of config/console.yaml, and those that follow from them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from robot_control.common.settings_files import SettingsError, overlaid

MARGIN = 0.1
"""s for the server's passes, the network beyond it and the robot's nodes; measured below 40 ms on an idle machine"""


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
    values, problems = overlaid(paths, _wrong)
    if problems:
        raise SettingsError("; ".join(problems))
    return Settings(**{name: float(value) for name, value in values.items()})


def _wrong(tree: object) -> Iterator[str]:
    if not isinstance(tree, dict):
        yield "must be a map of names and numbers"
        return
    for name, value in tree.items():
        number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
        if name not in ("distance", "link_gap"):
            yield f"{name}: unknown; known are distance, link_gap"
        elif not number or value <= 0:
            yield f"{name} = {value!r}: must be a number above zero"
