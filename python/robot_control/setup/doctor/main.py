"""doctor.py: examines this machine and terminal; runs also where ROS is not sourced."""

import argparse
import contextlib
import importlib
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from robot_control.installed_files import share_file
from robot_control.setup.doctor.finding import Check, Finding, unseen
from robot_control.setup.doctor.report import Row, as_json, commands, exit_code, lines
from robot_control.setup.doctor.system import DEFAULTS, HiddenError, System
from robot_control.setup.doctor.tasks import first_sample

FILES = ("kernel", "memory", "processor", "load", "interrupts", "clocks", "drivers", "terminal", "graph", "disk")
"""of this folder, in the order of the report"""
GROUPS: dict[str, Sequence[Check]] = {
    name: importlib.import_module(f"robot_control.setup.doctor.{name}").CHECKS for name in FILES
}


UNREADABLE = (ValueError, IndexError, KeyError, TypeError, AttributeError, OSError)
"""Raised where a foreign file is read, or one that has just vanished."""


def _finding(check: Check, system: System) -> Finding:
    """The finding of one check; what cannot be read costs this check alone."""
    try:
        return check.examine(system)
    except HiddenError as error:
        return unseen(str(error))
    except UNREADABLE as error:
        return unseen(f"cannot be read: {type(error).__name__}: {error}")


def examine(system: System) -> list[Row]:
    """All findings; the load is measured over the time of the other checks."""
    with contextlib.suppress(*UNREADABLE):
        first_sample(system)
    order = sorted(GROUPS, key=lambda name: name == "load")
    rows = [Row(name, each.name, each.why, _finding(each, system)) for name in order for each in GROUPS[name]]
    return sorted(rows, key=lambda row: FILES.index(row.group))


def _robot_block(given: str | None) -> dict[str, Any]:
    """The block `robot:` of the installed parameters with that of the given file over it."""
    try:
        import yaml  # type: ignore[import-untyped]
    except ImportError:  # another Python; a check says so
        return dict(DEFAULTS)
    block = dict(DEFAULTS)
    for name in (share_file("config/robot_params.yaml"), *([given] if given else [])):
        try:
            tree = yaml.safe_load(Path(name).read_text())
        except (OSError, ValueError, RecursionError, yaml.YAMLError) as error:
            sys.exit(f"doctor.py: {name} cannot be read: {error}")
        part = tree.get("robot") if isinstance(tree, dict) else None
        block |= part if isinstance(part, dict) else {}
        if isinstance(part, dict) and isinstance(drives := part.get("drives"), str) and drives:
            # The driver refuses a file that cannot be read.
            with contextlib.suppress(OSError, ValueError, RecursionError, yaml.YAMLError, AttributeError):
                block["drive_file"] = yaml.safe_load((Path(name).parent / drives).read_text())
    return block


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """The command line without ROS's own arguments."""
    parser = argparse.ArgumentParser(
        prog="doctor.py",
        description="Examines this machine and terminal: one line per check with verdict, value, [why it matters] and "
        "remedy. Verdicts: ok; note: works, could be better; unseen: not visible here; WARNING; FAULT.",
        epilog="Exit code: 2 with a fault, 1 with a warning, else 0. It needs no privilege and changes nothing.",
    )
    parser.add_argument("--json", action="store_true", help="the findings as JSON")
    parser.add_argument("--fix", action="store_true", help="print the commands of the remedies, and run none")
    parser.add_argument("--params", metavar="FILE", help="your parameters: robot.core, realtime, driver … are read")
    meaning = "also N pairs of the nodes beside cyclictest, idle and under load (stress-ng): about N × 30 s"
    parser.add_argument("--measure", metavar="N", type=int, help=meaning)
    parser.add_argument("--root", metavar="DIR", default="/", help="read /proc, /sys, /etc and /dev from this folder")
    return parser.parse_args([each for each in arguments if ":=" not in each])


def _measured(system: System, pairs: int) -> list[Row]:
    try:
        from robot_control.setup.doctor.measure import MeasureError, measure
    except ImportError as error:
        sys.exit(f"doctor.py: --measure needs ROS and the compiled part: source install/setup.bash ({error})")
    if not system.live or pairs < 1:
        sys.exit("doctor.py: --measure N is for this machine, with N of at least 1")
    try:
        return measure(system, pairs)
    except MeasureError as error:
        sys.exit(f"doctor.py: {error}")


def main() -> int:
    """Entry point of scripts/doctor.py."""
    given = parse(sys.argv[1:])
    if not Path(given.root).is_dir():
        sys.exit(f"doctor.py: --root {given.root} is not a folder")
    system = System(Path(given.root).absolute(), _robot_block(given.params))
    rows = examine(system) + ([] if given.measure is None else _measured(system, given.measure))
    print(as_json(rows) if given.json else "\n".join(commands(rows) if given.fix else lines(rows)))
    return exit_code(rows)
