"""The command line of blackbox.py."""

from __future__ import annotations

import argparse
import os
import re
import sys
from pathlib import Path

from robot_control._robot_control import RunLogError, TraceError, save_black_box
from robot_control.common.files import escaped, escaped_lines, fit_for_message, given_path, in_words, utf8

RING = "ring"
BEFORE = "ring.before"
LOGS = Path(os.environ.get("ROS_HOME") or "~/.ros", "robot_control")
"""The folder into which sim.launch and backend.launch let telemetry write."""
INCIDENT = re.compile(r"(stop|crash)\.\d+\.bag")

EPILOG = """
The node telemetry writes every cycle into black_box/ring in its folder (telemetry.directory). It saves by itself what
that holds 5 s after a latched stop, as black_box/stop.N.bag, and, when it is started after it was killed, as
black_box/crash.N.bag: any tool takes these. After an orderly end the file is black_box/ring.before from the next start
on. Only the build that wrote a ring reads it.
"""


def main(arguments: list[str] | None = None) -> None:
    """Entry point of scripts/blackbox.py: 0 with OUT/run.bag whole, else 1 with one message and without that file."""
    options = _parser().parse_args(arguments)
    given = options.input
    bag = options.out / "run.bag"
    try:
        ring = ring_of(given)
        if bag.exists():
            raise FileExistsError(f"{bag} exists; name another folder: --out OUT")
        rows, _, missing = save_black_box(utf8(ring), utf8(bag))
    except (RunLogError, TraceError, OSError, ValueError, RuntimeError) as error:
        sys.exit(f"blackbox.py: {fit_for_message(in_words(error))}{_beside(given)}")
    print(escaped_lines(f"{rows} cycles of {ring} in {bag}{_beside(given)}".split("\n")))
    if missing:
        print(escaped(f"blackbox.py: {missing}"), file=sys.stderr)


def ring_of(path: Path) -> Path:
    """The newest black box of a folder of logs, or `path` itself where it is a file.

    Raises:
        FileNotFoundError: there is none.
    """
    if not path.is_dir():
        return path
    for name in (RING, BEFORE):
        if (_box_of(path) / name).is_file():
            return _box_of(path) / name
    raise FileNotFoundError(f"there is no black box in {path}: no black_box/{RING}")


def incidents_of(path: Path) -> list[Path]:
    """The black boxes that telemetry has saved in a folder, the newest last; none if the folder cannot be read."""
    try:
        box = _box_of(path) if path.is_dir() else path.parent
        found = [each for each in box.iterdir() if INCIDENT.fullmatch(each.name)] if box.is_dir() else []
        return sorted(found, key=lambda each: (each.stat().st_mtime, each.name))
    except OSError:
        return []


def _box_of(folder: Path) -> Path:
    return folder / "black_box" if (folder / "black_box").is_dir() else folder


def _beside(given: Path) -> str:
    return "".join(f"\nsaved before: {incident}" for incident in incidents_of(given))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="blackbox.py",
        description="Turns the black box of a robot, the last minute before a crash, into a run.bag.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "input",
        nargs="?",
        type=given_path,
        default=str(LOGS),
        help="folder of the logs (default: %(default)s), or a file black_box/ring",
    )
    parser.add_argument(
        "--out",
        type=given_path,
        default=Path("blackbox"),
        metavar="OUT",
        help="folder for run.bag (default: %(default)s)",
    )
    return parser
