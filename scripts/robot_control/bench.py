"""Runs the benchmark programs and shows what they measured.

Each program `bench_NAME` prints one JSON object:
    {"bench": NAME, "rows": [{"name", "value", "unit", "reference", "reference_name", "ratio"}, …]}
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

NAMES = ("step", "plant", "lockstep", "frames", "stops")


def run_program(program: Path, params: Path) -> dict[str, Any]:
    """Runs one benchmark and reads its answer; its messages go to this program's stderr."""
    done = subprocess.run([program, params], stdout=subprocess.PIPE, check=True, text=True, stdin=subprocess.DEVNULL)
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def to_table(result: dict[str, Any]) -> str:
    """One line per figure: value, unit, reference of the same run, ratio to it."""
    lines = [f"{result['bench']:<26}{'value':>12}  {'unit':<22}{'reference':>12}{'ratio':>10}"]
    for row in result["rows"]:
        compared = row["reference"] != 0
        reference = f"{row['reference']:12.4g}{row['ratio']:10.3f}  of {row['reference_name']}" if compared else ""
        lines.append(f"  {row['name']:<24}{row['value']:12.4g}  {row['unit']:<22}{reference}".rstrip())
    return "\n".join(lines)


def _writable_file(text: str) -> Path:
    path = Path(text)
    try:
        path.open("a").close()
    except OSError as error:
        raise argparse.ArgumentTypeError(f"{text} cannot be written to: {error.strerror}") from None
    return path


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """The command line of scripts/bench; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(prog="scripts/bench", description="Measures this machine.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(NAMES)} (default: all)")
    parser.add_argument("--json", type=_writable_file, help="file to write all figures to")
    parser.add_argument("--programs", type=Path, default=Path(), help=argparse.SUPPRESS)
    parser.add_argument("--params", type=Path, default=Path(), help=argparse.SUPPRESS)
    given = parser.parse_args(arguments)
    unknown = [name for name in given.names if name not in NAMES]
    if unknown:
        parser.error(f"no benchmark {', '.join(unknown)}; there are {', '.join(NAMES)}")
    given.names = given.names or list(NAMES)
    return given


def main() -> int:
    """Entry point of scripts/bench."""
    given = parse()
    results, failed = [], 0
    for name in given.names:
        try:
            result = run_program(given.programs / f"bench_{name}", given.params)
        except (OSError, subprocess.CalledProcessError, json.JSONDecodeError) as error:
            print(f"scripts/bench: {name}: {error}", file=sys.stderr)
            failed += 1
            continue
        results.append(result)
        print(f"\n{to_table(result)}", flush=True)
    if given.json is not None:
        given.json.write_text(json.dumps(results, indent=2) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
