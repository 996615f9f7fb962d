"""Compares the odometry with the simple one on drives whose sensors err as real ones do: one row per kind of error.

source install/setup.bash; PYTHONPATH=.:$PYTHONPATH /usr/bin/python3 -m bench.odometry.field_bench --runs 50
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace

import numpy as np
from robot_control import Estimator

from bench.odometry.field_drive import Errors, field_drive, honesty
from bench.odometry.recordings import FloatArray, simple_path

FIELD = Errors()
CASES = {
    "field": FIELD,
    "stamps late by 5 ms": replace(FIELD, jitter=0.005),
    "stamps late by 10 ms": replace(FIELD, jitter=0.010),
    "wheels 0.1 s late": replace(FIELD, offset=0.1),
    "wheels 0.1 s early": replace(FIELD, offset=-0.1),
    "accelerometer 0.02": replace(FIELD, accelerometer=0.02),
    "accelerometer 0.2": replace(FIELD, accelerometer=0.2),
    "IMU 20 Hz, wheels 5 Hz": replace(FIELD, imu_rate=20, wheel_rate=5),
    "IMU 50 Hz, wheels 20 Hz": replace(FIELD, imu_rate=50, wheel_rate=20),
    "64 counts": replace(FIELD, counts=64),
    "centre of gravity 0.05 m ahead": replace(FIELD, sideways=0.05),
    "begins in motion": replace(FIELD, rest=0),
    "begins in motion, gyro without bias": replace(FIELD, rest=0, bias=(0.0, 0.0, 0.0)),
}
LITTLE = 0.002  # of the distance


@dataclass(frozen=True)
class Outcome:
    """Errors at the end, m; of one drive."""

    ours: float
    simple: float
    distance: float
    slip: float  # share of the time
    within: float  # share of the time within the 95 % ellipse of the position


def outcome(errors: Errors, seed: int) -> Outcome:
    """One drive of a minute."""
    drive = field_drive(errors, seed)
    out = Estimator(**drive.geometry()).process(*drive.samples())
    truth = drive.truth[drive.truth[:, 0] < drive.time[-1]]

    def away(x: FloatArray, y: FloatArray) -> FloatArray:
        seen = np.column_stack([np.interp(truth[:, 0], drive.time, values) for values in (x, y)])
        return np.asarray(seen - truth[:, 1:])

    ours, simple = away(out["x"], out["y"]), away(*simple_path(drive)[:, :2].T)
    within, slip = honesty(drive, out)
    return Outcome(
        ours=float(np.hypot(*ours[-1])),
        simple=float(np.hypot(*simple[-1])),
        distance=float(np.hypot(*np.diff(truth[:, 1:], axis=0).T).sum()),
        slip=slip,
        within=within,
    )


def row(name: str, outcomes: list[Outcome]) -> str:
    """A row of the table."""
    ours, simple = (np.array([getattr(one, which) for one in outcomes]) for which in ("ours", "simple"))
    little = LITTLE * np.array([one.distance for one in outcomes])
    ratio = ours / np.maximum(simple, little)
    slip, within = (np.mean([getattr(one, which) for one in outcomes]) for which in ("slip", "within"))
    return (
        f"| {name} | {np.median(simple):.3f} | {np.median(ours):.3f} | {np.median(ratio):.2f} | "
        f"{np.quantile(ratio, 0.95):.2f} | {100 * slip:.1f} % | {100 * within:.0f} % |"
    )


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--first", type=int, default=0, metavar="SEED")
    given = parser.parse_args()
    print("| sensors | simple, m | ours, m | ratio, median | ratio, 95 % | called slip | in the 95 % ellipse |")
    print("|---|---|---|---|---|---|---|")
    for name, errors in CASES.items():
        seeds = range(given.first, given.first + given.runs)
        print(row(name, [outcome(errors, seed) for seed in seeds]), flush=True)


if __name__ == "__main__":
    main()
