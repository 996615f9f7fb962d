"""The values of config/fleet.yaml."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from robot_control.data.black_box import LOGS
from robot_control.files.files import given_path, printable, problems_of
from robot_control.fleet.v2.capability import STANDARD, ActionKind
from robot_control.fleet.v2.messages import VERSIONS
from robot_control.settings.addresses import is_loopback
from robot_control.settings.files import list_of, matching, number, rules_of, settings_of, wrong_values


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
    blocked_timeout: float = 60.0
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

    @property
    def memory(self) -> Path:
        """`memory_file`, or that of this robot among the logs."""
        name = f"{self.manufacturer}-{self.serial_number}.json"
        return Path(self.memory_file) if self.memory_file else given_path(str(LOGS / "fleet" / name))


LEVEL = matching("[A-Za-z0-9_.:-]{1,64}", "a text of letters, digits and _ . : -, at most 64")
NAME = matching(r"[^\s\0]+", "a text without blanks")
RULES = rules_of(
    Settings,
    **dict.fromkeys(("interface", "manufacturer", "serial_number"), LEVEL),
    version=matching("|".join(VERSIONS), " or ".join(VERSIONS)),
    host=NAME,
    port=number(1, 65535, int),
    keep_alive=number(5, 600, int),
    speed=number(0.02, 10),
    node_tolerance=number(0.01, 0.3),
    heading_tolerance=number(0.01, 1),
    base_reserve=number(0, 100),
    blocked_timeout=number(1, 3600),
    unknown_battery_charge=number(0, 100),
    visualization_rate=number(0, 20),
    actions=("a map of names and actions", lambda value: isinstance(value, dict)),
)
ACTION_RULES = rules_of(
    CustomAction,
    **dict.fromkeys(("service", "topic"), NAME),
    **dict.fromkeys(("seconds", "timeout"), number(0.001, 3600)),
    scopes=list_of(matching("INSTANT|NODE|EDGE", "INSTANT, NODE or EDGE")),
)


def read_settings(*paths: Path) -> Settings:
    """The values of these files, each laid over the one before.

    Raises:
        SettingsError: with all problems.
        OSError: a file cannot be read.
    """
    return settings_of(paths, _wrong_values, _made, _together)


def _made(values: dict[str, Any]) -> Settings:
    custom = {
        str(name): CustomAction(**{**each, "scopes": tuple(each.get("scopes", CustomAction.scopes))})
        for name, each in values.pop("actions", {}).items()
    }
    names = (name for name, value in values.items() if name.endswith("_file") and value)
    return Settings(**(values | {name: str(given_path(values[name])) for name in names}), actions=custom)


def _wrong_values(tree: Any) -> Iterator[str]:
    yield from wrong_values(tree, RULES)
    actions = tree.get("actions") if isinstance(tree, dict) else None
    for name, action in actions.items() if isinstance(actions, dict) else ():
        yield from wrong_values(action, ACTION_RULES, f"actions.{printable(str(name))}.")
        if isinstance(action, dict) and ("service" in action) == ("topic" in action):
            yield f"actions.{printable(str(name))}: must have either service or topic"


def _together(settings: Settings) -> Iterator[str]:
    """The rules across values."""
    for name in settings.actions.keys() & STANDARD.keys():
        yield f"actions.{name}: is an action of the standard"
    if not (settings.ca_file or settings.insecure or is_loopback(settings.host)):
        yield f"host = {settings.host}: beyond the loopback it needs ca_file (TLS), or insecure: true"
    if settings.key_file and not settings.certificate_file:
        yield "key_file: needs certificate_file"
    if settings.localization and not settings.map:
        yield "localization = true: needs map, the mapId of its map"
    for name in ("password_file", "ca_file", "certificate_file", "key_file"):
        path = Path(getattr(settings, name))
        if getattr(settings, name):
            yield from problems_of(name, path, secret=name in ("password_file", "key_file"))


def _what(action: CustomAction) -> str:
    if action.service:
        return f"service {action.service}, at most {action.timeout:g} s"
    return f"topic {action.topic}, true for {action.seconds:g} s"
