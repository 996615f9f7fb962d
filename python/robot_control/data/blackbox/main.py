"""The command line of blackbox.py."""

import argparse
import sys
from pathlib import Path

from robot_control._robot_control import save_black_box
from robot_control.data.black_box import LOGS, incidents_of, ring_of
from robot_control.files.files import escaped, escaped_lines, fit_for_message, given_path, in_words, utf8

EPILOG = """
The node telemetry writes every cycle into the folder black_box/ring in its own (telemetry.directory). It saves by
itself what that holds 5 s after a latched stop, as black_box/stop.N.bag, and, when it is started after it was killed,
as black_box/crash.N.bag: any tool takes these. After an orderly end the ring is black_box/ring.before from the next
start on. Only the version that wrote a ring reads it.
"""


def main(arguments: list[str] | None = None) -> None:
    """Entry point of scripts/blackbox.py: 0 with OUT/run.bag whole, else 1 with one message and without that file."""
    options = _parser().parse_args(arguments)
    given = options.input
    bag = options.out / "run.bag"
    try:
        ring = ring_of(given)
        if bag.exists():
            raise FileExistsError(f"{bag} exists; set another folder: --out OUT")
        rows, _, missing = save_black_box(utf8(ring), utf8(bag))
    except (OSError, ValueError, RuntimeError) as error:
        sys.exit(f"blackbox.py: {fit_for_message(in_words(error))}{_beside(given)}")
    print(escaped_lines(f"{rows} cycles of {ring} in {bag}{_beside(given)}".split("\n")))
    if missing:
        print(escaped(f"blackbox.py: {missing}"), file=sys.stderr)


def _beside(given: Path) -> str:
    return "".join(f"\nsaved before: {incident}" for incident in incidents_of(given))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="blackbox.py",
        description="Turns the black box of a robot, the last minute before a crash, into a run.bag.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    meaning = "folder of the logs (default: %(default)s), or a folder black_box/ring"
    parser.add_argument("input", nargs="?", type=given_path, default=str(LOGS), help=meaning)
    meaning = "folder for run.bag (default: %(default)s)"
    parser.add_argument("--out", type=given_path, default=Path("blackbox"), metavar="OUT", help=meaning)
    return parser
