"""The command line of scripts/demo, judged before anything is built: nothing that is built is imported here."""

import argparse
import tempfile
from collections.abc import Collection, Sequence
from pathlib import Path

from robot_control.installed_files import share_file
from robot_control.loop.drives import DRIVES, DriveRow, drive_of

LEGS = {"diffbot": False, "quadbot": True}
"""included robot → whether it has legs"""
RATES = (20, 2000)
"""Hz, as of robot.rate"""


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """The arguments of scripts/demo as `seconds`, `out`, `robot` (name or file) …; `drives` is a file, and `drive` its
    row of DRIVES. Ends the program on a wrong one.
    """
    parser = argparse.ArgumentParser(prog="scripts/demo", description="Drives the simulated robot and judges the run.")
    parser.add_argument("--seconds", type=_seconds, default=10.0, help="of driving (default %(default)g)")
    parser.add_argument("--out", type=_folder, default="demo_out", help="folder (default ./demo_out)")
    meaning = "diffbot (on wheels), quadbot (on legs), or a URDF or xacro file (default %(default)s)"
    parser.add_argument("--robot", type=_robot, default="diffbot", help=meaning)
    meaning = f"simulated drives of the motors: {', '.join(DRIVES)}, or a drive file"
    parser.add_argument("--drives", type=_drives, help=meaning)
    parser.add_argument("--rate", type=_rate, default=1000, help="of the loop in Hz (default %(default)d)")
    meaning = "what the drives take (default torque, or the only one of --drives)"
    parser.add_argument("--wheel-command", choices=("torque", "velocity"), help=meaning)
    meaning = (
        "lockstep: exact on any machine; wall: in real time, which other programs may disturb (default %(default)s)"
    )
    parser.add_argument("--clock", choices=("lockstep", "wall"), default="lockstep", help=meaning)
    given = parser.parse_args(arguments)
    given.drives, given.drive = given.drives or (None, None)
    of_legs = given.drive is not None and given.drive.moves_legs
    legged = LEGS.get(given.robot, of_legs)
    if given.drive is not None and of_legs != legged:
        fitting = ", ".join(name for name, row in DRIVES.items() if row.moves_legs == legged)
        parser.error(f"--drives {given.drive.name} do not move {given.robot}: take one of {fitting}")
    if given.wheel_command and legged:
        parser.error(f"--wheel-command needs wheels, but {given.robot} has legs: remove one of the two")
    commands = given.drive.wheel_commands if given.drive is not None and not legged else ("torque", "velocity")
    given.wheel_command = given.wheel_command or commands[0]
    if given.wheel_command not in commands:
        parser.error(f"the board of --drives {given.drive.name} takes {commands[0]} only: remove --wheel-command")
    return given


def _robot(text: str) -> str:
    return text if text in LEGS else str(_file(text, LEGS))


def _drives(text: str) -> tuple[Path, DriveRow]:
    path = Path(share_file(f"config/drives/{text}.yaml")) if text in DRIVES else _file(text, DRIVES)
    try:
        return path, drive_of(path)
    except (OSError, ValueError) as error:
        raise argparse.ArgumentTypeError(f"{text} is none of {', '.join(DRIVES)} nor a drive file: {error}") from None


def _file(text: str, names: Collection[str]) -> Path:
    """The absolute path of a file that is none of these names. roslaunch would replace "$(…)" in it."""
    try:
        path = Path(text).resolve()
        found = path.is_file() and "$(" not in text
    except (OSError, RuntimeError) as error:  # RuntimeError: links in a circle
        raise argparse.ArgumentTypeError(f"{text} cannot be read: {error}") from None
    if not found:
        raise argparse.ArgumentTypeError(f"{text} is none of {', '.join(names)} nor a file without $( in its name")
    return path


def _rate(text: str) -> int:
    if not (text.isdecimal() and RATES[0] <= int(text) <= RATES[1]):
        raise argparse.ArgumentTypeError(f"{text} is not a whole number of {RATES[0]} … {RATES[1]} Hz")
    return int(text)


def _seconds(text: str) -> float:
    value = float(text)
    if not 2 <= value <= 3600:
        raise argparse.ArgumentTypeError(f"{text} is not 2 … 3600 s: ramp, settling and a steady part must fit")
    return value


def _folder(text: str) -> Path:
    """Makes it and writes in it: a permission bit alone does not show whether that succeeds (read-only, /proc)."""
    folder = Path(text).resolve()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise argparse.ArgumentTypeError(f"{folder} cannot be written to: {error.strerror}") from None
    return folder
