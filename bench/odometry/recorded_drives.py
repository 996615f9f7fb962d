"""Judges the estimator on every recording of a robot on wheels, beside the simple ways: `scripts/bench recordings`.

The simple ways take the distance from the wheels. They take the heading from the wheels, or from the gyro less its
bias. That is its mean in the first rest, or in the rests so far. A rest lasts REST s at least. A drive with a truth is
judged against it. Another one is judged against the nearer of the two simple ways with a gyro.

    rms     root mean square of the distance to the reference, after the best rigid motion to a truth
    NEES    eᵀ P⁻¹ e of (x, y), ideal 2; inside 2 σ: share of the rows with e below 2 σ, which is χ² below 6.18

The truth of the Warthog is late, so that it is compared at rests, with the heading.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from robot_control import Estimator
from robot_control.loop.estimator import FLAGS

from bench.odometry.recordings import (
    NAMES,
    FloatArray,
    Recording,
    aligned_errors,
    aligned_rms,
    commanded_drives,
    recording,
)
from bench.odometry.recordings import simple_path as first_rest
from bench.odometry.truth import wrapped
from bench.rows import Row, Say, plain

REST = 1.0  # s
SETTLED = 2.0  # s, of a rest, after which a late truth stands, too
PIECE = 60.0  # s, of a drive without a gyro
Rows = NDArray[Any]
TWO_SIGMA = 6.18  # 95.45 % of χ² with two degrees of freedom


@dataclass(frozen=True)
class Judged:
    """m and °. `simple`: end and RMS by simple way. `headings`: error and deviation at rests."""

    name: str
    way: float
    end: float
    rms: float
    simple: dict[str, tuple[float, float]]
    sigma_end: float
    sigma_max: float
    nees: float
    inside: float
    slip: float
    headings: FloatArray


def standing(drive: Recording) -> Rows:
    """(n,): rows inside a rest, in which no wheel leaves its place and which lasts REST s."""
    read = ~np.isnan(drive.left)
    time, angles = drive.time[read], np.column_stack([drive.left, drive.right])[read]
    changes = np.any(np.abs(np.diff(angles, axis=0)) > 2 * np.pi / (drive.counts or 4096) * 1.5, axis=1)
    moves = np.concatenate([[time[0]], time[1:][changes], time[:-1][changes], [time[-1]]])
    moves = np.sort(moves)
    rests = np.zeros(drive.time.size, bool)
    for begin, end in pairwise(moves):
        if end - begin >= REST:
            rests |= (drive.time > begin + 0.1) & (drive.time < end - 0.1)
    return rests


def rests_so_far(drive: Recording) -> FloatArray:
    """(n, 3) x, y, yaw: heading by the gyro less its mean over the rests so far, and none at rest."""
    rest = standing(drive)
    seen = ~np.isnan(drive.gyro[:, 2])
    time, rate, still = drive.time[seen], drive.gyro[seen, 2], rest[seen]
    count = np.cumsum(still)
    bias = np.where(count > 0, np.cumsum(np.where(still, rate, 0)) / np.maximum(count, 1), 0)
    turning = np.where(still, 0, rate - bias)
    turned = np.concatenate([[0], np.cumsum(np.diff(time) * (turning[1:] + turning[:-1]) / 2)])
    return _rolled(drive, np.interp(drive.time, time, turned))


def raw_wheels(drive: Recording) -> FloatArray:
    """(n, 3) x, y, yaw by the wheels alone."""
    read = ~np.isnan(drive.left)
    yaw = (drive.right - drive.left)[read] * drive.radius / drive.base
    return _rolled(drive, np.interp(drive.time, drive.time[read], yaw - yaw[0]))


def _rolled(drive: Recording, yaw: FloatArray) -> FloatArray:
    read = ~np.isnan(drive.left)
    travel = np.interp(drive.time, drive.time[read], drive.radius * (drive.left + drive.right)[read] / 2)
    middle = yaw - np.diff(yaw, prepend=yaw[0]) / 2
    steps = np.diff(travel, prepend=travel[0])
    return np.column_stack([np.cumsum(steps * np.cos(middle)), np.cumsum(steps * np.sin(middle)), yaw])


WAYS = {"first rest": first_rest, "rests so far": rests_so_far, "wheels": raw_wheels}
GYRO_WAYS = ("first rest", "rests so far")


def judge(drive: Recording) -> Judged:
    """Estimates and compares."""
    out = Estimator(**drive.geometry()).process(*drive.samples())
    path = np.column_stack([out["x"], out["y"], np.unwrap(out["yaw"])])
    ways = {name: way(drive) for name, way in WAYS.items()}
    read = ~np.isnan(drive.left)
    sigma = np.rad2deg(np.sqrt(out["pose_covariance"][:, 5, 5]))
    slips = (out["flags"] & FLAGS["slip"]) != 0
    steps = np.diff(drive.time, prepend=drive.time[0])
    errors, rows, headings = _errors(drive, path, ways)
    covariance = out["pose_covariance"][rows][:, :2, :2] + 1e-6 * np.eye(2)
    nees = np.einsum("ni,nij,nj->n", errors, np.linalg.inv(covariance), errors)
    return Judged(
        name=drive.name,
        way=float(np.abs(np.diff(drive.radius * (drive.left + drive.right)[read] / 2)).sum()),
        end=float(np.hypot(*errors[-1])),
        rms=_rms(drive, path, ways),
        simple={
            name: (float(np.hypot(*_errors(drive, way, ways)[0][-1])), _rms(drive, way, ways))
            for name, way in ways.items()
        },
        sigma_end=float(sigma[-1]),
        sigma_max=float(sigma.max()),
        nees=float(np.mean(nees)),
        inside=float(np.mean(nees < TWO_SIGMA)),
        slip=float(steps[slips].sum() / drive.time[-1]),
        headings=np.column_stack([headings, sigma[rows]]) if headings.size else np.empty((0, 2)),
    )


def _nearer(path: FloatArray, ways: dict[str, FloatArray]) -> FloatArray:
    """The simple way with a gyro that ends nearer."""
    return min((ways[name] for name in GYRO_WAYS), key=lambda way: float(np.hypot(*(path - way)[-1, :2])))


def _errors(drive: Recording, path: FloatArray, ways: dict[str, FloatArray]) -> tuple[FloatArray, Rows, FloatArray]:
    """(k, 2) m against the reference, the rows of the drive, and (k,) ° of the heading where the truth has one."""
    if drive.truth.size == 0:
        rows = np.flatnonzero(drive.time > drive.rest)
        return (path - _nearer(path, ways))[rows, :2], rows, np.empty(0)
    time = drive.truth[:, 0]
    seen = time < drive.time[-1]
    rows = np.searchsorted(drive.time, time[seen]).clip(0, drive.time.size - 1)
    truth, moved = drive.truth[seen, 1:], time[seen] > drive.rest
    if truth.shape[1] < 3:
        return aligned_errors(path[rows[moved], :2], truth[moved]), rows[moved], np.empty(0)
    start, turn = truth[~moved][-1], path[rows[~moved][-1], 2] - truth[~moved][-1, 2]
    kept = np.flatnonzero(_settled(drive)[rows] & moved)
    rows, truth = rows[kept], truth[kept]
    cos, sin = np.cos(turn), np.sin(turn)
    placed = (truth[:, :2] - start[:2]) @ np.array([[cos, sin], [-sin, cos]])
    off = path[rows, 2] - truth[:, 2] - turn
    return path[rows, :2] - placed, rows, np.rad2deg(wrapped(off))


def _settled(drive: Recording) -> Rows:
    """(n,): rows at rest for SETTLED s."""
    rest = standing(drive)
    began = np.maximum.accumulate(np.where(rest, -np.inf, drive.time))
    return np.asarray(rest & (drive.time - began > SETTLED))


def _rms(drive: Recording, path: FloatArray, ways: dict[str, FloatArray]) -> float:
    if drive.truth.shape[1] == 3 and drive.truth.size:
        seen = (drive.truth[:, 0] < drive.time[-1]) & (drive.truth[:, 0] > drive.rest)
        at = [np.interp(drive.truth[seen, 0], drive.time, path[:, axis]) for axis in (0, 1)]
        return aligned_rms(np.column_stack(at), drive.truth[seen, 1:])
    errors = _errors(drive, path, ways)[0]
    return float(np.sqrt(np.mean(np.sum(errors**2, axis=1))))


@dataclass(frozen=True)
class WithoutGyro:
    """The pieces of one robot hold yaw error and σ in °, NEES of the position, errors of both paths and way in m."""

    name: str
    yaw: FloatArray
    sigma: FloatArray
    nees: FloatArray
    away: FloatArray
    raw: FloatArray
    way: FloatArray


def judge_without_gyro(name: str, drive: Recording) -> WithoutGyro:
    """Pieces of PIECE s in which the robot moves; each begins at the truth."""
    read = ~np.isnan(drive.left)
    rows = []
    for begin in np.arange(drive.time[0], drive.time[-1] - PIECE, PIECE):
        piece = read & (drive.time >= begin) & (drive.time < begin + PIECE)
        time, left, right = drive.time[piece], drive.left[piece], drive.right[piece]
        near = [np.min(np.abs(drive.truth[:, 0] - t)) for t in (time[0], time[-1])] if time.size > 1 else [np.inf]
        travel = drive.radius * (left + right) / 2
        way = float(np.abs(np.diff(travel)).sum())
        if max(near) > REST or way < REST:
            continue
        out = Estimator(**drive.geometry()).process(time - time[0], left, right)
        first, last = (_pose_at(drive.truth, t) for t in (time[0], time[-1]))
        cos, sin = np.cos(first[2]), np.sin(first[2])
        true = np.array([[cos, sin], [-sin, cos]]) @ (last - first)[:2]
        turned = wrapped(out["yaw"][-1] - (last - first)[2])
        error = np.array([out["x"][-1], out["y"][-1]]) - true
        covariance = out["pose_covariance"][-1]
        raw = np.hypot(out["wheel_x"][-1] - true[0], out["wheel_y"][-1] - true[1])
        nees = float(error @ np.linalg.solve(covariance[:2, :2], error))
        rows.append([np.rad2deg(turned), np.rad2deg(np.sqrt(covariance[5, 5])), nees, np.hypot(*error), raw, way])
    return WithoutGyro(name, *np.array(rows).reshape(-1, 6).T)


def _pose_at(truth: FloatArray, time: float) -> FloatArray:
    yaw = np.unwrap(truth[:, 3])
    return np.array([np.interp(time, truth[:, 0], column) for column in (truth[:, 1], truth[:, 2], yaw)])


def lines(drives: list[Judged], without: list[WithoutGyro]) -> Iterator[str]:
    """The table."""
    cells = ("way m", "end m", "rms m", "σ yaw °", "max °", "NEES", "in 2 σ %", "slip %")
    yield f"{'recording':<26}" + "".join(f"{cell:>9}" for cell in cells) + "".join(f"{way:>16}" for way in WAYS)
    for one in drives:
        values = (one.way, one.end, one.rms, one.sigma_end, one.sigma_max, one.nees, 100 * one.inside, 100 * one.slip)
        simple = "".join(f"{f'{end:.2f} / {rms:.2f}':>16}" for end, rms in one.simple.values())
        yield f"{one.name:<26}" + "".join(f"{value:9.3g}" for value in values) + simple
        if one.headings.size:
            off, sigma = one.headings.T
            yield f"{'':<26}  headings at rests: {off[-1]:+.2f} ± {sigma[-1]:.2f} ° at the end, RMS {_root(off):.2f} °"
    titles = ("pieces", "way m", "off m", "raw m", "yaw °", "σ yaw °", "1 σ %", "2 σ %", "NEES", "in 2 σ %")
    if without:
        yield f"{'without a gyro, 60 s':<26}" + "".join(f"{title:>9}" for title in titles)
    for some in without:
        off = np.abs(some.yaw) / some.sigma
        figures = (
            some.way.size,
            some.way.mean(),
            _root(some.away),
            _root(some.raw),
            _root(some.yaw),
            _root(some.sigma),
            100 * np.mean(off < 1),
            100 * np.mean(off < 2),
            some.nees.mean(),
            100 * np.mean(some.nees < TWO_SIGMA),
        )
        yield f"{some.name:<26}" + "".join(f"{figure:9.3g}" for figure in figures)


def _root(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def bench(say: Say) -> tuple[list[str], list[Row]]:
    """The table, and rows of all figures."""
    drives = []
    for name in NAMES:
        say(name)
        drives.append(judge(recording(name)))
    pieces = [judge_without_gyro(name, drive) for name, drive in commanded_drives().items()]
    rows = [row for one in drives for row in _rows(one)]
    inside = np.concatenate([np.abs(some.yaw) / some.sigma for some in pieces])
    rows.append(plain("without a gyro, yaw inside 2 σ", 100 * float(np.mean(inside < 2)), "%"))
    return list(lines(drives, pieces)), rows


def _rows(one: Judged) -> list[Row]:
    figures = {"end": (one.end, "m"), "rms": (one.rms, "m"), "σ of yaw, largest": (one.sigma_max, "°")}
    figures |= {"NEES": (one.nees, ""), "inside 2 σ": (100 * one.inside, "%"), "slip": (100 * one.slip, "%")}
    return [plain(f"{one.name}, {what}", value, unit) for what, (value, unit) in figures.items()]
