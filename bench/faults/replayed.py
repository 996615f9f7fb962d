"""Sequences of the fault campaign are computed again from their logs: every output of every law, bit by bit.

scripts/bench replay --first 17 --runs 1
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from robot_control._robot_control import LoopReplay
from robot_control.loop.closed_loop import ClosedLoop, Log

from bench.faults.fault_sequence import ALL_RUNS as CAMPAIGN_RUNS
from bench.faults.fault_sequence import draw_sequence
from bench.faults.sequence_run import loop_arguments, run_sequence
from bench.robot_corpus import robot_names
from bench.rows import Result, Say, plain

ALL_RUNS = 200
STEP = CAMPAIGN_RUNS // ALL_RUNS  # from one seed to the next, so that the sequences cover the whole campaign


class ReplayedLoop(ClosedLoop):
    """A loop whose steps are computed again as soon as they are made."""

    def __init__(self, *arguments: Any, **named: Any) -> None:  # noqa: ANN401 (those of ClosedLoop)
        super().__init__(*arguments, **named)
        self._replay = LoopReplay(self._loop)
        self.seconds = 0.0  # s of processor time, of the replay alone

    def step(self, cycles: int = 1, columns: Sequence[str] | None = None) -> Log:
        """Steps as the loop does, then replays the cycles."""
        log: Log = self._loop.run(cycles, None, self._chosen(columns), self._replay)
        began = time.process_time()
        self._replay.check()
        self.seconds += time.process_time() - began
        return log

    def report(self) -> dict[str, Any]:
        """The report of the replay."""
        return dict(self._replay.report())


@dataclass
class Tally:
    """Sums over all sequences."""

    runs: int = 0
    rows: int = 0  # compared rows of all laws
    simulated: float = 0.0  # s
    seconds: float = 0.0  # s of processor time, of the replays
    failed: list[str] = field(default_factory=list)  # descriptions of rows that differ or were not compared


def replay_seed(seed: int, robots: Sequence[str], tally: Tally) -> None:
    """Runs one sequence and its replay."""
    sequence = draw_sequence(seed, robots)
    loop = ReplayedLoop(**loop_arguments(sequence))
    log = run_sequence(sequence, loop)
    report = loop.report()
    tally.runs += 1
    tally.rows += sum(law["compared"] for law in report["laws"].values())
    tally.simulated += len(log["cycle"]) * loop.period
    tally.seconds += loop.seconds
    if not report["exact"] or report["gaps"]:
        found = [*report["differences"][:5], *report["gaps"][:5]]
        tally.failed.append("\n    ".join([f"seed {seed}: {sequence.describe()}", *found]))


def replay_seeds(seeds: Sequence[int], say: Say) -> Tally:
    """Runs all seeds; `say` receives every failure."""
    tally = Tally()
    robots = robot_names()
    for seed in seeds:
        known = len(tally.failed)
        replay_seed(seed, robots, tally)
        for text in tally.failed[known:]:
            say(text)
    return tally


def bench(first: int, runs: int, say: Say) -> Result:
    """The result, and whether every row of every sequence was computed again, bit by bit."""
    tally = replay_seeds(range(first, first + runs * STEP, STEP), say)

    rows = [
        plain("sequences", tally.runs, ""),
        plain("sequences not exact", len(tally.failed), ""),
        plain("rows compared", tally.rows, ""),
        plain("simulated", tally.simulated, "s"),
        plain("speed of the replay", tally.simulated / tally.seconds, "s per s of processor time"),
    ]
    return {"bench": "replay", "rows": rows, "failed": tally.failed}, not tally.failed
