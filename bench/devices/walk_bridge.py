"""The bridge of a simulated Go2 ends or hangs while quadbot trots at 0.5 m/s behind it, on the wall clock.

Loop and robot are those of tests/drivers/unitree_go/go_walk.cpp. Between them are two processes of unitree_bridge, and
DDS on the loopback. The signal comes at a phase of a stride. The rules are those of bench/devices/walk_loss.py.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robot_control.installed_files import share_file

from bench.console.process import free_port
from bench.devices.walk_loss import LEANS, LYING, PHASES, RISE_TIME, STRIDE, WalkOutcome
from bench.faults.sequence_judge import FOLD_TIME, MEAN_TIME, STANDING_SPEED

KINDS = {"bridge killed": (signal.SIGKILL, "has ended"), "bridge hung": (signal.SIGSTOP, "hangs")}
"""by kind: the signal, and words of the driver"""
DOMAIN = 60 + os.getpid() % 40
"""of DDS; programs beside this one have another one"""
LIMIT = 60.0  # s of one trial


@dataclass(frozen=True)
class BridgeLoss:
    """The bridge gets the signal of this kind at the phase `seed`/`PHASES` of a stride."""

    kind: str
    seed: int


def drive_file(path: Path) -> Path:
    """The example of a Go2 with ports and a domain of its own."""
    text = Path(share_file("config/drives/unitree_go.yaml")).read_text(encoding="utf-8")
    other, here = (free_port(socket.SOCK_DGRAM) for _ in range(2))
    own = f"  domain: {DOMAIN}\n  address: 127.0.0.1:{other}\n  port: {here}\n  has_service: false\n"
    path.write_text(re.sub(r"^unitree_go:\n", f"unitree_go:\n{own}", text, flags=re.MULTILINE), encoding="utf-8")
    return path


@contextlib.contextmanager
def bridge(program: Path, *arguments: str | Path) -> Iterator[subprocess.Popen[bytes]]:
    """A bridge, which ends with the context, also while it hangs."""
    process = subprocess.Popen([program, *arguments], stdout=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def bridge_of(build: Path) -> Path:
    """The program in this folder of the build, which needs scripts/setup --unitree."""
    return build / "devel/lib/robot_control/unitree_bridge"


def run_bridge_loss(build: Path, trial: BridgeLoss) -> WalkOutcome:
    """Runs one trial with the programs of this folder of the build.

    Raises:
        RuntimeError: the walk failed.
    """
    walk, bridges = build / "tests/drivers/go_walk", bridge_of(build)
    number, words = KINDS[trial.kind]
    times = RISE_TIME + STRIDE * trial.seed / PHASES, FOLD_TIME + MEAN_TIME
    with tempfile.TemporaryDirectory() as folder:
        driver, robot = (drive_file(Path(folder) / f"{end}.yaml") for end in ("driver", "robot"))
        with bridge(bridges, driver) as lost, bridge(bridges, robot, "--side", "robot"):
            answer = subprocess.run(
                [walk, driver, robot, str(lost.pid), str(int(number)), *map(str, times)],
                stdout=subprocess.PIPE,
                timeout=LIMIT,
                check=False,
            )
    if answer.returncode != 0:
        raise RuntimeError(f"{walk.name} ended with {answer.returncode}")
    found = json.loads(answer.stdout)
    return WalkOutcome(found["named"], found["tilt"], tuple(broken_rules(found, words)))


def broken_rules(found: dict[str, Any], words: str) -> Iterator[str]:
    """Yields the rules that the loss breaks, with what was found."""
    if found["stopped"]:
        yield f"walks until the signal: {found['stopped']}"
    if found["before"] not in ("", "encoders_lost"):
        yield f"named: {found['before']}"
    if "has lost its bridge" not in found["words"] or words not in found["words"]:
        yield f"named: {found['words']}"
    if found["tilt"] > LEANS:
        yield f"upright: {found['tilt']:.2f} rad"
    if found["speed"] > STANDING_SPEED or found["height"] > LYING:
        yield f"folds: {found['speed']:.2f} m/s at {found['height']:.2f} m"
