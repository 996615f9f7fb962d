"""The measurements of a trial's sensors beside the truth: estimators are tried on them offline."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from robot_control.loop.closed_loop import ClosedLoop

from bench.odometry.errors import Errors
from bench.odometry.scenarios import Trial

Array = NDArray[np.float64]
TRUTH_EVERY = 10  # cycles: 10 ms, ten times as fast as odometry is published and faster than any slip


@dataclass(frozen=True)
class Recording:
    """N cycles of 1 ms, M = N/10 rows of truth. `base` and `imu` axes are those of the links, REP 103.

    Measured: `time` (N,) s; `left`, `right` (N,) rad, encoder angles; `gyro` (N, 3) rad/s, `accel` (N, 3) m/s² in IMU
    axes. `index` (M,) has the cycles of the truth. `position` (M, 3) m and `orientation` (M, 4) x y z w are base_link's
    pose relative to cycle 0: x ahead, z the ground's normal. `linear` (M, 3) m/s and `angular` (M, 3) rad/s are in base
    axes; `wheel_speed` (M, 2) rad/s is left and right. `slip` (M, 2) m/s is the speed of the contact patches over the
    ground; `load` (M, 2) is in N. `up` (3,) points away from the earth, in truth's axes. `stopped`: the safety monitor
    ever braked. `nominal` has wheel_radius and wheel_base in m; `errors` has the true values relative to them.
    """

    scenario: str
    seed: int
    time: Array
    left: Array
    right: Array
    gyro: Array
    accel: Array
    index: NDArray[np.int64]
    position: Array
    orientation: Array
    linear: Array
    angular: Array
    wheel_speed: Array
    slip: Array
    load: Array
    up: Array
    stopped: bool
    nominal: dict[str, float]
    errors: Errors
    marks: dict[str, list[int]]


def record(trial: Trial) -> Recording:
    """Drives a trial and records it."""
    loop = _loop(trial)
    parts: list[dict[str, Array]] = []
    block = 60_000 // TRUTH_EVERY * TRUTH_EVERY  # cycles whose truth is held at once
    for first in range(0, len(trial.commands), block):
        log = loop.record(trial.commands[first : first + block])
        for name in ("position", "orientation", "linear", "angular", "wheel_speed", "slip", "load"):
            log[name] = log[name][::TRUTH_EVERY].copy()
        parts.append(log)
    log = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    wheels, stopped = log.pop("wheel_position"), log.pop("stopped")
    log |= {"left": np.ascontiguousarray(wheels[:, 0]), "right": np.ascontiguousarray(wheels[:, 1])}
    return Recording(
        scenario=trial.scenario,
        seed=trial.seed,
        index=np.arange(0, len(trial.commands), TRUTH_EVERY),
        up=np.array(trial.up),
        stopped=bool(stopped[100:].any()),  # the monitor waits for the nodes, then for its first permit
        nominal={"wheel_radius": loop.robot["wheels"][0]["radius"], "wheel_base": loop.robot["wheel_base"]},
        errors=trial.errors,
        marks=trial.marks,
        **log,
    )


def _loop(trial: Trial) -> ClosedLoop:
    if not trial.scene:
        return ClosedLoop(params=trial.params, seed=trial.plant_seed)
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as scene:
        scene.write(trial.scene)
        scene.flush()
        return ClosedLoop(params=trial.params, seed=trial.plant_seed, scene=scene.name)
