"""Robots that are carried elsewhere in their own map of `room`, which grows on: are they found?"""

from __future__ import annotations

import tempfile

import numpy as np
from robot_control._mrpt import Mapper

from bench.navigation.localizing import FOUND, SCENE, SEARCH, carried
from bench.navigation.tour import LASER, SCAN_PERIOD, TOURS, Sight, drive, new_loop
from bench.rows import Row, Say, bounded

KIDNAPS, MISSED = 20, 2


def follow(mapper: Mapper, sights: list[Sight]) -> list[bool]:
    """Whether the place is known and true, at each scan."""
    known = []
    for sight in sights:
        mapper.update(sight.scan, LASER, sight.odometry, sight.covariance)
        away = float(np.hypot(*(np.array(mapper.pose) - sight.truth)[:2]))
        known.append(mapper.reason == "" and away < FOUND)
    return known


def once(path: str, sights: list[Sight], seed: int) -> tuple[float, bool]:
    """The time [s] from which on the place is known, infinite if it is not at the end; whether it is wrong then."""
    before, after = carried(sights, seed, round(SEARCH / SCAN_PERIOD))
    mapper = Mapper.load(path)
    mapper.set_pose(before[0].truth)
    follow(mapper, before)
    known = follow(mapper, after)
    unknown = [index for index, one in enumerate(known) if not one]
    if not known[-1]:
        return float("inf"), mapper.reason == ""
    return SCAN_PERIOD * (unknown[-1] + 1 if unknown else 0), False


def rows_of(first: int, runs: int, say: Say) -> list[Row]:
    """The map of one tour is saved; each robot goes on with it."""
    sights = list(drive(new_loop(SCENE, first), TOURS[SCENE]))
    mapper = Mapper()
    follow(mapper, sights)
    with tempfile.TemporaryDirectory() as folder:
        mapper.save(f"{folder}/room.yaml")
        results = [once(f"{folder}/room.yaml", sights, seed) for seed in range(first, first + runs)]
    say("carried elsewhere while mapping, found after " + ", ".join(f"{seconds:.1f}" for seconds, _ in results) + " s")
    missed = sum(not np.isfinite(seconds) for seconds, _ in results)
    return [
        bounded(f"carried elsewhere while mapping: not found within {SEARCH:.0f} s", missed, f"of {runs}", MISSED),
        bounded("carried elsewhere while mapping: a wrong place", sum(wrong for _, wrong in results), f"of {runs}", 0),
    ]
