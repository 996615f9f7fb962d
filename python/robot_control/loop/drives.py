"""The drives of src/drivers/drive_table.def."""

import re
from dataclasses import dataclass
from pathlib import Path

import yaml  # type: ignore[import-untyped]

from robot_control.installed_files import share_file


@dataclass(frozen=True)
class DriveRow:
    """One drive: its name, the word of robot.driver, and what it takes: `any`, the one robot.wheel_command, or
    `impedance`.
    """

    name: str
    driver: str
    command: str

    @property
    def moves_legs(self) -> bool:
        """True if it moves legs, false if it moves wheels."""
        return self.command == "impedance"

    @property
    def wheel_commands(self) -> tuple[str, ...]:
        """The values of robot.wheel_command that it takes; none of a drive of legs."""
        return {"any": ("torque", "velocity"), "impedance": ()}.get(self.command, (self.command,))


_TABLE = Path(share_file("src/drivers/drive_table.def")).read_text(encoding="utf-8")
DRIVES = {row[0]: DriveRow(*row) for row in re.findall(r"^DRIVE\((\w+), (\w+), (\w+)\)", _TABLE, re.MULTILINE)}
"""by name"""


def drive_of(file: Path) -> DriveRow:
    """The drive that a drive file is for: that of `bus.dialect`, or of its block.

    Raises:
        OSError: it cannot be read.
        ValueError: it is no YAML, or names no drive.
    """
    try:
        blocks = yaml.safe_load(file.read_text(encoding="utf-8"))
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise ValueError(f"{file} is not YAML: {' '.join(str(error).split())}") from None
    blocks = blocks if isinstance(blocks, dict) else {}
    bus = blocks.get("bus")
    named = [bus.get("dialect")] if isinstance(bus, dict) else list(blocks)
    found = next((DRIVES[name] for name in named if isinstance(name, str) and name in DRIVES), None)
    if found is None:
        raise ValueError(f"{file} has neither a bus.dialect nor a block of a drive")
    return found
