"""Localisation in the map of one tour of `room`: drives of 100 m, kidnapped robots and global starts."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from robot_control._mrpt import Localizer

from bench.navigation.mapping import build_map, text_of
from bench.navigation.moved import partly_moved
from bench.navigation.scene_map import Map
from bench.navigation.tour import LASER, SCAN_PERIOD, TOURS, Sight, drive, errors, new_loop
from bench.rows import Row, Say, bounded

Followed = tuple[str, tuple[float, float, float], NDArray[np.float64]]
"""state, pose (x m, y m, yaw rad) and covariance"""
SCENE = "room"
WAY = 100.0  # m
DRIVES = 10
WITHIN = 7.815  # of the squared distance in three dimensions: 95 %
STARTS, SEARCH = 20, 30.0  # global starts; s of driving
KIDNAPS, NOTICED = 20, 5.0  # s
FAR = 1.5  # m, by which a robot is kidnapped at least
FOUND = 0.3  # m
VARIANTS: dict[str, dict[str, Any]] = {
    "as mapped": {},
    "wheels that slip": {"ground_friction": 0.05},
    "20 % moved": {},
}


def composed(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """The pose b, given in a, in the frame of a."""
    c, s = np.cos(a[2]), np.sin(a[2])
    return np.array([a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]])


def inverse(a: NDArray[np.float64]) -> NDArray[np.float64]:
    """The pose of a's parent in a."""
    c, s = np.cos(a[2]), np.sin(a[2])
    return np.array([-c * a[0] - s * a[1], s * a[0] - c * a[1], -a[2]])


def record(variant: str, seed: int, folder: Path) -> list[Sight]:
    """One drive of `WAY`; every second one goes round the tour the other way."""
    corners = TOURS[SCENE] if seed % 2 == 0 else TOURS[SCENE][::-1]
    scene = partly_moved(SCENE, TOURS[SCENE], 0.2, seed, folder) if variant == "20 % moved" else SCENE
    return list(drive(new_loop(scene, seed, VARIANTS[variant]), corners * 3, WAY))


def follow(localizer: Localizer, sights: list[Sight]) -> list[Followed]:
    """State, pose and covariance at each scan."""
    result = []
    for sight in sights:
        localizer.update(sight.scan, LASER, sight.odometry, sight.covariance)
        result.append((localizer.state, *localizer.pose))
    return result


def judge_drive(grid: Map, sights: list[Sight], seed: int) -> dict[str, float]:
    """Errors, and how true the ellipse is."""
    localizer = Localizer(grid, seed)
    localizer.set_pose(sights[0].truth, np.diag([0.01, 0.01, 0.003]))
    states, poses, covariances = zip(*follow(localizer, sights), strict=True)
    off = errors(sights, np.array(poses))
    squared = np.array([e @ np.linalg.solve(c, e) for e, c in zip(off, covariances, strict=True)])
    return {
        "position": float(np.sqrt(np.mean(off[:, 0] ** 2 + off[:, 1] ** 2))),
        "heading": float(np.degrees(np.sqrt(np.mean(off[:, 2] ** 2)))),
        "outside": float(np.mean(squared > WITHIN)),
        "nees": float(np.mean(squared)),
        "lost": float(np.mean([state != "localized" for state in states])),
    }


def carried(sights: list[Sight], seed: int, count: int) -> tuple[list[Sight], list[Sight]]:
    """100 scans before a robot was carried elsewhere, and `count` scans after it; its odometry has not noticed."""
    numbers = np.random.default_rng(seed)
    while True:
        before, after = (int(number) for number in numbers.integers(100, len(sights) - count, 2))
        if np.hypot(*(sights[before].truth - sights[after].truth)[:2]) > FAR:
            break
    way = composed(sights[before].odometry, inverse(sights[after].odometry))
    turned = np.eye(3)
    turned[:2, :2] = [[np.cos(way[2]), -np.sin(way[2])], [np.sin(way[2]), np.cos(way[2])]]
    moved = []
    for sight in sights[after : after + count]:
        pose = composed(way, sight.odometry)
        grown = sight.covariance - carried_on(sights[after].covariance, sight.odometry - sights[after].odometry)
        known = carried_on(sights[before].covariance, pose - sights[before].odometry)
        moved.append(replace(sight, odometry=pose, covariance=known + turned @ grown @ turned.T))
    return sights[before - 100 : before], moved


