"""Every name that a user of robot_control types, into a program, a parameter file or a command line.

    /usr/bin/python3 tests/behaviour/public_names.py > tests/behaviour/public_names.json

renews the list after `source install/setup.bash`. A name of the list stays. If a name is wrong, a better one is added,
and the old one goes on working with a warning.
"""

from __future__ import annotations

import inspect
import json
import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import robot_control
import yaml  # type: ignore[import-untyped]

ROOT = Path(__file__).parents[2]
ALIASES = (
    "robot.left_wheel_joint",
    "robot.right_wheel_joint",
    "robot.wheel_separation",
    "robot.wheel_separation_multiplier",
)
"""Keys that appear in the parameter file in comments only."""

Names = dict[str, list[str]]


def _sources(folder: str) -> str:
    return "\n".join(path.read_text() for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".h", ".cpp"))


def topics() -> Iterator[str]:
    """Name and type; `~`: below the node's name."""
    bridge = _sources("src/ros")
    for owner, message, name in re.findall(r'(\w+)\.advertise<(?:\w+::)?(\w+)>\("([^"]+)"', bridge):
        yield f"{'~' if owner == 'own' else ''}{name} {message}"
    for message, name in re.findall(r'InputTopic<Bounded(\w+)> \w+\{"([^"]+)"', bridge):
        yield f"{name} {message}"


def services() -> Iterator[str]:
    """`~`: below the node's name."""
    for owner, name in re.findall(r'(\w+)\.advertiseService\("([^"]+)"', _sources("src/ros")):
        yield f"{'~' if owner == 'own' else ''}{name}"


def parameters() -> Iterator[str]:
    """Keys of the parameter file, those in its comments included."""
    text = (ROOT / "config/robot_params.yaml").read_text()
    yield from sorted({*_keys(yaml.safe_load(text)), *_keys(yaml.safe_load(_offered(text))), *ALIASES})


def _offered(text: str) -> str:
    """The file with its commented-out keys in force: `  # key: value`, or `  # key:` with `  #   key: value` below."""
    lines, inside = [], False
    for line in text.splitlines():
        key = re.match(r"  # ([a-z_]+:)(?:\s*#|( \S))", line)
        inside = bool(key and not key[2]) or (inside and re.match(r"  #   [a-z_]+: ", line) is not None)
        lines.append("  " + line[4:] if key or inside else line)
    return "\n".join(lines)


def _keys(tree: dict[str, Any], prefix: str = "") -> Iterator[str]:
    for name, value in tree.items():
        if isinstance(value, dict):
            yield from _keys(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}"


def launch_arguments() -> Iterator[str]:
    """The arguments that a user may give, with their defaults if these are plain."""
    for path in sorted(ROOT.glob("launch/*.launch")):
        for argument in ET.parse(path).getroot().findall("arg"):
            if "value" not in argument.attrib:
                default = argument.get("default", "")
                yield f"{path.stem}: {argument.get('name')}:={'…' if '$(' in default else default}"


def programs() -> Iterator[str]:
    """The files in scripts/, and the nodes."""
    for path in ROOT.glob("scripts/**/*"):
        if path.is_file() and path.stat().st_mode & 0o111:
            yield f"scripts/{path.name}"
    for path in ROOT.glob("src/main/*.cpp"):
        yield f"node {path.stem}"


def python() -> Iterator[str]:
    """The importable names, with signatures."""
    for name in sorted(robot_control.__all__):
        thing = getattr(robot_control, name)
        yield name if issubclass(thing, Exception) else f"{name}{inspect.signature(thing)}"
        for member, value in sorted(vars(thing).items()):
            if member.startswith("_") or issubclass(thing, Exception):
                continue
            yield f"{name}.{member}{inspect.signature(value) if inspect.isfunction(value) else ''}"


def public_names() -> Names:
    """All public names, by kind."""
    return {
        "topics": sorted(set(topics())),
        "services": sorted(set(services())),
        "parameters": list(parameters()),
        "launch arguments": list(launch_arguments()),
        "programs": sorted(programs()),
        "python": list(python()),
    }


if __name__ == "__main__":
    json.dump(public_names(), sys.stdout, indent=1, ensure_ascii=False)
    print()
