"""SHA-256 sums of recorded runs: a change that keeps the behaviour reproduces all of them.

    scripts/behaviour [--check]    compares this build with the recorded sums
    scripts/behaviour --record     records the sums of this build

A sum covers the physical quantities of `ROW_QUANTITIES` and `JOINT_QUANTITIES`, by name and value, in every cycle.
Neither their storage and order in the log nor its other fields count. If a field is renamed, `RENAMED` maps the
quantity to it, and the sums stay.

Runs: `sim.launch clock:=lockstep` with a command script, and `ClosedLoop` on five robots, each with two seeds, the
second with faults of sensors, motors, battery, button and nodes. A robot whose description is absent is skipped;
recording keeps its sums.

The last bits depend on libm, which selects its routines by the processor's instructions: without FMA or AVX2, exp, log,
pow and atan2 round otherwise; AVX-512 changes nothing. `libm_kind` is therefore computed from results of libm, and the
sums are stored together with it.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import os
import platform
import random
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from robot_control import ClosedLoop
from robot_control.data.run_log import FloatArray, Log, read_run

from bench.robot_corpus import DIFFBOT, urdf_of

SUMS = Path(__file__).with_name("sums.json")
ROW_QUANTITIES = (
    *("time", "battery_voltage", "gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"),
    *("truth_x", "truth_y", "truth_yaw", "truth_linear", "truth_angular"),
    *("estimate_x", "estimate_y", "estimate_z", "estimate_yaw", "estimate_roll", "estimate_pitch"),
    *("estimate_linear", "estimate_lateral", "estimate_angular", "estimate_distance"),
    *("estimate_x_variance", "estimate_y_variance", "estimate_yaw_variance"),
    *("estimate_xy_covariance", "estimate_x_yaw_covariance", "estimate_y_yaw_covariance"),
    *("estimate_linear_variance", "estimate_lateral_variance", "estimate_angular_variance"),
    *("gyro_bias_x", "gyro_bias_y", "gyro_bias_z", "radius_ratio", "wheel_base_factor"),
    *("wheel_odom_x", "wheel_odom_y", "wheel_odom_yaw", "wheel_odom_linear", "wheel_odom_angular"),
    *("requested_linear", "requested_angular", "limited_linear", "limited_angular", "speed_limit"),
    *("permit_action", "supervisor_state", "gate_verdict"),
)
JOINT_QUANTITIES = (
    *("position", "velocity", "effort"),
    *("mode", "effort_command", "velocity_command", "velocity_measured"),
)
RENAMED: Mapping[str, str] = {}
"""Quantity → its column in the log, where that has another name than the quantity or, of a joint, `<joint>_<quantity>`.
In a joint's column `{joint}` stands for its name: `{"effort": "{joint}_torque"}`."""
ROBOTS = (DIFFBOT, "create_2", "jackal", "pmb2", "scout_v2")
HEALTHY_SEED, FAULTY_SEED = 1, 2
LEGS = ((0.5, 0.2), (-0.3, 0.5), (0.0, -1.0), (0.8, 0.0))  # m/s, rad/s
LEG_TIME = 1.5  # s
SEND_CYCLES = 50  # between two messages of the sender
FAULTS = tuple(
    (component, kind)
    for component, kinds in {
        "controller": ("off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent"),
        "estimator": ("off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent"),
        "monitor": ("off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent"),
        "gyro": ("stuck", "delayed"),
        "accelerometer": ("intermittent",),
        "right_motor": ("off", "slow"),
        "battery": ("wrong",),
        "e_stop_button": ("off", "intermittent"),
        "left_encoder": ("off", "stuck", "garbage", "wrong"),
    }.items()
    for kind in kinds
)
DRIVE_BEFORE_FAULT, FAULT_TIME, REST_TIME = 0.4, 0.15, 1.5  # s
LAUNCH_CYCLES = 8000
LAUNCH_SCRIPT = """\
cycle,linear,angular,event
1,0.5,0.2,
1000,0.5,0.2,
2000,-0.3,0.5,
2500,,,e_stop
2600,0,0,
4000,,,e_stop_reset
4100,0.8,0,
5000,nan,0,
6500,0,-1,
"""
LAUNCH = "sim.launch clock:=lockstep"
REMEDY = "run scripts/behaviour --record at the commit before the change, and --check after it"
LAUNCH_LIMIT = 120.0  # s; the run takes 5 s on an idle machine

Sum = Callable[[], str]


