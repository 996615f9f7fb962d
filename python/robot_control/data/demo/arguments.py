"""The command line of scripts/demo, judged before anything is built: nothing that is built is imported here."""

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

from robot_control.loop.drives import DRIVES

LEGGED_ROBOT = "quadbot"


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """The arguments of scripts/demo as `seconds`, `out`, `robot` …; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(prog="scripts/demo", description="Drives the simulated robot and judges the run.")
    parser.add_argument("--seconds", type=_seconds, default=10.0, help="of driving (default %(default)g)")
    parser.add_argument("--out", type=_folder, default="demo_out", help="folder (default ./demo_out)")
    meaning = "on wheels or on legs (default %(default)s)"
    parser.add_argument("--robot", choices=("diffbot", LEGGED_ROBOT), default="diffbot", help=meaning)
    parser.add_argument("--drives", choices=tuple(DRIVES), help="simulated drives of the motors")
    meaning = "what the drives take (default torque, or the only one of --drives)"
    parser.add_argument("--wheel-command", choices=("torque", "velocity"), help=meaning)
    meaning = (
        "lockstep: exact on any machine; wall: in real time, which other programs may disturb (default %(default)s)"
    )
    parser.add_argument("--clock", choices=("lockstep", "wall"), default="lockstep", help=meaning)
    given = parser.parse_args(arguments)
    legged = given.robot == LEGGED_ROBOT
    if given.drives and (DRIVES[given.drives].command == "impedance") != legged:
        fitting = ", ".join(name for name, row in DRIVES.items() if (row.command == "impedance") == legged)
        parser.error(f"--drives {given.drives} do not move {given.robot}: take one of {fitting}")
    if given.wheel_command and legged:
        parser.error(f"--wheel-command needs wheels, but {LEGGED_ROBOT} has legs: remove one of the two")
    commands = DRIVES[given.drives].wheel_commands if given.drives and not legged else ("torque", "velocity")
    given.wheel_command = given.wheel_command or commands[0]
    if given.wheel_command not in commands:
        parser.error(f"the board of --drives {given.drives} takes {commands[0]} only: remove --wheel-command")
    return given


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