def carried_on(covariance: NDArray[np.float64], step: NDArray[np.float64]) -> NDArray[np.float64]:
    """The covariance (3, 3) of a pose after a step (3) in fixed axes that has no errors of its own."""
    by_pose = np.array([[1, 0, -step[1]], [0, 1, step[0]], [0, 0, 1]])
    return np.asarray(by_pose @ covariance @ by_pose.T)


def kidnapped(grid: Map, sights: list[Sight], seed: int) -> float:
    """The time [s] after which a robot that was carried elsewhere is called lost."""
    count = round(2 * NOTICED / SCAN_PERIOD)
    before, after = carried(sights, seed, count)
    localizer = Localizer(grid, seed)
    localizer.set_pose(before[0].truth, np.diag([0.01, 0.01, 0.003]))
    follow(localizer, before)
    states = [state for state, _, _ in follow(localizer, after)]
    return SCAN_PERIOD * (states.index("lost") if "lost" in states else count)


def global_start(grid: Map, sights: list[Sight], seed: int) -> tuple[bool, bool]:
    """Whether the place is found while the robot drives, and whether a wrong one is assumed."""
    count = round(SEARCH / SCAN_PERIOD)
    begin = int(np.random.default_rng(seed).integers(len(sights) - count))
    localizer = Localizer(grid, seed)
    localizer.search()
    part = sights[begin : begin + count]
    state, pose, _ = follow(localizer, part)[-1]
    away = float(np.hypot(*(np.array(pose) - part[-1].truth)[:2]))
    return state == "localized" and away < FOUND, state == "localized" and away >= FOUND


def rows_of(first: int, runs: int, say: Say) -> list[Row]:
    """Every figure of the drives is that of the worst one."""
    grid, _, _ = build_map(list(drive(new_loop(SCENE, first), TOURS[SCENE])))
    rows, drives = [], []
    with tempfile.TemporaryDirectory() as folder:
        for variant in VARIANTS:
            results = []
            for seed in range(first + 1, first + 1 + runs):
                sights = record(variant, seed, Path(folder))
                results.append(judge_drive(grid, sights, seed))
                say(f"{variant}, seed {seed}: {text_of(results[-1])}")
                drives += [sights] if variant == "as mapped" else []
            worst = {key: max(result[key] for result in results) for key in results[0]}
            rows += [
                bounded(f"{variant}: position, RMS", worst["position"], "m", 0.05),
                bounded(f"{variant}: heading, RMS", worst["heading"], "degrees", 2.0),
                bounded(f"{variant}: outside its 95 % ellipse", worst["outside"], "of the time", 0.2),
                bounded(f"{variant}: NEES", worst["nees"], "mean", 6.0),
                bounded(f"{variant}: not localized", worst["lost"], "of the time", 0.0),
            ]
    times = [kidnapped(grid, drives[seed % len(drives)], seed) for seed in range(KIDNAPS)]
    say("kidnapped, noticed after " + ", ".join(f"{seconds:.1f}" for seconds in times) + " s")
    starts = [global_start(grid, drives[seed % len(drives)], seed) for seed in range(STARTS)]
    rows.append(bounded("kidnapped: noticed after", max(times), "s", NOTICED))
    rows.append(bounded("global start: not found", sum(not found for found, _ in starts), f"of {STARTS}", 2))
    rows.append(bounded("global start: a wrong place", sum(wrong for _, wrong in starts), f"of {STARTS}", 0))
    return rows
