"""Runs the benchmark programs and shows what they measured.

Each program `bench_NAME` prints one JSON object:
    {"bench": NAME, "rows": [{"name", "value", "unit", "reference", "reference_name", "ratio"}, …]}

The trials that judge give results of the same form; `JUDGED` lists them. Beside their rows, "not_judged" names the
robots that were left out, and "table" holds lines to be shown above the rows.
"""

from __future__ import annotations

import argparse
import importlib
import json
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from robot_control.files.files import write_text

from bench import legs, markdown, recordings
from bench.devices import walk_bench
from bench.drives.sensor_errors import LEVELS
from bench.drives.wheel_command import WHEEL_COMMANDS
from bench.faults.fault_sequence import ALL_RUNS
from bench.navigation import bench as navigation
from bench.release.sender_sequences import sender_rows
from bench.robot_corpus import DIFFBOT, OWN, QUADBOT
from bench.rows import Result
from bench.runs import seed_programs
from bench.runs.address import check_address
from bench.runs.runner import Processes, Runner

MEASURED = ("step", "plant", "lockstep", "frames", "stops")
# These run only if they are named.
JUDGED = (
    "campaign",
    "replay",
    "driving",
    "limiter",
    "release",
    "drive",
    "slopes",
    "legs",
    "odometry",
    "recordings",
    "hostile",
    "tuning",
    "bags",
    "record",
    "blackbox",
    "processes",
    "devices",
    "board_clock",
    "console",
    "fleet",
    "data_return",
    "realtime",
    "navigation",
    "loops",
)
REALTIME_PARTS = ("jitter", "chain", "cost", "scale", "dds")
PARTS = {
    "devices": ("losses", "answers", "slope", "disturbed"),
    "realtime": REALTIME_PARTS,
    "legs": legs.PARTS,
    "fleet": ("sequences", "orders", "losses", "cost"),
    "navigation": navigation.PARTS,
    "data_return": ("upload", "changes", "cost"),
    "loops": ("speed", "python", "instructions"),
    "recordings": recordings.PARTS,
}
ON_LEGS = {"devices": walk_bench.PARTS, "navigation": ("goals",)}
"""Parts that another robot than diffbot has; of a benchmark that is not here it has all"""
NAMES = MEASURED + JUDGED
SEED_PROGRAMS = {"limiter": 1_000_000, "release": 10_000, "bags": 10_000}  # seeds; a minute at most on two cores
BY_WHEEL_COMMAND = ("campaign", "driving", "drive", "release")
BY_ROBOT = ("campaign", "devices", "navigation", "processes", "record", "release")
ON_CLUSTERS = ("campaign", "devices", "driving", "odometry", "tuning", *SEED_PROGRAMS)


def run_program(program: Path, *arguments: str | Path) -> dict[str, Any]:
    """Runs one benchmark and reads its answer; its messages go to this program's stderr."""
    done = subprocess.run(
        [program, *map(str, arguments)], stdout=subprocess.PIPE, check=True, text=True, stdin=subprocess.DEVNULL
    )
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def programs_of(given: argparse.Namespace) -> Callable[..., dict[str, Any]]:
    """Runs a program of bench/programs by its name."""
    return lambda name, *arguments: run_program(given.programs / name, *map(str, arguments))


def say(text: str) -> None:
    """Prints progress and errors."""
    print(text, file=sys.stderr, flush=True)


@contextmanager
def opened_runner(given: argparse.Namespace) -> Iterator[Runner]:
    """The processes of this machine, or the workers of the cluster that --scheduler names.

    Raises:
        RuntimeError: there is no such cluster, or it must not be used.
    """
    if given.scheduler is None:
        yield Processes()
        return
    from bench.runs.cluster import Cluster

    with Cluster(given.scheduler, insecure=given.insecure, tls=given.tls) as cluster:
        yield cluster


