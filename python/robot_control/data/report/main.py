"""report.py: one page and a verdict of a log, or of two."""

import argparse
import math
import sys
from pathlib import Path

from robot_control.data.report.budgets import Judged, Verdict, failed, judge, read_budgets
from robot_control.data.report.drive import Drive, drive_of
from robot_control.data.report.figures import figures
from robot_control.data.report.incidents import incidents
from robot_control.data.run_log import read_run
from robot_control.files.files import escaped, escaped_lines, fit_for_message, given_path, one_message, write_text
from robot_control.files.output_files import check_outputs
from robot_control.installed_files import share_file
from robot_control.ui.pypi import use_packages

BUDGETS = "config/report_budgets.yaml"


@one_message("report.py", ValueError, OSError)
def main(arguments: list[str] | None = None) -> None:
    """Writes the page, prints the verdict; exits with 1 and one message when something is refused."""
    options = _parser().parse_args(arguments)
    judged = report(options)
    for path, verdicts in zip(options.compare or [options.log], judged, strict=True):
        if options.ci and not any(one.verdict in (Verdict.OK, Verdict.FAILED) for one in verdicts):
            reason = "none of the figures with a budget is in this log; name others: --budgets FILE"
            sys.exit(f"report.py: {fit_for_message(str(path))}: nothing was judged: {reason}")
    wrong = [one for verdicts in judged for one in failed(verdicts)]
    if options.ci and wrong:
        sys.exit(f"report.py: {len(wrong)} figures break their budget: {', '.join(one.figure.name for one in wrong)}")


def report(options: argparse.Namespace) -> list[list[Judged]]:
    """Writes and prints; returns the verdicts of each log.

    Raises:
        ValueError, OSError: one message.
    """
    paths = options.compare or [options.log]
    out = None if options.ci and options.out is None else options.out or paths[0].with_suffix(".html")
    check_outputs([out], [*paths, options.budgets])
    drives = [drive_of(path, read_run(path)) for path in paths]
    found = [figures(drive) for drive in drives]
    budgets = read_budgets(options.budgets or Path(share_file(BUDGETS)), found[0])
    judged = [judge(verdicts, budgets) for verdicts in found]
    for drive, verdicts in zip(drives, judged, strict=True):
        if drive.part:
            print(escaped(f"report.py: {drive.name}: {drive.part}"), file=sys.stderr)
        print(escaped_lines(_table(drive, verdicts)))
    if out is not None:
        _write(out, drives, judged)
        print(escaped(f"wrote {out}"), file=sys.stderr)
    return judged


def _table(drive: Drive, judged: list[Judged]) -> list[str]:
    lines = [drive.name]
    for one in judged:
        if one.verdict is not Verdict.UNJUDGED:
            figure = one.figure
            bounds = " ".join(f"{sign} {figure.shown(bound)}" for sign, bound in one.bounds)
            lines.append(f"  {figure.name:<28}{figure.shown(figure.value):>16}{bounds:>16}   {one.verdict.value}")
    return lines


def _write(out: Path, drives: list[Drive], judged: list[list[Judged]]) -> None:
    for drive in drives:
        if math.isnan(drive.period):
            raise ValueError(f"{drive.name}: there are no two cycles with a time, and nothing to draw")
    use_packages("report")
    try:
        from robot_control.data.report.page import page
    except ImportError as error:
        raise ValueError(f"the page needs Bokeh ({error}): scripts/setup --report; --ci alone needs no page") from None
    write_text(out, page(drives, judged, [incidents(drive) for drive in drives]))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="report.py", description=__doc__)
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("log", nargs="?", type=given_path, help="run.bag, or another bag of trace")
    which.add_argument("--compare", nargs=2, type=given_path, metavar=("A", "B"), help="two logs beside each other")
    parser.add_argument("--out", type=given_path, help="the page; default: the log's name with .html")
    parser.add_argument("--budgets", type=given_path, help=f"default: {BUDGETS} of this package")
    parser.add_argument("--ci", action="store_true", help="exit code 1 if a budget is broken; a page only with --out")
    return parser
