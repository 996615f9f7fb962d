"""A long ring of corridors with furniture by a seed, of which 60 m have none: is the loop closed, and how well?"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np
from robot_control._mrpt import Mapper

from bench.navigation.mapping import text_of
from bench.navigation.on_logs import placed
from bench.navigation.tour import LASER, SCAN_PERIOD, drive, new_loop
from bench.navigation.trajectories import absolute_error
from bench.rows import Row, Say, bounded, plain
from bench.runs.runner import Processes

LONG, SHORT, HALF = 130.0, 70.0, 1.2  # m: the ring along its middle, half of its width
EMPTY = (5.0, 65.0)  # m, without furniture in the far long corridor
SPACING = (2.0, 6.0)  # m between two pieces
CORNERS = ((100.0, 0.0), (100.0, SHORT), (-30.0, SHORT), (-30.0, 0.0), (10.0, 0.0))  # m, from the start
SEEDS, FARTHEST = 5, 0.3  # m, RMS

Box = tuple[float, float, float, float]
"""middle x, y, half of the size in x, y: m"""


def boxes(seed: int) -> list[Box]:
    """The walls and the furniture."""
    left, right = CORNERS[2][0], CORNERS[0][0]
    middle_x, middle_y = (left + right) / 2, SHORT / 2
    walls = [(middle_x, middle_y, LONG / 2 - HALF, SHORT / 2 - HALF)]
    for side in (-1, 1):
        walls.append((middle_x, middle_y + side * (SHORT / 2 + HALF), LONG / 2 + HALF, 0.05))
        walls.append((middle_x + side * (LONG / 2 + HALF), middle_y, 0.05, SHORT / 2 + HALF))
    random = np.random.default_rng(seed)
    for along_x, middle in ((True, 0.0), (True, SHORT), (False, left), (False, right)):
        begin, end = (left, right) if along_x else (0.0, SHORT)
        at = begin + 2
        while at < end - 2:
            half, depth = random.uniform(0.1, 0.6), random.uniform(0.05, 0.25)
            across = middle + random.choice((-1, 1)) * (HALF - depth)
            if not (along_x and middle == SHORT and EMPTY[0] - 1 < at < EMPTY[1] + 1):
                walls.append((at, across, half, depth) if along_x else (across, at, depth, half))
            at += random.uniform(*SPACING)
    return walls


def scene_of(walls: list[Box]) -> str:
    """The scene in MJCF."""
    geoms = "".join(f'<geom type="box" pos="{x} {y} 0.5" size="{a} {b} 0.5"/>' for x, y, a, b in walls)
    return (
        '<mujoco><worldbody><geom name="floor" type="plane" size="200 200 1" friction="1.0 0.005 0.0001"/>'
        f'<site name="start" pos="0 0 0"/>{geoms}</worldbody></mujoco>'
    )


def once(seed: int) -> dict[str, float]:
    """One round and 10 m more."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "ring.xml"
        scene.write_text(scene_of(boxes(seed)))
        mapper, anchors, truths, odometry, lost, seconds = Mapper(), [], [], [], 0, 0.0
        for sight in drive(new_loop(scene, seed), CORNERS):
            begin = time.process_time()
            mapper.update(sight.scan, LASER, sight.odometry, sight.covariance)
            seconds += time.process_time() - begin
            anchors.append(mapper.anchor)
            truths.append(sight.truth)
            odometry.append(sight.odometry)
            lost += mapper.reason != ""
    truth = np.array(truths)
    return {
        "error": absolute_error(placed(mapper, anchors), truth),
        "odometry": absolute_error(np.array(odometry), truth),
        "closed": mapper.closed,
        "lost": lost,
        "core": seconds / (SCAN_PERIOD * len(truths)),
    }


def rows_of(first: int, runs: int, say: Say) -> list[Row]:
    """Every figure is that of the worst ring."""
    seeds = range(first, first + runs)
    results = list(Processes().outcomes(once, list(seeds), say))
    for seed, result in zip(seeds, results, strict=True):
        say(f"ring of {2 * (LONG + SHORT):.0f} m, seed {seed}: {text_of(result)}")
    worst = {key: max(result[key] for result in results) for key in results[0]}
    return [
        bounded("long ring: absolute error, RMS", worst["error"], "m", FARTHEST),
        plain("long ring: absolute error of the odometry, RMS", worst["odometry"], "m"),
        bounded("long ring: loop not closed", sum(not result["closed"] for result in results), f"of {runs}", 0),
        bounded("long ring: lost", worst["lost"], "scans", 0),
        bounded("long ring: cost at 10 Hz", worst["core"], "of a core", 0.15),
    ]
