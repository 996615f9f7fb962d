"""The values of config/data_return.yaml."""

import re
import socket
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from robot_control.data.black_box import LOGS
from robot_control.files.files import given_path, printable, problems_of
from robot_control.settings.files import number, redacted, rules_of, settings_of, wrong_values

RCLONE_CONFIG = "~/.config/rclone/rclone.conf"
"""rclone's own place for it"""
HOURS = re.compile(r"([01]\d|2[0-3]):([0-5]\d)-([01]\d|2[0-3]):([0-5]\d)")
ROBOT = re.compile(r"(?!\.)[A-Za-z0-9_.-]{1,64}")


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


QUOTA = number(0, 1e9)
RULES = rules_of(Settings, bandwidth=QUOTA, local_quota=QUOTA, far_quota=QUOTA)


def read_settings(*paths: Path) -> Settings:
    """The values of these files, each laid over the one before.

    Raises:
        SettingsError: with all problems.
        OSError: a file cannot be read.
    """

    def made(values: dict[str, Any]) -> Settings:
        lists = {name: tuple(value) for name, value in values.items() if isinstance(value, list)}
        return Settings(**values | lists)

    return settings_of(paths, partial(wrong_values, rules=RULES), made, _together)


def _together(settings: Settings) -> Iterator[str]:
    if not settings.far_side:
        yield "far_side is empty: set a remote of rclone's configuration and a folder there, as in factory:robots"
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
        path, remedy = given_path(settings.rclone_config), "; create it with rclone config"
        yield from problems_of("rclone_config", path, secret=True, remedy=remedy)
    if settings.ca_file:
        yield from problems_of("ca_file", given_path(settings.ca_file), secret=False)
