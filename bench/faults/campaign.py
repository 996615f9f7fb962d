"""Thousands of random fault sequences over random drives and robots, each judged by the truth.

    scripts/bench campaign --first 17 --runs 1     # repeats one and says what happened
    scripts/bench campaign --robot quadbot         # the same on legs: random gaits, walks and grounds

A seed gives the same bits on the same build and robots, alone or among others, on however many processors.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from robot_control.loop.closed_loop import ClosedLoop
from robot_control.loop.signal_names import causes_in

from bench.faults.fault_sequence import ANGULAR_LIMIT, LINEAR_LIMIT, FaultSequence, draw_sequence, draw_walk
from bench.faults.sequence_judge import RULES, judge
from bench.faults.sequence_run import make_loop, run_sequence
from bench.robot_corpus import DIFFBOT, QUADBOT, robot_names
from bench.rows import Result, Say, plain
from bench.runs.runner import Processes, Runner


@dataclass(frozen=True)
class Outcome:
    """Result of one seed. `violations`: (rule, description)."""

    seed: int
    story: str
    violations: list[tuple[str, str]]
    stops: list[str]  # causes that ever latched
    seconds: float  # of simulated time
    wheel_command: str = "torque"
    robot: str = DIFFBOT

    @property
    def text(self) -> str:
        """A report of the sequence, its violations, and the command that repeats it."""
        lines = [f"seed {self.seed}: {self.story}"]
        lines += [f"    {what}" for _, what in self.violations]
        if self.violations:
            again = f"--first {self.seed} --runs 1 --wheel-command {self.wheel_command} --robot {self.robot}"
            lines.append(f"    again: scripts/bench campaign {again}")
        return "\n".join(lines)


@dataclass
class Tally:
    """Sums over a campaign."""

    runs: int = 0
    simulated: float = 0.0  # s
    violations: Counter[str] = field(default_factory=Counter)
    stops: Counter[str] = field(default_factory=Counter)
    failed: list[Outcome] = field(default_factory=list)

    def add(self, outcome: Outcome) -> None:
        """Adds one outcome."""
        self.runs += 1
        self.simulated += outcome.seconds
        self.violations.update(rule for rule, _ in outcome.violations)
        self.stops.update(outcome.stops)
        if outcome.violations:
            self.failed.append(outcome)


def fastest_rim(loop: ClosedLoop) -> float:
    """m/s, largest speed over the ground that the controller may request of a side of the robot."""
    return LINEAR_LIMIT + ANGULAR_LIMIT * wheel_base(loop) / 2


def wheel_base(loop: ClosedLoop) -> float:
    """m; 0 on legs."""
    return float(loop.robot.get("wheel_base", 0.0))


def drawn(seed: int, robots: Sequence[str], wheel_command: str, robot: str) -> FaultSequence:
    """The sequence of this seed."""
    return draw_walk(seed) if robot == QUADBOT else draw_sequence(seed, robots, wheel_command)


def run_seed(seed: int, robots: Sequence[str], wheel_command: str = "torque", robot: str = DIFFBOT) -> Outcome:
    """Draws, runs and judges one sequence."""
    sequence = drawn(seed, robots, wheel_command, robot)
    loop = make_loop(sequence)
    log = run_sequence(sequence, loop)
    found = judge(sequence, log, wheel_base(loop), loop.period, fastest_rim(loop))
    violations = [(violation.rule, str(violation)) for violation in found]
    stops, seconds = causes_in(log["permit_causes"]), len(log["cycle"]) * loop.period
    return Outcome(seed, sequence.describe(), violations, stops, seconds, wheel_command, robot)


def campaign(
    seeds: Sequence[int],
    say: Say,
    runner: Runner | None = None,
    wheel_command: str = "torque",
    *,
    robot: str = DIFFBOT,
) -> Tally:
    """Runs all seeds; `say` receives every failure, and the progress."""
    tally = Tally()
    runner = runner or Processes()
    one = partial(run_seed, robots=robot_names(), wheel_command=wheel_command, robot=robot)
    for outcome in runner.outcomes(one, seeds, say, chunk=4):
        tally.add(outcome)
        if outcome.violations:
            say(outcome.text)
    return tally


def result_of(tally: Tally, seconds: float) -> dict[str, Any]:
    """As the benchmark programs print it; `seconds` of wall-clock time."""
    rows = [plain("sequences", tally.runs, ""), plain("sequences failed", len(tally.failed), "")]
    rows += [plain(f"{rule} violated", tally.violations[rule], "") for rule in RULES]
    rows.append(plain("simulated", tally.simulated / 3600, "h"))
    rows.append(plain("speed", tally.simulated / seconds, "simulated s per s"))
    return {
        "bench": "campaign",
        "rows": rows,
        "stops": dict(tally.stops.most_common()),
        "failed": [outcome.text for outcome in tally.failed],
    }


def bench(
    first: int,
    runs: int,
    say: Say,
    runner: Runner | None = None,
    wheel_command: str = "torque",
    *,
    robot: str = DIFFBOT,
) -> Result:
    """The result, and whether the robot survived every sequence."""
    began = time.monotonic()
    if runs == 1:
        say(drawn(first, robot_names(), wheel_command, robot).describe())
    tally = campaign(range(first, first + runs), say, runner, wheel_command, robot=robot)
    return result_of(tally, time.monotonic() - began), not tally.failed