def run_seed_program(name: str, given: argparse.Namespace, runner: Runner) -> Result:
    """One of `SEED_PROGRAMS`: it uses all processors by itself, or runs in blocks on the workers of a cluster."""
    runs = given.runs or SEED_PROGRAMS[name]
    machine = []
    if name in BY_WHEEL_COMMAND:
        machine = [given.wheel_command if given.robot == DIFFBOT else given.robot]
    if given.scheduler is None:
        result = run_program(given.programs / f"bench_{name}", str(given.first), str(runs), *machine)
    else:
        result = seed_programs.run_seeds(name, given.first, runs, say, runner, *machine)
    if name == "release" and given.robot == DIFFBOT:  # the senders know no robot
        result["rows"] += sender_rows(given.first, runs, say, runner)
    return result, all(row["value"] == 0 for row in result["rows"] if row["name"].endswith("sequences failed"))


def _possible_parts(name: str, robot: str) -> tuple[str, ...]:
    return PARTS[name] if robot == DIFFBOT else ON_LEGS.get(name, PARTS[name])


def _all_parts(name: str) -> set[str]:
    return {*PARTS[name], *ON_LEGS.get(name, ())}


def _parts_of(name: str, given: argparse.Namespace) -> list[str]:
    """The parts of this benchmark that are named, or all that the robot has."""
    return [part for part in given.parts if part in _all_parts(name)] or list(_possible_parts(name, given.robot))


def _odometry(bench: Any, given: argparse.Namespace, runner: Runner) -> Result:  # noqa: ANN401 (a module)
    count, which = given.runs or bench.SEEDS, given.only or bench.ALL
    result: Result = bench.bench(
        given.first, count, say, given.errors, plots=given.plots, scenarios=which, runner=runner
    )
    return result


def _devices(bench: Any, given: argparse.Namespace, runner: Runner) -> Result:  # noqa: ANN401 (a module)
    parts = _parts_of("devices", given)
    if given.robot == QUADBOT:
        return walk_bench.bench(
            parts,
            given.first,
            given.runs,
            say,
            runner,
            build=given.programs.parent,
            can_rate=given.rate,
            minutes=given.minutes,
        )
    result: Result = bench.bench(
        parts, given.first, given.runs or bench.ALL_RUNS, say, runner, program=programs_of(given)
    )
    return result


TRIALS: dict[str, tuple[str, Callable[[Any, argparse.Namespace, Runner], Result]]] = {
    "campaign": (
        "faults.campaign",
        lambda m, g, runner: m.bench(g.first, g.runs or ALL_RUNS, say, runner, g.wheel_command, robot=g.robot),
    ),
    "devices": ("devices.bench", _devices),
    "driving": ("drives.normal_driving", lambda m, g, runner: m.bench(g.share, say, runner, g.errors, g.wheel_command)),
    "odometry": ("odometry.bench", _odometry),
    "recordings": ("recordings", lambda m, g, _: m.bench(_parts_of("recordings", g), say, programs_of(g), g.file)),
    "tuning": ("tuning", lambda m, g, runner: m.bench(g.first, g.runs or m.ALL_RUNS, say, runner)),
    "replay": ("faults.replayed", lambda m, g, _: m.bench(g.first, g.runs or m.ALL_RUNS, say)),
    "hostile": ("hostile", lambda m, g, _: m.bench(g.first, g.runs or m.ALL_RUNS, say)),
    "record": ("log_bench", lambda m, g, _: m.bench(g.share, g.programs, g.keep, say, g.robot)),
    "blackbox": ("black_box_bench", lambda m, g, _: m.bench(g.first, g.runs or m.ALL_TRIALS, g.programs, say)),
    "processes": ("process_bench", lambda m, g, _: m.bench(g.first, g.runs or m.ALL_RUNS, g.programs, say, g.robot)),
    "drive": ("drives.drive_promises", lambda m, g, _: m.bench(say, g.wheel_command)),
    "slopes": ("drives.slopes", lambda m, _, __: m.bench(say)),
    "board_clock": ("devices.board_clock", lambda m, g, _: m.bench(programs_of(g), g.share, say)),
    "legs": (
        "legs",
        lambda m, g, _: m.bench(_parts_of("legs", g), g.first, g.runs, programs_of(g), say, rate=g.rate, delay=g.delay),
    ),
    "console": ("console.bench", lambda m, g, _: m.bench(g.share, say)),
    "realtime": (
        "realtime.bench",
        lambda m, g, _: m.bench(_parts_of("realtime", g), g.runs or 0, g.programs, say),
    ),
    "fleet": ("fleet.bench", lambda m, g, _: m.bench(_parts_of("fleet", g), g.first, g.runs, say)),
    "navigation": (
        "navigation.bench",
        lambda m, g, _: m.bench(
            _parts_of("navigation", g),
            g.first,
            g.runs,
            g.programs,
            say,
            m.barn.Fields(g.map, g.speed, g.worlds),
            logs=g.logs,
            robot=g.robot,
        ),
    ),
    "loops": ("loops", lambda m, g, _: m.bench(_parts_of("loops", g), g.programs, g.params, say)),
    "data_return": (
        "data_return.bench",
        lambda m, g, _: m.bench(_parts_of("data_return", g), g.first, g.share, g.programs, say),
    ),
}
"""Modules, which are loaded when they are asked for, and calls of them"""


