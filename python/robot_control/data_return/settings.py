"""The values of config/data_return.yaml."""

from __future__ import annotations

import re
import socket
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from robot_control.blackbox.main import LOGS
from robot_control.common.file_errors import problems_of
from robot_control.common.files import given_path, printable
from robot_control.common.settings_files import SettingsError, overlaid

RCLONE_CONFIG = "~/.config/rclone/rclone.conf"
"""rclone's own place for it"""
HOURS = re.compile(r"([01]\d|2[0-3]):([0-5]\d)-([01]\d|2[0-3]):([0-5]\d)")
ROBOT = re.compile(r"(?!\.)[A-Za-z0-9_.-]{1,64}")
RULES: dict[type, tuple[str, Callable[[Any], bool]]] = {
    bool: ("true or false", lambda value: isinstance(value, bool)),
    float: (
        "a number, 0 or more, at most 1e9",
        lambda value: isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value <= 1e9,
    ),
    str: ("a text of characters that print", lambda value: isinstance(value, str) and value.isprintable()),
    tuple: ("a list of texts", lambda value: isinstance(value, list) and all(isinstance(each, str) for each in value)),
}
"""of a setting, by the type of its default"""


@dataclass(frozen=True)
class Settings:
    """The values; config/data_return.yaml explains them."""

    far_side: str = ""
    robot: str = ""
    rclone_config: str = RCLONE_CONFIG
    ca_file: str = ""
    folder: str = ""
    queue_folder: str = ""
    bandwidth: float = 0.0
    hours: tuple[str, ...] = ()
    only_at_rest: bool = False
    metered: bool = False
    metered_interfaces: tuple[str, ...] = ()
    local_quota: float = 0.0
    far_quota: float = 0.0

    @property
    def logs(self) -> Path:
        """The folder whose files return."""
        return given_path(self.folder or str(LOGS))

    @property
    def queue(self) -> Path:
        """The folder of the queue."""
        return given_path(self.queue_folder) if self.queue_folder else self.logs / "data_return"

    @property
    def destination(self) -> str:
        """The folder of this robot, as rclone names it."""
        slash = "" if self.far_side.endswith((":", "/")) else "/"
        return f"{self.far_side}{slash}{self.name}"

    @property
    def name(self) -> str:
        """The robot's name."""
        return self.robot or socket.gethostname()


def redacted(place: str) -> str:
    """A place as rclone names it, for a message: without the options of a connection string and the user of a URL."""
    return printable(place if place.startswith("/") else re.sub(r"(?s)(,|//).*", r"\1…", place))


def read_settings(*paths: Path) -> Settings:
    """The values of these files, each laid over the one before.

    Raises:
        SettingsError: with all problems.
        OSError: a file cannot be read.
    """
    values, problems = overlaid(paths, _wrong_types)
    values = {name: tuple(value) if isinstance(value, list) else value for name, value in values.items()}
    settings = Settings(**values)
    problems += _together(settings)
    if problems:
        raise SettingsError("; ".join(problems))
    return settings


def _wrong_types(tree: object) -> Iterator[str]:
    if not isinstance(tree, Mapping):
        yield "must hold keys with values"
        return
    defaults = {each.name: each.default for each in fields(Settings)}
    for name, value in tree.items():
        if name not in defaults:
            yield f"{_shown(name)}: is unknown; known are {', '.join(defaults)}"
        elif not (rule := RULES[type(defaults[name])])[1](value):
            yield f"{name} = {_shown(value)}: must be {rule[0]}"


def _shown(value: object) -> str:
    """The value, in which a text may be a place; of a list or of a long number its kind alone."""
    plain = isinstance(value, str | bool | float) or (isinstance(value, int) and abs(value) < 1 << 64)
    return redacted(str(value)) if plain else f"a value of the kind {type(value).__name__}"


def _together(settings: Settings) -> Iterator[str]:
    if not settings.far_side:
        yield "far_side is empty: name a remote of rclone's configuration and a folder there, as in factory:robots"
    elif settings.far_side.startswith("-"):
        yield f"far_side = {redacted(settings.far_side)}: begins with -"
    if not ROBOT.fullmatch(settings.name):
        yield f"robot = {printable(settings.name)}: must be of letters, digits and _ . -, at most 64, not .name"
    for each in settings.hours:
        if not HOURS.fullmatch(each):
            yield f"hours: {printable(each)}: must be as in 22:00-06:00"
    if 0 < settings.bandwidth < 0.01:
        yield f"bandwidth = {settings.bandwidth:g}: must be 0 (no limit) or at least 0.01 MB/s"
    if ":" in settings.far_side.partition("/")[0] and settings.far_side[0] != ":":
        path, remedy = given_path(settings.rclone_config), "; make it with rclone config"
        yield from problems_of("rclone_config", path, secret=True, remedy=remedy)
    if settings.ca_file:
        yield from problems_of("ca_file", given_path(settings.ca_file), secret=False)
