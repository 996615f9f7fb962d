"""SHA-256 sums of recorded runs: a change that is meant to keep the behaviour reproduces every one of them.

    scripts/behaviour [--check]    compares this build with the recorded sums
    scripts/behaviour --record     records the sums of this build

Runs: `run.csv` of `sim.launch clock:=lockstep` with a command script, and logs of `ClosedLoop` on five robots, each
with two seeds, the second with faults of sensors, motors, battery, button and nodes. A robot whose description is
absent is skipped; recording keeps its sums.

The sums are of floating-point numbers: libm selects its routines by the processor's instructions, and the last bits
may differ with them. The sums are stored together with the kind of processor on which they were recorded, and mean
nothing on another.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import platform
import re
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from lab.robot_corpus import DIFFBOT, urdf_of
from robot_control import ClosedLoop

SUMS = Path(__file__).with_name("sums.json")
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
LAUNCH_WITH_FAULTS = f"{LAUNCH} faults:=true"
LAUNCH_LIMIT = 120.0  # s; the run takes 5 s on an idle machine

Sum = Callable[[], str]


class _Recorder:
    """Sends a command as a sender does, and adds every row that results to a sum."""

    def __init__(self, loop: ClosedLoop) -> None:
        self._loop = loop
        self._sum = hashlib.sha256()
        self._names: tuple[str, ...] = ()

    def drive(self, seconds: float, linear: float, angular: float) -> None:
        cycles = round(seconds / self._loop.period)
        for first in range(0, cycles, SEND_CYCLES):
            self._loop.command(linear, angular)
            log = self._loop.step(min(SEND_CYCLES, cycles - first))
            if not self._names:
                self._names = tuple(log)
                self._sum.update(",".join(self._names).encode())
            for name in self._names:
                self._sum.update(log[name].tobytes())

    def digest(self) -> str:
        return self._sum.hexdigest()


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


def launch_lockstep(faults: str = "false") -> str:
    """Sum of the `run.csv` that `sim.launch clock:=lockstep` writes.

    Raises:
        subprocess.CalledProcessError: with roslaunch's output, where it fails.
        subprocess.TimeoutExpired: where the run does not end.
    """
    with tempfile.TemporaryDirectory(prefix="behaviour-") as folder, socket.socket() as free:
        script = Path(folder) / "script.csv"
        script.write_text(LAUNCH_SCRIPT)
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
        free.close()
        arguments = {
            "clock": "lockstep",
            "faults": faults,
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
        return hashlib.sha256((Path(folder) / "run.csv").read_bytes()).hexdigest()


def runs() -> dict[str, Sum]:
    """Name of each run, and what gives its sum."""
    result: dict[str, Sum] = {LAUNCH: launch_lockstep, LAUNCH_WITH_FAULTS: lambda: launch_lockstep("true")}
    for robot in ROBOTS:
        result[healthy_name(robot)] = lambda robot=robot: drive_healthy(robot, HEALTHY_SEED)  # type: ignore[misc]
        result[faulty_name(robot)] = lambda robot=robot: drive_with_faults(robot, FAULTY_SEED)  # type: ignore[misc]
    return result


def healthy_name(robot: str) -> str:
    """Of the run without faults."""
    return f"ClosedLoop {robot}, seed {HEALTHY_SEED}"


def faulty_name(robot: str) -> str:
    """Of the run with faults."""
    return f"ClosedLoop {robot}, seed {FAULTY_SEED}, faults"


def processor(cpuinfo: str | None = None) -> str:
    """Architecture, maker and the instructions by which libm selects its routines."""
    text = Path("/proc/cpuinfo").read_text() if cpuinfo is None else cpuinfo

    def field(name: str) -> str:
        found = re.search(rf"^{name}\s*: (.*)$", text, re.MULTILINE)
        return found[1] if found else "unknown"

    instructions = sorted({"fma", "avx2", "avx512f"} & set(field("flags").split()))
    return " ".join([platform.machine(), field("vendor_id"), *instructions])


def recorded() -> tuple[str, dict[str, str]]:
    """Kind of processor and sums of the checked-in file."""
    content = json.loads(SUMS.read_text())
    return content["processor"], content["sums"]


def sums(chosen: Mapping[str, Sum]) -> Iterator[tuple[str, str | None, str]]:
    """Name, sum (None: skipped) and the reason of the skip."""
    for name, run in chosen.items():
        try:
            yield name, run(), ""
        except FileNotFoundError as error:
            yield name, None, str(error)


def check() -> int:
    """Compares; prints one line per run. The exit code."""
    kind, expected = recorded()
    if kind != processor():
        print(f"recorded on another kind of processor ({kind}, here {processor()}): sums cannot be compared")
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
    """Writes the file of sums. The exit code."""
    kind, kept = recorded() if SUMS.is_file() else (processor(), {})
    if kind != processor():
        kept = {}
    for name, found, reason in sums(runs()):
        print(f"{name}: {found or f'skipped, {reason}'}", flush=True)
        if found is not None:
            kept[name] = found
    SUMS.write_text(json.dumps({"processor": processor(), "sums": kept}, indent=2) + "\n")
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


if __name__ == "__main__":
    sys.exit(main())
