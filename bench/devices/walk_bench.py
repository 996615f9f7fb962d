"""The table of `scripts/bench devices --robot quadbot`, by drive.

It has losses at each phase of a stride, and long walks on a disturbed bus or line. On the wall clock, the bridge of a
Go2 ends or hangs.

scripts/bench devices losses --robot quadbot --first 7 --runs 1
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from bench.devices import walk_bridge
from bench.devices.disturbed_walk import DisturbedWalk, WalkFigures, run_walk, together
from bench.devices.walk_loss import CAN_RATE, LEANS, LOSS, LOSSES, PHASES, WalkLoss, WalkOutcome, run_loss
from bench.rows import Result, Row, Say, bounded, judged, plain
from bench.runs.runner import Runner

PARTS = ("losses", "disturbed", "bridge")
WALKS = 30  # of each drive, half an hour
WALK_TIME = 60.0  # s
BRIDGE_PHASES = 5
"""Every fourth one of a stride: on the wall clock a trial lasts 7 s."""
STATES = ("ok", "disturbed")
ODOMETRY = 1.5  # times the error of an undisturbed walk


def bench(
    parts: Sequence[str],
    first: int,
    runs: int | None,
    say: Say,
    runner: Runner,
    *,
    build: Path,
    can_rate: float = CAN_RATE,
    minutes: float | None = None,
) -> Result:
    """The table, and whether every figure keeps its bound.

    Args:
        parts: what is measured, of `PARTS`.
        first: the first phase and seed.
        runs: phases of each loss, and the share of `WALKS` in `PHASES`. None: all.
        say: receives progress and every broken rule.
        runner: where the trials run.
        build: folder of the build.
        can_rate: Hz of the loop with motors on CAN.
        minutes: the disturbed walk of each drive is one of this length. None: `WALKS` of `WALK_TIME`.
    """
    phases = runs or PHASES
    rows: list[Row] = []
    if "losses" in parts:
        rows += loss_rows(first, phases, say, runner, can_rate)
    if "disturbed" in parts:
        count, seconds = (max(1, WALKS * phases // PHASES), WALK_TIME) if minutes is None else (1, 60 * minutes)
        rows += walk_rows(range(first, first + count), seconds, say, runner, can_rate)
    if "bridge" in parts:
        rows += bridge_rows(first, runs or BRIDGE_PHASES, say, build)
    return judged("devices", rows)


def loss_rows(first: int, phases: int, say: Say, runner: Runner, can_rate: float) -> list[Row]:
    """Per drive and kind of loss: those that broke a rule, and the latest name; per drive the greatest tilt."""
    kinds = [(drive, kind) for drive, losses in LOSSES.items() for kind in losses]
    trials = [WalkLoss(*of, seed, can_rate) for of in kinds for seed in range(first, first + phases)]
    outcomes: dict[tuple[str, str], list[WalkOutcome]] = {of: [] for of in kinds}
    for trial, outcome in zip(trials, runner.outcomes(run_loss, trials, say, chunk=5), strict=True):
        outcomes[trial.drive, trial.kind].append(outcome)
        for rule in outcome.broken:
            say(f"{trial}: {rule}")
    rows = []
    for drive, losses in LOSSES.items():
        for kind, loss in losses.items():
            found = outcomes[drive, kind]
            name = f"{drive}, {kind}:"
            rows.append(bounded(f"{name} losses that broke a rule", sum(bool(each.broken) for each in found), "", 0))
            rows.append(
                bounded(f"{name} until it is named", 1e3 * max(e.named for e in found), "ms", 1e3 * loss.latest)
            )
        tilt = max(each.tilt for kind in losses for each in outcomes[drive, kind])
        rows.append(bounded(f"{drive}: greatest tilt", tilt, "rad", LEANS))
    return rows


def bridge_rows(first: int, phases: int, say: Say, build: Path) -> list[Row]:
    """Per kind of loss: those that broke a rule, the latest name, and the greatest tilt. One trial runs at a time."""
    rows: list[Row] = []
    if not walk_bridge.bridge_of(build).exists():
        say("bridge: skipped, unitree_bridge was not built: scripts/setup --unitree, then build")
        return rows
    for kind in walk_bridge.KINDS:
        found = []
        for seed in range(first, first + phases):
            trial = walk_bridge.BridgeLoss(kind, seed * PHASES // phases)
            found.append(walk_bridge.run_bridge_loss(build, trial))
            for rule in found[-1].broken:
                say(f"{trial}: {rule}")
        rows += [
            bounded(f"{kind}: losses that broke a rule", sum(bool(each.broken) for each in found), "", 0),
            bounded(f"{kind}: until it is named", 1e3 * max(each.named for each in found), "ms", 1e3 * LOSS),
            bounded(f"{kind}: greatest tilt", max(each.tilt for each in found), "rad", LEANS),
        ]
    return rows


def walk_rows(seeds: range, seconds: float, say: Say, runner: Runner, can_rate: float) -> list[Row]:
    """Per drive: walks that a stop latched, gaps beyond the hold, and the error of the odometry."""
    walks = [
        DisturbedWalk(drive, state, seconds, seed, can_rate) for drive in LOSSES for state in STATES for seed in seeds
    ]
    figures: dict[tuple[str, str], list[WalkFigures]] = {}
    for walk, found in zip(walks, runner.outcomes(run_walk, walks, say), strict=True):
        figures.setdefault((walk.drive, walk.state), []).append(found)
        if found.causes:
            say(f"{walk}: {', '.join(found.causes)} within {found.walked:.0f} s")
    rows = []
    for drive in LOSSES:
        undisturbed, disturbed = (together(figures[drive, state]) for state in STATES)
        name = f"{drive}, disturbed:"
        ratio = disturbed.odometry / undisturbed.odometry
        rows += [
            bounded(f"{drive}: stops that latched", len(undisturbed.causes + disturbed.causes), "", 0),
            plain(f"{name} walked", disturbed.walked, "s"),
            plain(f"{name} gaps beyond the hold", disturbed.gaps, ""),
            plain(f"{name} longest gap", 1e3 * disturbed.longest, "ms"),
            bounded(f"{name} error of the odometry, of the undisturbed", ratio, "", ODOMETRY),
        ]
    return rows
