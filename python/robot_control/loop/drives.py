"""The drives of src/drivers/drive_table.def."""

import re
from dataclasses import dataclass
from pathlib import Path

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
    def wheel_commands(self) -> tuple[str, ...]:
        """The values of robot.wheel_command that it takes; none of a drive of legs."""
        return {"any": ("torque", "velocity"), "impedance": ()}.get(self.command, (self.command,))


_TABLE = Path(share_file("src/drivers/drive_table.def")).read_text(encoding="utf-8")
DRIVES = {row[0]: DriveRow(*row) for row in re.findall(r"^DRIVE\((\w+), (\w+), (\w+)\)", _TABLE, re.MULTILINE)}
"""by name"""