def run(name: str, given: argparse.Namespace) -> Result:
    """The result of NAME, and whether it meets its bounds."""
    if name in MEASURED:
        return run_program(given.programs / f"bench_{name}", given.params), True
    with opened_runner(given) as runner:
        if name in SEED_PROGRAMS:
            return run_seed_program(name, given, runner)
        module, call = TRIALS[name]
        return call(importlib.import_module(f"bench.{module}"), given, runner)


def to_table(result: dict[str, Any]) -> str:
    """One line per figure: value, unit, reference of the same run, ratio to it; then a line of robots that were not
    judged.
    """
    wide = max([24, *(len(row["name"]) for row in result["rows"])])
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
        raise argparse.ArgumentTypeError(f"{text} is not a number above 0, up to 100")
    return share


def _scenarios(text: str) -> list[str]:
    from bench.odometry.bench import ALL

    unknown = [name for name in text.split(",") if name not in ALL]
    if unknown:
        raise argparse.ArgumentTypeError(f"no scenario {', '.join(unknown)}; there are {', '.join(ALL)}")
    return text.split(",")


def _add_options_of_legs(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--rate",
        type=float,
        choices=legs.RATES,
        default=legs.RATES[0],
        help="legs, devices --robot quadbot with motors on CAN: Hz of the loop",
    )
    parser.add_argument("--delay", type=float, help="legs: s from sensor to torque, whole periods; default: one")
    parser.add_argument(
        "--minutes",
        type=float,
        help="devices --robot quadbot: length of one disturbed walk per drive; default: 30 walks of a minute",
    )


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """The command line of scripts/bench; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(prog="scripts/bench", description="Measures this machine.")
    parts = "".join(f"; after {name} also its parts {', '.join(own)}" for name, own in PARTS.items())
    which = f"of {', '.join(NAMES)} (default: {', '.join(MEASURED)}){parts}"
    parser.add_argument("names", nargs="*", metavar="NAME", help=which)
    seeds = (
        "campaign, devices, replay, limiter, release, bags, odometry, hostile, tuning, blackbox, processes, legs, "
        "fleet, navigation, data_return"
    )
    parser.add_argument("--first", type=_whole(0), default=0, help=f"{seeds}: first seed")
    parser.add_argument("--runs", type=_whole(1), help=f"{seeds}: number of seeds")
    parser.add_argument(
        "--share",
        type=_share,
        default=1.0,
        help="driving: of the two hours; record: of the ten minutes; console: of presses, losses and seconds; "
        "data_return: of the files; board_clock: of the drives",
    )
    parser.add_argument("--errors", choices=LEVELS, default=LEVELS[0], help="driving, odometry: of the sensors")
    parser.add_argument(
        "--wheel-command",
        choices=WHEEL_COMMANDS,
        default=WHEEL_COMMANDS[0],
        help=f"{', '.join(BY_WHEEL_COMMAND)}: of the drives of the wheels",
    )
    parser.add_argument("--robot", choices=OWN, default=DIFFBOT, help=f"{', '.join(BY_ROBOT)}: the robot")
    parser.add_argument("--only", type=_scenarios, metavar="SCENARIO[,…]", help="odometry: these scenarios alone")
    parser.add_argument("--plots", type=Path, help="odometry: folder for pictures")
    parser.add_argument("--logs", type=Path, help="navigation logs: folder of the logs")
    parser.add_argument("--file", type=Path, help="recordings legs: another recording, of the same form")
    parser.add_argument("--worlds", type=Path, help="navigation barn: folder of public worlds, N.json each")
    parser.add_argument("--map", choices=navigation.MAPS, default=navigation.MAPS[0], help="navigation barn: the map")
    parser.add_argument("--speed", type=float, choices=navigation.SPEEDS, default=0.5, help="navigation barn: m/s")
    _add_options_of_legs(parser)
    parser.add_argument("--keep", type=Path, help="record: folder for the logs and their reports")
    cluster = parser.add_argument_group("cluster", f"{', '.join(ON_CLUSTERS)} run with the workers of a Dask scheduler")
    cluster.add_argument("--scheduler", metavar="tls://HOST:8786", help="its address; default: this computer only")
    cluster.add_argument("--tls", type=Path, metavar="FOLDER", help="of ca.pem, cert.pem, key.pem; default: as Dask")
    cluster.add_argument("--insecure", action="store_true", help="allow tcp:// beyond the loopback: plain text")
    parser.add_argument("--json", type=_writable_file, help="file to write all figures to")
    parser.add_argument("--markdown", action="store_true", help="write the tables to docs/evidence")
    parser.add_argument("--programs", type=Path, default=Path(), help=argparse.SUPPRESS)
    parser.add_argument("--params", type=Path, default=Path(), help=argparse.SUPPRESS)
    given = parser.parse_args(arguments)
    possible = {part for name in PARTS if name in given.names for part in _all_parts(name)}
    given.parts = [name for name in given.names if name in possible]
    given.names = [name for name in given.names if name not in possible]
    unknown = [name for name in given.names if name not in NAMES]
    if unknown:
        parser.error(f"no benchmark {', '.join(unknown)}; there are {', '.join(NAMES)}")
    given.names = given.names or list(MEASURED)
    alone = [name for name in given.names if name not in ON_CLUSTERS]
    other = [name for name in given.names if name not in BY_ROBOT]
    known = {part for name in PARTS if name in given.names for part in _possible_parts(name, given.robot)}
    absent = [part for part in given.parts if part not in known]
    writes = "--markdown writes the tables of"
    for wrong, why in (
        (given.scheduler and alone, f"{', '.join(alone)} cannot run on a cluster; {', '.join(ON_CLUSTERS)} can"),
        (given.markdown and given.errors != LEVELS[0], f"{writes} {LEVELS[0]}, not of --errors {given.errors}"),
        (given.markdown and given.wheel_command != WHEEL_COMMANDS[0], f"{writes} --wheel-command {WHEEL_COMMANDS[0]}"),
        (
            given.robot != DIFFBOT and (other or given.markdown),
            f"--robot {given.robot} is for {', '.join(BY_ROBOT)} without --markdown",
        ),
        (given.markdown and (given.rate != legs.RATES[0] or given.delay), f"{writes} the default --rate and --delay"),
        (absent, f"{', '.join(absent)}: no part of --robot {given.robot}, which has {', '.join(sorted(known))}"),
        ("logs" in given.parts and given.logs is None, "navigation logs needs --logs FOLDER"),
        (given.markdown and given.only, f"{writes} all scenarios, not of --only some"),
    ):
        if wrong:
            parser.error(why)
    if given.scheduler is not None:
        try:
            check_address(given.scheduler, insecure=given.insecure)
        except ValueError as error:
            parser.error(str(error))
    return given


def main() -> int:
    """Entry point of scripts/bench."""
    given = parse()
    results, failed = [], 0
    for name in given.names:
        try:
            result, good = run(name, given)
        except (OSError, RuntimeError, subprocess.CalledProcessError, json.JSONDecodeError) as error:
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
