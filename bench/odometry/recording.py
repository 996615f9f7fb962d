"""The measurements of a trial's sensors beside the truth, in memory or as .npz: estimators are tried on them offline.

python3 -P -m bench.odometry.recording FOLDER slip 0 30     # seeds 0 … 29 → FOLDER/slip_0.npz …
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from robot_control.loop.closed_loop import ClosedLoop

from bench.odometry.errors import Errors
from bench.odometry.scenarios import SCENARIOS, Trial, draw_trial

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

    def save(self, path: Path) -> None:
        """Writes .npz; numbers and dicts go into the JSON text `about`."""
        arrays: dict[str, Any] = {}
        about: dict[str, Any] = {}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            (arrays if isinstance(value, np.ndarray) else about)[field.name] = value
        about["errors"] = dataclasses.asdict(self.errors)
        np.savez(path, about=json.dumps(about), **arrays)


def load_recording(path: Path) -> Recording:
    """Reads what `save` wrote."""
    with np.load(path) as file:
        about: dict[str, Any] = json.loads(str(file["about"]))
        arrays = {key: file[key] for key in file.files if key != "about"}
    about["errors"] = Errors(**about["errors"])
    return Recording(**about, **arrays)


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


def recorded(draw: Callable[[], Trial], name: str, cache: Path | None) -> Recording:
    """The recording of that name from the cache; it is driven if it is not there."""
    path = None if cache is None else cache / f"{name}.npz"
    if path is not None and path.exists():
        return load_recording(path)
    recording = record(draw())
    if path is not None:
        recording.save(path)
    return recording


def _loop(trial: Trial) -> ClosedLoop:
    if not trial.scene:
        return ClosedLoop(params=trial.params, seed=trial.plant_seed)
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as scene:
        scene.write(trial.scene)
        scene.flush()
        return ClosedLoop(params=trial.params, seed=trial.plant_seed, scene=scene.name)


def main() -> None:
    """Records trials into a folder."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("scenario", choices=list(SCENARIOS))
    parser.add_argument("first", type=int)
    parser.add_argument("seeds", type=int)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    for seed in range(given.first, given.first + given.seeds):
        path = given.folder / f"{given.scenario}_{seed}.npz"
        record(draw_trial(given.scenario, seed)).save(path)
        print(path, flush=True)


if __name__ == "__main__":
    main()
