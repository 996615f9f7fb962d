"""The command line of replay.py."""

import argparse
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from robot_control._robot_control import BagError, replay_log
from robot_control.data.replay.recorded_setup import RecordedSetup, recorded_setup
from robot_control.files.files import escaped, escaped_lines, fit_for_message, given_path, in_words, utf8
from robot_control.loop.roles import CONTROLLER, ESTIMATOR, MONITOR
from robot_control.ui.picture_file import check_picture

LAWS = ("gate", "estimator", "controller", "monitor")
VARIED = (f"{ESTIMATOR}.", f"{MONITOR}.")
WITHOUT_EFFECT = "the controller reads it only at its start, or no varied law has it"
MAX_LINES = 20
EXACT, NOT_COMPARED, REFUSED, DIFFERENT = 0, 1, 2, 3


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of scripts/replay.py: 0 exact, 1 rows not compared, 2 no replay, 3 something differs."""
    options = parse(arguments)
    try:
        if options.set or options.params:
            check_picture(options.plot, [options.log, options.params])
        with tempfile.TemporaryDirectory() as folder:
            setup = recorded_setup(options.log, Path(folder))
            varied = setup.varied(options.params, options.set) if options.set or options.params else None
            report = replay_log(utf8(options.log), setup.layers(), varied)
        print(text_of(report, setup, options.law))
        for key in without_effect([key for key, _ in options.set], report["live"]):
            print(escaped(f"! {key} has no effect here: {WITHOUT_EFFECT}"))
        if varied is not None:
            from robot_control.data.replay.picture import draw  # noqa: PLC0415 (matplotlib takes a second)

            draw(report["varied"], report["period"], options.plot)
            print(
                escaped(
                    f"wrote {options.plot}: what the laws gave, and would have given on the same inputs (open loop)"
                )
            )
    except BagError as error:
        print(f"replay.py: {fit_for_message(f'{options.log}: {error}')}", file=sys.stderr)
        sys.exit(REFUSED)
    except (RuntimeError, OSError, ValueError) as error:
        print(f"replay.py: {fit_for_message(in_words(error))}", file=sys.stderr)
        sys.exit(REFUSED)
    sys.exit(verdict(report, options.law))


def parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="replay.py",
        description="Computes the laws of a log again from its rows, and compares the results bit by bit. "
        "Exit code 0: all is the same; 1: nothing differs, but not every row could be compared; 2: the log cannot be "
        "replayed; 3: something differs.",
    )
    parser.add_argument("log", type=given_path, metavar="LOG", help="run.bag")
    parser.add_argument("--law", choices=LAWS, help="of this law only")
    what_if = parser.add_argument_group("what if", "the laws with other parameters beside, on the recorded inputs")
    metavar = "NODE.PARAMETER=VALUE"
    what_if.add_argument("--set", action="append", default=[], type=_assignment, metavar=metavar, help="repeatable")
    what_if.add_argument("--params", type=given_path, metavar="FILE", help="YAML, overrides the parameters of the log")
    meaning = "picture of both; default: %(default)s"
    what_if.add_argument("--plot", type=given_path, default=Path("replay.png"), help=meaning)
    return parser.parse_args(arguments)


def _assignment(text: str) -> tuple[str, str]:
    key, equals, value = text.partition("=")
    if not equals or "." not in key:
        raise argparse.ArgumentTypeError(f"{text} is not NODE.PARAMETER=VALUE")
    return key, value


def chosen(law: str | None) -> list[str]:
    """The laws that are meant."""
    return [name for name in LAWS if law in {None, name}]


def without_effect(keys: Sequence[str], live: Sequence[str]) -> list[str]:
    """The set keys that no law reads; the controller reads the keys `live` from the log."""
    taken = [f"{CONTROLLER}.{key}" for key in live]
    return [key for key in keys if not key.startswith(("robot.", *VARIED)) and not key.startswith(tuple(taken))]


def verdict(report: Mapping[str, Any], law: str | None) -> int:
    """The exit code."""
    if _differences(report, law):
        return DIFFERENT
    if not any(report["laws"][name]["compared"] for name in chosen(law)):
        return REFUSED
    return NOT_COMPARED if _left_out(report, law) else EXACT


def _differences(report: Mapping[str, Any], law: str | None) -> list[str]:
    """The differences in words; empty if there are none."""
    rows = max([report["different_rows"], *(report["laws"][name]["different"] for name in chosen(law))])
    found = [f"{rows} rows DIFFER"] if rows else []
    if report["header"]:
        found.append("its header DIFFERS")
    if report["damaged_snapshots"]:
        found.append(f"{report['damaged_snapshots']} of its snapshots ARE DAMAGED")
    return found


def _left_out(report: Mapping[str, Any], law: str | None) -> list[str]:
    """The parts that were not compared, in words; empty if all were."""
    rows = sum(report["laws"][name]["not_compared"] for name in chosen(law))
    missing = max(report["laws"][name]["missing"] for name in chosen(law))
    found = [f"{rows} rows NOT COMPARED"] if rows else []
    if missing and report["record"] == "always":
        found.append(f"{missing} rows NOT IN THE LOG")
    if report["cut"]:
        found.append("its end NOT COMPARED")
    return found


def text_of(report: Mapping[str, Any], setup: RecordedSetup, law: str | None) -> str:
    """The report; its first line states whether all was compared, and whether it is the same."""
    found = [*_differences(report, law), *_left_out(report, law)]
    lines = [
        f"{setup.path}: {', '.join(found) or 'every row is the same, bit for bit'}",
        f"robot {setup.robot}",
        *(f"! {doubt}" for doubt in report["doubts"]),
    ]
    if report["cut"]:
        lines.append(f"! {report['cut']}")
    lines.append(f"{'law':<24}{'compared':>10}{'different':>11}{'not compared':>14}")
    for name in chosen(law):
        counts = report["laws"][name]
        lines.append(f"{name:<24}{counts['compared']:>10}{counts['different']:>11}{counts['not_compared']:>14}")
    lines.append(f"{'fields of the rows':<24}{report['rows']:>10}{report['different_rows']:>11}{0:>14}")
    lines += _listed("differs", [*report["header"], *_of(report["differences"], law)])
    lines += _listed("not compared", _of(report["gaps"], law))
    if not any(report["laws"][name]["compared"] for name in chosen(law)):
        lines.append("nothing was compared: this log contains no snapshot of a law")
    return escaped_lines(lines)


def _of(sentences: Sequence[str], law: str | None) -> list[str]:
    return [text for text in sentences if text.startswith(("row", *chosen(law)))]


def _listed(what: str, sentences: Sequence[str]) -> list[str]:
    lines = [f"{what}: {text}" for text in sentences[:MAX_LINES]]
    more = len(sentences) - MAX_LINES
    return [*lines, f"{what}: {more} more"] if more > 0 else lines
