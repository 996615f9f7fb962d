"""Runs the benchmark programs and shows what they measured.

Each program `bench_NAME` prints one JSON object:
    {"bench": NAME, "rows": [{"name", "value", "unit", "reference", "reference_name", "ratio"}, …]}

The trials that judge give results of the same form: faults/campaign.py, drives/normal_driving.py,
drives/drive_promises.py, odometry/bench.py, hostile.py, tuning.py, bench_limiter, bench_release. There, "not_judged"
beside the rows names the robots left out, and "table" holds lines to be shown above the rows.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from robot_control.common.files import write_text

from lab import markdown
from lab.faults.fault_sequence import ALL_RUNS

MEASURED = ("step", "plant", "lockstep", "frames", "stops")
# Only when they are named.
JUDGED = ("campaign", "driving", "limiter", "release", "drive", "odometry", "hostile", "tuning")
NAMES = MEASURED + JUDGED
SEED_PROGRAMS = {"limiter": 1_000_000, "release": 10_000}  # sequences; a minute each on two cores


def run_program(program: Path, *arguments: str | Path) -> dict[str, Any]:
    """Runs one benchmark and reads its answer; its messages go to this program's stderr."""
    done = subprocess.run(
        [program, *map(str, arguments)], stdout=subprocess.PIPE, check=True, text=True, stdin=subprocess.DEVNULL
    )
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def tell(text: str) -> None:
    """Progress, and what went wrong."""
    print(text, file=sys.stderr, flush=True)


def run_seeds(name: str, given: argparse.Namespace) -> tuple[dict[str, Any], bool]:
    """Those that need nothing but their seeds."""
    if name == "campaign":
        from lab.faults import campaign

        return campaign.bench(given.first, given.runs or ALL_RUNS, tell)
    from lab import hostile

    return hostile.bench(given.first, given.runs or hostile.ALL_RUNS, tell)


def run(name: str, given: argparse.Namespace) -> tuple[dict[str, Any], bool]:
    """What NAME measured, and whether that is as it has to be."""
    if name in {"campaign", "hostile"}:
        return run_seeds(name, given)
    if name == "driving":
        from lab.drives import normal_driving as driving

        return driving.bench(given.share, tell)
    if name in SEED_PROGRAMS:
        result = run_program(given.programs / f"bench_{name}", str(given.first), str(given.runs or SEED_PROGRAMS[name]))
        return result, all(row["value"] == 0 for row in result["rows"] if row["name"] == "sequences failed")
    if name == "drive":
        from lab.drives import drive_promises

        return drive_promises.bench(tell)
    if name in {"odometry", "tuning"}:
        return _run_over_robots(name, given)
    return run_program(given.programs / f"bench_{name}", given.params), True


def _run_over_robots(name: str, given: argparse.Namespace) -> tuple[dict[str, Any], bool]:
    if name == "odometry":
        from lab.odometry import bench as odometry_bench

        return odometry_bench.bench(given.first, given.runs or odometry_bench.SEEDS, tell, plots=given.plots)
    from lab import tuning

    return tuning.bench(given.first, given.runs or tuning.ALL_RUNS, tell)


def to_table(result: dict[str, Any]) -> str:
    """One line per figure: value, unit, reference of the same run, ratio to it; and one of robots not judged."""
    wide = max(24, *(len(row["name"]) for row in result["rows"]))
    lines = [*result["table"], ""] if result.get("table") else []
    lines += [f"{result['bench']:<{wide + 2}}{'value':>12}  {'unit':<22}{'reference':>12}{'ratio':>10}"]
    for row in result["rows"]:
        compared = row["reference"] != 0
        reference = f"{row['reference']:12.4g}{row['ratio']:10.3f}  of {row['reference_name']}" if compared else ""
        lines.append(f"  {row['name']:<{wide}}{row['value']:12.4g}  {row['unit']:<22}{reference}".rstrip())
    if result.get("not_judged"):
        absent = ", ".join(result["not_judged"])
        lines.append(f"  not judged: {absent}; no descriptions here, ROBOT_CORPUS names the folder of real robots")
    return "\n".join(lines)


def _writable_file(text: str) -> Path:
    path = Path(text)
    try:
        path.open("a").close()
    except OSError as error:
        raise argparse.ArgumentTypeError(f"{text} cannot be written to: {error.strerror}") from None
    return path


def _whole(least: int) -> Callable[[str], int]:
    def convert(text: str) -> int:
        if not text.isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError(f"{text} is no whole number ≥ {least}")
        return int(text)

    return convert


def _share(text: str) -> float:
    try:
        share = float(text)
    except ValueError:
        share = 0.0
    if not 0 < share <= 100:
        raise argparse.ArgumentTypeError(f"{text} is no number above 0, up to 100")
    return share


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """The command line of scripts/bench; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(prog="scripts/bench", description="Measures this machine.")
    which = f"of {', '.join(NAMES)} (default: {', '.join(MEASURED)})"
    parser.add_argument("names", nargs="*", metavar="NAME", help=which)
    seeds = "campaign, limiter, release, odometry, hostile, tuning"
    parser.add_argument("--first", type=_whole(0), default=0, help=f"{seeds}: first seed")
    parser.add_argument("--runs", type=_whole(1), help=f"{seeds}: number of seeds")
    parser.add_argument("--share", type=_share, default=1.0, help="driving: of the two hours")
    parser.add_argument("--plots", type=Path, help="odometry: folder for pictures")
    parser.add_argument("--json", type=_writable_file, help="file to write all figures to")
    parser.add_argument("--markdown", action="store_true", help="write the tables of docs/measurements.md")
    parser.add_argument("--programs", type=Path, default=Path(), help=argparse.SUPPRESS)
    parser.add_argument("--params", type=Path, default=Path(), help=argparse.SUPPRESS)
    given = parser.parse_args(arguments)
    unknown = [name for name in given.names if name not in NAMES]
    if unknown:
        parser.error(f"no benchmark {', '.join(unknown)}; there are {', '.join(NAMES)}")
    given.names = given.names or list(MEASURED)
    return given


def main() -> int:
    """Entry point of scripts/bench."""
    given = parse()
    results, failed = [], 0
    for name in given.names:
        try:
            result, good = run(name, given)
        except (OSError, subprocess.CalledProcessError, json.JSONDecodeError) as error:
            print(f"scripts/bench: {name}: {error}", file=sys.stderr)
            failed += 1
            continue
        results.append(result)
        failed += not good
        print(f"\n{to_table(result)}", flush=True)
    if given.json is not None:
        write_text(given.json, json.dumps(results, indent=2) + "\n")
    if given.markdown:
        markdown.write(results)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
