"""The maps of `room` and `loop` after one tour each, with the default errors of the sensors."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from robot_control._mrpt import Mapper
from robot_control.installed_files import share_file

from bench.navigation.moved import distances
from bench.navigation.scene_map import Map, read_scene
from bench.navigation.tour import LASER, SCAN_PERIOD, TOURS, Sight, drive, errors, new_loop
from bench.rows import Row, Say, bounded

OCCUPIED = 65  # %
RUNS = 2


def build_map(sights: list[Sight]) -> tuple[Map, NDArray[np.float64], float]:
    """The map of these scans, the poses (n, 3) in it and the time [s] that it took."""
    mapper, poses = Mapper(), []
    begin = time.process_time()
    for sight in sights:
        mapper.update(sight.scan, LASER, sight.odometry, sight.covariance)
        poses.append(mapper.pose)
    return mapper.map, np.array(poses), time.process_time() - begin


def occupied_points(grid: Map) -> NDArray[np.float64]:
    """The middles (n, 2) [m] of the occupied cells."""
    x, y, resolution, cells = grid
    rows, columns = np.nonzero(cells >= OCCUPIED)
    return np.column_stack((x + (columns + 0.5) * resolution, y + (rows + 0.5) * resolution))


def text_of(figures: dict[str, float]) -> str:
    """Returns "walls 0.02, pose 0.01"."""
    return ", ".join(f"{key} {value:.3g}" for key, value in figures.items())


def judge(scene: str, seed: int) -> dict[str, float]:
    """One tour: m and parts."""
    sights = list(drive(new_loop(scene, seed), TOURS[scene]))
    grid, poses, seconds = build_map(sights)
    off = distances(read_scene(Path(share_file(f"urdf/scenes/{scene}.xml"))), occupied_points(grid))
    error = np.hypot(*errors(sights, poses)[:, :2].T)
    odometry = np.hypot(*errors(sights, np.array([sight.odometry for sight in sights]))[:, :2].T)
    return {
        "walls": float(np.sqrt(np.mean(off**2))),
        "beyond": float(np.mean(off > 0.1)),
        "pose": float(np.sqrt(np.mean(error**2))),
        "odometry": float(np.sqrt(np.mean(odometry**2))),
        "closes": float(error[-1]),
        "core": seconds / (SCAN_PERIOD * len(sights)),
    }


def rows_of(first: int, runs: int, say: Say) -> list[Row]:
    """Every figure is that of the worst tour."""
    rows = []
    for scene in TOURS:
        results = []
        for seed in range(first, first + runs):
            results.append(judge(scene, seed))
            say(f"map of {scene}, seed {seed}: {text_of(results[-1])}")
        worst = {key: max(result[key] for result in results) for key in results[0]}
        over_odometry = max(result["pose"] / result["odometry"] for result in results)
        rows += [
            bounded(f"{scene}: walls, RMS", worst["walls"], "m", 0.05),
            bounded(f"{scene}: walls beyond 10 cm", worst["beyond"], "of the cells", 0.05),
            bounded(f"{scene}: pose, RMS", worst["pose"], "m", 0.05),
            bounded(f"{scene}: pose against odometry", over_odometry, "of its RMS", 1.0),
            bounded(f"{scene}: end of the tour", worst["closes"], "m", 0.1),
            bounded(f"{scene}: cost at 10 Hz", worst["core"], "of a core", 0.15),
        ]
    return rows
