"""The mapper on logs of lasers: relations, absolute errors, and how long it is lost."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import numpy as np
from robot_control._mrpt import Mapper

from bench.navigation.laser_logs import Array, LaserLog, read_folder
from bench.navigation.odometry_model import FIELD, covariances, made
from bench.navigation.trajectories import absolute_error, composed, relation_errors
from bench.rows import Row, Say, bounded, plain

SEEDS = 3  # of an odometry that is made
AS_GOOD = 1.2  # of the relations' error of the reference that others made
FARTHEST = 0.3  # m, RMS
LOST = 20  # scans

Anchor = tuple[int, tuple[float, float, float]]
"""a node and a pose in its frame"""


@dataclass
class Followed:
    """The result of a log."""

    poses: Array  # (n, 3)
    lost: list[bool]

    @property
    def longest(self) -> int:
        """The most scans in a row that were lost."""
        return max((len(list(group)) for lost, group in groupby(self.lost) if lost), default=0)


def follow(log: LaserLog, odometry: Array, spreads: Array) -> Followed:
    """Feeds all scans. The poses are those of the last graph."""
    mapper, anchors, lost = Mapper(), [], []
    for index, (place, covariance) in enumerate(zip(odometry, spreads, strict=True)):
        mapper.update(log.scan(index), (0.0, 0.0, 0.0), place, covariance)
        anchors.append(mapper.anchor)
        lost.append(mapper.reason != "")
    return Followed(placed(mapper, anchors), lost)


def placed(mapper: Mapper, anchors: list[Anchor]) -> Array:
    """The poses (n, 3) of these anchors in the present graph."""
    nodes = np.array(mapper.nodes)[[node for node, _ in anchors]]
    return composed(nodes, np.array([relative for _, relative in anchors]))


def rows_of(folder: Path, first: int, seeds: int, say: Say) -> list[Row]:
    """A log with its own odometry is measured once, another one by seeds, of which the worst counts."""
    rows = []
    for log in read_folder(folder):
        if log.odometry is not None:
            drives = [(log.odometry, covariances(log.odometry, FIELD))]
        elif log.reference is not None:
            odometries = [made(log.reference, seed) for seed in range(first, first + seeds)]
            drives = [(odometry, covariances(odometry)) for odometry in odometries]
        else:
            raise ValueError(f"{log.name} has neither an odometry nor a reference")
        results = [follow(log, odometry, spreads) for odometry, spreads in drives]
        rows += _judged(log, results, say)
    return rows


def _judged(log: LaserLog, results: list[Followed], say: Say) -> list[Row]:
    rows = []
    if len(log.relations):
        errors = [relation_errors(log.time, result.poses, log.relations) for result in results]
        say(f"{log.name}: relations " + ", ".join(f"{metres:.3f} m {degrees:.2f}°" for metres, degrees in errors))
        rows.append(plain(f"{log.name}: relations, rotation", max(degrees for _, degrees in errors), "degrees"))
        worst = max(metres for metres, _ in errors)
        if log.reference is None:
            rows.append(plain(f"{log.name}: relations", worst, "m"))
        else:
            reference = relation_errors(log.time, log.reference, log.relations)[0]
            rows.append(bounded(f"{log.name}: relations", worst, "m", AS_GOOD * reference))
    elif log.reference is not None:
        distances = [absolute_error(result.poses, log.reference) for result in results]
        say(f"{log.name}: absolute error " + ", ".join(f"{metres:.3f} m" for metres in distances))
        rows.append(bounded(f"{log.name}: absolute error, RMS", max(distances), "m", FARTHEST))
    share = max(np.mean(result.lost) for result in results)
    rows.append(plain(f"{log.name}: lost", float(share), "of the scans"))
    rows.append(bounded(f"{log.name}: lost in a row", max(result.longest for result in results), "scans", LOST))
    return rows
