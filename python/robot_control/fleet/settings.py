"""The values of config/fleet.yaml."""

from __future__ import annotations

import ipaddress
import math
import re
import stat
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import-untyped]

from robot_control.common.files import given_path
from robot_control.fleet.v2.capability import STANDARD, ActionKind
from robot_control.fleet.v2.messages import VERSIONS

SCOPES = {"INSTANT", "NODE", "EDGE"}


class SettingsError(ValueError):
    """The settings cannot be used; the message names every problem."""


@dataclass(frozen=True)
class CustomAction:
    """An actionType that calls a service, or holds a topic at true."""

    service: str = ""
    topic: str = ""
    seconds: float = 1.0
    timeout: float = 10.0
    scopes: tuple[str, ...] = ("INSTANT", "NODE")


@dataclass(frozen=True)
class Settings:
    """The values; config/fleet.yaml explains them."""

    interface: str = "uagv"
    manufacturer: str = "robot_control"
    serial_number: str = "r1"
    version: str = VERSIONS[0]
    host: str = "127.0.0.1"
    port: int = 1883
    keep_alive: int = 15
    user: str = ""
    password_file: str = ""
    ca_file: str = ""
    certificate_file: str = ""
    key_file: str = ""
    insecure: bool = False
    localization: bool = False
    map: str = ""
    speed: float = 0.5
    node_tolerance: float = 0.05
    heading_tolerance: float = 0.05
    base_reserve: float = 1.0
    unknown_battery_charge: float = 80.0
    visualization_rate: float = 5.0
    memory_file: str = ""
    actions: dict[str, CustomAction] = field(default_factory=dict)

    @property
    def kinds(self) -> dict[str, ActionKind]:
        """All actions of the robot."""
        custom = {name: ActionKind(each.scopes, description=_what(each)) for name, each in self.actions.items()}
        return {**STANDARD, **custom}

    @property
    def topic(self) -> str:
        """The levels with which all topics begin."""
        return f"{self.interface}/v2/{self.manufacturer}/{self.serial_number}"

    @property
    def password(self) -> str | None:
        """The first line of its file. Raises OSError."""
        return Path(self.password_file).read_text(encoding="utf-8").partition("\n")[0] if self.password_file else None


RANGES: dict[str, tuple[float, float]] = {
    "port": (1, 65535),
    "keep_alive": (1, 600),
    "speed": (0.02, 10),
    "node_tolerance": (0.01, 0.3),
    "heading_tolerance": (0.01, 1),
    "base_reserve": (0, 100),
    "unknown_battery_charge": (0, 100),
    "visualization_rate": (0, 20),
}
LEVEL = ("interface", "manufacturer", "serial_number")


def read_settings(*paths: Path) -> Settings:
    """The values of these files, each laid over the one before.

    Raises:
        SettingsError: with all problems.
        OSError: a file cannot be read.
    """
    settings, problems = Settings(), list[str]()
    for path in paths:
        try:
            tree = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
        except (yaml.YAMLError, UnicodeDecodeError, RecursionError) as error:
            raise SettingsError(f"{path}: is no YAML: {error}") from None
        if not isinstance(tree, dict):
            raise SettingsError(f"{path}: must be a map of names and values")
        for name, value in tree.items():
            try:
                settings = replace(settings, **{str(name): _value(str(name), value)})
            except (TypeError, ValueError) as error:
                problems.append(f"{path}: {name} = {value!r}: {error}")
    problems += _together(settings)
    if problems:
        raise SettingsError("; ".join(problems))
    return settings


def _value(name: str, value: Any) -> Any:
    """The value of a key. Raises ValueError with the rule that it breaks."""
    known = {each.name: each for each in fields(Settings)}
    if name not in known:
        raise ValueError(f"is unknown; known are {', '.join(known)}")
    if name == "actions":
        return _actions(value)
    if name in RANGES:
        low, high = RANGES[name]
        number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
        if not number or not low <= value <= high:
            raise ValueError(f"must be a number from {low:g} to {high:g}")
        whole = known[name].type == "int"
        if whole and value != int(value):
            raise ValueError("must be a whole number")
        return int(value) if whole else float(value)
    if name in ("insecure", "localization"):
        if not isinstance(value, bool):
            raise ValueError("must be true or false")
        return value
    if not isinstance(value, str):
        raise ValueError("must be a text")
    if name in LEVEL and not re.fullmatch(r"[A-Za-z0-9_.:-]{1,64}", value):
        raise ValueError("must be 1 to 64 letters, digits and _ . : -")
    if name == "version" and value not in VERSIONS:
        raise ValueError(f"must be {' or '.join(VERSIONS)}")
    return str(given_path(value)) if name.endswith("_file") and value else value


def _actions(tree: Any) -> dict[str, CustomAction]:
    if not isinstance(tree, dict):
        raise ValueError("must be a map of action types")
    result = {}
    for name, each in tree.items():
        if name in STANDARD:
            raise ValueError(f"{name} is an action of the standard")
        if not isinstance(each, dict) or not set(each) <= {item.name for item in fields(CustomAction)}:
            raise ValueError(f"{name} must be a map of service or topic, seconds, timeout, scopes")
        custom = CustomAction(**{**each, "scopes": tuple(each.get("scopes", ("INSTANT", "NODE")))})
        if bool(custom.service) == bool(custom.topic):
            raise ValueError(f"{name} needs either service or topic")
        if not set(custom.scopes) <= SCOPES or not custom.scopes:
            raise ValueError(f"{name}: scopes are {', '.join(sorted(SCOPES))}")
        if not isinstance(custom.service + custom.topic, str):
            raise ValueError(f"{name}: service and topic must be texts")
        if not all(isinstance(n, int | float) and 0 < n <= 3600 for n in (custom.seconds, custom.timeout)):
            raise ValueError(f"{name}: seconds and timeout must be above 0, up to 3600")
        result[str(name)] = custom
    return result


def _together(settings: Settings) -> Iterator[str]:
    """The rules across values."""
    if not (settings.ca_file or settings.insecure or _is_loopback(settings.host)):
        yield f"host = {settings.host}: beyond the loopback it needs ca_file (TLS), or insecure: true"
    if settings.key_file and not settings.certificate_file:
        yield "key_file: needs certificate_file"
    if settings.localization and not settings.map:
        yield "localization = true: needs map, the mapId of its map"
    for name in ("password_file", "ca_file", "certificate_file", "key_file"):
        path = Path(getattr(settings, name))
        if getattr(settings, name):
            yield from _file_problems(name, path, secret=name in ("password_file", "key_file"))


def _file_problems(name: str, path: Path, *, secret: bool) -> Iterator[str]:
    try:
        path.read_bytes()
        if secret and stat.S_IMODE(path.stat().st_mode) & 0o077:
            yield f"{name} = {path}: others can read it; chmod 600 {path}"
    except OSError as error:
        yield f"{name} = {path}: cannot be read: {error.strerror}"


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _what(action: CustomAction) -> str:
    if action.service:
        return f"service {action.service}, at most {action.timeout:g} s"
    return f"topic {action.topic}, true for {action.seconds:g} s"