class MissingColumnError(ValueError):
    """A quantity has no column in the log."""


class QuantitySum:
    """The sum of all quantities of a robot with these joints, over rows that may come in parts."""

    def __init__(self, joints: Sequence[str]) -> None:
        self._columns = {name: RENAMED.get(name, name) for name in ROW_QUANTITIES}
        for joint in joints:
            for name in JOINT_QUANTITIES:
                self._columns[f"{joint} {name}"] = RENAMED.get(name, f"{{joint}}_{name}").format(joint=joint)
        self._sums = {name: hashlib.sha256() for name in self._columns}

    def add(self, log: Log) -> None:
        """Adds rows.

        Raises:
            MissingColumnError: the log has no column of a quantity.
        """
        for name, column in self._columns.items():
            if column not in log:
                raise MissingColumnError(
                    f"{name}: the log has no column {column}; name its new one in RENAMED of {__file__}"
                )
            self._sums[name].update(_canonical(log[column]).tobytes())

    def digest(self) -> str:
        lines = sorted(f"{name} {one.hexdigest()}" for name, one in self._sums.items())
        return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _canonical(values: FloatArray) -> FloatArray:
    """Equal values have equal bits: one zero, one NaN."""
    return np.where(np.isnan(values), np.nan, values + 0.0)


class _Recorder:
    """Sends a command as a sender does, and adds every resulting row to a sum."""

    def __init__(self, loop: ClosedLoop) -> None:
        self._loop = loop
        self._sum = QuantitySum([joint["name"] for joint in loop.robot["joints"]])

    def drive(self, seconds: float, linear: float, angular: float) -> None:
        cycles = round(seconds / self._loop.period)
        for first in range(0, cycles, SEND_CYCLES):
            self._loop.command(linear, angular)
            self._sum.add(self._loop.step(min(SEND_CYCLES, cycles - first)))

    def digest(self) -> str:
        return self._sum.digest()


def drive_healthy(robot: str, seed: int) -> str:
    """Sum of a drive with an emergency stop, its reset and a reset of the plant."""
    loop = ClosedLoop(seed=seed, urdf=urdf_of(robot))
    recorder = _Recorder(loop)
    recorder.drive(0.2, 0, 0)
    for linear, angular in LEGS:
        recorder.drive(LEG_TIME, linear, angular)
    loop.e_stop()
    recorder.drive(0.5, *LEGS[0])
    recorder.drive(2.0, 0, 0)
    loop.e_stop_reset()
    recorder.drive(LEG_TIME, *LEGS[0])
    loop.reset()
    recorder.drive(0.2, 0, 0)
    recorder.drive(LEG_TIME, *LEGS[1])
    return recorder.digest()


def drive_with_faults(robot: str, seed: int) -> str:
    """Sum of a drive with one fault after the other; after each the robot rests, and its stop is reset."""
    loop = ClosedLoop({"mujoco_plant": {"battery_voltage": 24.0}}, seed=seed, urdf=urdf_of(robot))
    recorder = _Recorder(loop)
    recorder.drive(0.2, 0, 0)
    for index, (component, kind) in enumerate(FAULTS):
        leg = LEGS[index % len(LEGS)]
        recorder.drive(DRIVE_BEFORE_FAULT, *leg)
        loop.inject_fault(component, kind)
        recorder.drive(FAULT_TIME, *leg)
        loop.inject_fault(component, "ok")
        recorder.drive(REST_TIME, 0, 0)
        loop.e_stop_reset()
    return recorder.digest()


def launch_lockstep() -> str:
    """Sum of the `run.bag` that `sim.launch clock:=lockstep` writes, at the float32 in which it keeps most outputs.

    Raises:
        subprocess.CalledProcessError: with roslaunch's output, where it fails.
        subprocess.TimeoutExpired: where the run does not end.
    """
    with tempfile.TemporaryDirectory(prefix="behaviour-") as folder, socket.socket() as free:
        script = Path(folder) / "script.csv"
        script.write_text(LAUNCH_SCRIPT)
        params = Path(folder) / "params.yaml"
        params.write_text("telemetry: {record: always}\n")
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
        free.close()
        arguments = {
            "clock": "lockstep",
            "params": params,
            "seed": HEALTHY_SEED,
            "cycles": LAUNCH_CYCLES,
            "command_script": script,
            "telemetry": "true",
            "out": folder,
            "bus": f"behaviour_{os.getpid()}",
        }
        environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
        environment = {
            name: value for name, value in environment.items() if name not in ("ROS_HOSTNAME", "ROS_NAMESPACE")
        }
        subprocess.run(
            [
                "roslaunch",
                "-p",
                str(port),
                "robot_control",
                "sim.launch",
                *(f"{name}:={value}" for name, value in arguments.items()),
            ],
            env={**environment, "ROS_HOME": folder},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=True,
            timeout=LAUNCH_LIMIT,
        )
        run = read_run(Path(folder) / "run.bag")
        result = QuantitySum(run.header["joints"])
        result.add({name: values.astype(np.float32).astype(np.float64) for name, values in run.columns.items()})
        return result.digest()


