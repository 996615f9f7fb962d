"""The joints of a drive file: reads their signs and zeros, and writes them without touching its comments."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import yaml  # type: ignore[import-untyped]

EVERY = "every_joint"
OF_ROBOT = re.compile(r"^# zero_joints\.py: offsets of (.*)\n", re.MULTILINE)


class DriveFileError(ValueError):
    """The drive file cannot be used; the message says why, and what to do."""


@dataclass(frozen=True)
class FileJoint:
    """The statements of the file about one joint."""

    direction: int = 1
    offset: float = 0.0
    """rad"""
    start_angle: float | None = None
    """rad"""
    turn: float | None = None
    """rad of the joint per turn of the rotor, where the file states the gear of the motor"""


def read_joints(text: str, names: list[str]) -> list[FileJoint]:
    """The joints of these names.

    Raises:
        DriveFileError: it is no drive file of these joints.
    """
    tree = _tree(text)
    missing = [name for name in names if not isinstance(tree.get(name), dict)]
    if missing:
        raise DriveFileError(f"it has no block {', '.join(missing)}: name the drive file of this robot")
    return [_joint({**(tree.get(EVERY) or {}), **tree[name]}) for name in names]


def robot_of(text: str) -> str:
    """The robot whose offsets the file holds; "" if it names none."""
    found = OF_ROBOT.search(text)
    return found[1].rsplit(", ", 1)[0] if found else ""


def with_values(text: str, values: Mapping[str, Mapping[str, float]], robot: str = "", date: str = "") -> str:
    """The text with these values of each joint, and with the name of the robot.

    Raises:
        DriveFileError: a block is not written with one key per line.
    """
    lines = text.splitlines(keepends=True)
    for name, keys in values.items():
        for key, value in keys.items():
            _set(lines, name, key, f"{value:g}" if float(value).is_integer() else f"{value:.4f}")
    result = OF_ROBOT.sub("", "".join(lines))
    if robot:
        result = f"# zero_joints.py: offsets of {robot}, {date}\n{result}"
    expected, found = _tree(text), _tree(result)
    for name, keys in values.items():
        expected[name] = {**expected[name], **{key: round(value, 4) for key, value in keys.items()}}
    if expected != found:
        raise DriveFileError("the values could not be written; write one key per line, below the name of the joint")
    return result


def _tree(text: str) -> dict[str, Any]:
    try:
        tree = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise DriveFileError(f"this is not YAML: {error}") from None
    if not isinstance(tree, dict):
        raise DriveFileError("it holds no blocks")
    return tree


def _joint(block: dict[str, Any]) -> FileJoint:
    numbers = {key: value for key, value in block.items() if isinstance(value, int | float)}
    gear = numbers.get("motor_gear")
    return FileJoint(
        direction=-1 if numbers.get("direction", 1) < 0 else 1,
        offset=float(numbers.get("offset", 0.0)),
        start_angle=numbers.get("start_angle"),
        turn=None if gear is None else 2 * math.pi / (gear * numbers.get("gear", 1)),
    )


def _set(lines: list[str], name: str, key: str, value: str) -> None:
    """Sets a key of a block: in its line, in the comment that holds its default, or in a new line."""
    begin = next((at for at, line in enumerate(lines) if re.match(rf"{re.escape(name)}:\s*(#.*)?$", line)), None)
    if begin is None:
        raise DriveFileError(f"{name}: its keys must be written one per line, below its name")
    end = next((at for at in range(begin + 1, len(lines)) if re.match(r"[^\s#]", lines[at])), len(lines))
    places = [(at, re.match(rf"(\s+)(# )?{key}:\s*\S+(\s*)(.*)", lines[at])) for at in range(begin + 1, end)]
    found = sorted(((match[2] is not None, at, match) for at, match in places if match), key=lambda each: each[:2])
    if not found:
        lines.insert(begin + 1, f"  {key}: {value}\n")
        return
    _, at, match = found[0]
    start = f"{match[1]}{key}: {value}"
    comment = f" {match[4]}" if match[4] else ""
    lines[at] = f"{start.ljust(match.start(4) - 1 if comment else 0)}{comment}\n"
