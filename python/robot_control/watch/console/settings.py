"""The values of config/console.yaml, and those that follow from them."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path

from robot_control.settings.files import number, rules_of, settings_of, wrong_values

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


RULES = rules_of(Settings, distance=number(0.001, 1000), link_gap=number(0.001, 1000))


def read_settings(*paths: Path) -> Settings:
    """The values of these files, each laid over the one before. Raises SettingsError with all problems, OSError."""
    wrong = partial(wrong_values, rules=RULES)
    return settings_of(paths, wrong, lambda values: Settings(**{name: float(value) for name, value in values.items()}))