def runs() -> dict[str, Sum]:
    """Name of each run, and the function that computes its sum."""
    result: dict[str, Sum] = {LAUNCH: launch_lockstep}
    for robot in ROBOTS:
        result[healthy_name(robot)] = lambda robot=robot: drive_healthy(robot, HEALTHY_SEED)  # type: ignore[misc]
        result[faulty_name(robot)] = lambda robot=robot: drive_with_faults(robot, FAULTY_SEED)  # type: ignore[misc]
    return result


def healthy_name(robot: str) -> str:
    """Name of the run without faults."""
    return f"ClosedLoop {robot}, seed {HEALTHY_SEED}"


def faulty_name(robot: str) -> str:
    """Name of the run with faults."""
    return f"ClosedLoop {robot}, seed {FAULTY_SEED}, faults"


def libm_kind() -> str:
    """Architecture, and a sum of libm's results for a thousand arguments."""
    seeded = random.Random(0)
    functions = (math.sin, math.cos, math.tan, math.atan, math.tanh, math.exp, math.expm1, math.erfc)
    result = hashlib.sha256()
    for _ in range(1000):
        x, y = seeded.uniform(-8, 8), seeded.uniform(0, 8)
        values = [f(x) for f in functions]
        values += [math.asin(x / 8), math.acos(x / 8), math.atan2(x, y), math.log(y), math.pow(y, x)]
        result.update(np.array(values).tobytes())
    return f"{platform.machine()} libm {result.hexdigest()[:16]}"


def recorded() -> tuple[str, dict[str, str]]:
    """Kind of libm and sums of the checked-in file."""
    content = json.loads(SUMS.read_text())
    return content["kind"], content["sums"]


def sums(chosen: Mapping[str, Sum]) -> Iterator[tuple[str, str | None, str]]:
    """Name, sum (None: skipped) and the reason of the skip."""
    for name, run in chosen.items():
        try:
            yield name, run(), ""
        except FileNotFoundError as error:
            yield name, None, str(error)


def check() -> int:
    """Compares and prints one line per run; returns the exit code."""
    kind, expected = recorded()
    if kind != libm_kind():
        print(f"recorded with another libm ({kind}, here {libm_kind()}): {REMEDY}")
        return 2
    failed = 0
    for name, found, reason in sums(runs()):
        if found is None:
            print(f"{name}: skipped, {reason}")
        elif found == expected.get(name):
            print(f"{name}: same", flush=True)
        else:
            failed += 1
            print(f"{name}: DIFFERENT, {found} instead of {expected.get(name)}", flush=True)
    return 1 if failed else 0


def record() -> int:
    """Writes the file of sums; returns the exit code."""
    kind, kept = recorded() if SUMS.is_file() else (libm_kind(), {})
    if kind != libm_kind():
        kept = {}
    chosen = runs()
    kept = {name: value for name, value in kept.items() if name in chosen}
    for name, found, reason in sums(chosen):
        print(f"{name}: {found or f'skipped, {reason}'}", flush=True)
        if found is not None:
            kept[name] = found
    SUMS.write_text(json.dumps({"kind": libm_kind(), "sums": kept}, indent=2) + "\n")
    return 0


def main() -> int:
    """Entry point of scripts/behaviour."""
    parser = argparse.ArgumentParser(prog="scripts/behaviour", description="Does the behaviour stay?")
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("--check", action="store_true", help="compare with the recorded sums")
    action.add_argument("--record", action="store_true", help="record the sums of this build")
    given = parser.parse_args()
    try:
        return check() if given.check else record()
    except subprocess.CalledProcessError as error:
        print(f"scripts/behaviour: roslaunch failed:\n{error.output}", file=sys.stderr)
        return 3
    except MissingColumnError as error:
        print(f"scripts/behaviour: {error}", file=sys.stderr)
        return 3


if __name__ == "__main__":
    sys.exit(main())
