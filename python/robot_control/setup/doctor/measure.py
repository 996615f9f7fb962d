"""--measure: the wake-up latency of the real nodes beside cyclictest's, idle and under load.

A pair is one run of the simulated robot and one of cyclictest, equal in length, period, core, priority and limit of
idle states. Pairs follow each other in alternating order, so that a slow change of the machine meets both.
"""

import contextlib
import math
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from statistics import median

from robot_control.data.loop_timing import loop_timing
from robot_control.data.run_log import LogError, read_log
from robot_control.setup.doctor.finding import Finding, note, ok, unseen, warning
from robot_control.setup.doctor.memory import MAX_PRIORITY
from robot_control.setup.doctor.report import Row
from robot_control.setup.doctor.system import CAP_SYS_NICE, System
from robot_control.ui.child import Child

SECONDS = 5
"""s of one run"""
START = 3
"""s at the beginning of a run of the nodes in which other programs of the launch are loaded; not measured"""
MIN_PAIRS = 6
"""Pairs from which the interval of a median has a confidence of 95 %; fewer judge nothing"""
PROGRAMS = {"cyclictest": "rt-tests", "stress-ng": "stress-ng", "roslaunch": "python3-roslaunch"}
"""Program → its package of Debian"""
MAX_RATIO = 1.3
"""The nodes' p99 divided by cyclictest's; both only sleep until a deadline."""
MAX_SHARE = 0.2
"""A share of the period: a wake-up that is later leaves too little of it for the chain."""
LONGEST = 20_000
"""µs, of the histogram"""
START_LIMIT = 240.0
"""s for the start of the nodes, and for their end; more than 98 s were seen at a load of 18 on two cores"""


class MeasureError(RuntimeError):
    """The machine cannot be measured; the message names the reason."""


@dataclass(frozen=True)
class Pair:
    """The 99th percentiles of the wake-up latency in one pair, µs."""

    nodes: float
    cyclictest: float


def require_programs() -> None:
    """Raises MeasureError with every program that is missing, and its package."""
    missing = [name for name in PROGRAMS if shutil.which(name, path=f"{os.environ['PATH']}:/usr/sbin") is None]
    if missing:
        packages = " ".join(PROGRAMS[name] for name in missing)
        what = f"--measure needs {', '.join(missing)}: scripts/setup --realtime, or apt-get install {packages}"
        raise MeasureError(f"{what}; source install/setup.bash for roslaunch")


def measure(system: System, pairs: int) -> list[Row]:
    """The findings, idle and under load."""
    require_programs()
    rows = []
    for load, why in (("idle", "the best that this computer can do"), ("load", "what other programs cost")):
        measured = []
        for number in range(pairs):
            print(f"doctor.py: {load}, pair {number + 1} of {pairs}", file=sys.stderr)
            measured.append(_pair(system, loaded=load == "load", nodes_first=number % 2 == 0))
        finding = judge(measured, 1e6 / float(system.robot.get("rate", 1000)))
        rows.append(Row("measured", f"wake_up_{load}", why, finding))
    return rows


def judge(pairs: Sequence[Pair], period: float) -> Finding:
    """Compares the p99 of both; `period`: of the loop, µs."""
    if not pairs:
        return unseen("nothing was measured")
    ratios = sorted(pair.nodes / pair.cyclictest for pair in pairs)
    lowest, highest = interval(ratios)
    own, reference = (median(values) for values in zip(*((p.nodes, p.cyclictest) for p in pairs), strict=True))
    what = f"p99 {own:.0f} µs, cyclictest {reference:.0f} µs, ratio {median(ratios):.2f}"
    value = f"{what} ({lowest:.2f} … {highest:.2f}, {len(pairs)} pairs of {SECONDS} s)"
    if reference > MAX_SHARE * period:
        return warning(value, "the computer itself is late: see the other findings; docs/realtime.md has the steps")
    if lowest > MAX_RATIO and len(pairs) < MIN_PAIRS:
        return note(value, f"measure {MIN_PAIRS} pairs or more, which can judge the nodes")
    if lowest > MAX_RATIO:
        return warning(
            value,
            "the nodes are later than the computer: see realtime_priority and memory_lock above, and docs/realtime.md",
        )
    if own > MAX_SHARE * period:
        return note(value, "lower robot.rate, or follow docs/realtime.md")
    return ok(value)


def interval(ordered: Sequence[float]) -> tuple[float, float]:
    """Bounds of the median with at least 95 % confidence by order statistics; the range of fewer than six values."""
    count = len(ordered)
    tails = accumulate(math.comb(count, number) / 2**count for number in range(count))
    low = max(sum(tail <= 0.025 for tail in tails) - 1, 0)
    return ordered[low], ordered[count - 1 - low]


def _pair(system: System, *, loaded: bool, nodes_first: bool) -> Pair:
    first, second = (_nodes, _cyclictest) if nodes_first else (_cyclictest, _nodes)
    latencies = first(system, loaded=loaded), second(system, loaded=loaded)
    return Pair(*latencies[:: 1 if nodes_first else -1])


def _cyclictest(system: System, *, loaded: bool) -> float:
    granted = system.may(CAP_SYS_NICE) or (system.limit("Max realtime priority") or 0) >= MAX_PRIORITY
    wanted = system.robot.get("cpu_dma_latency")
    command = [
        "cyclictest",
        *(f"-p{MAX_PRIORITY}" if granted else "--policy=other", "-q", f"-D{SECONDS}", f"-h{LONGEST}"),
        *([] if system.core is None else [f"-a{system.core}"]),
        f"-i{1e6 / float(system.robot.get('rate', 1000)):.0f}",
        *(["--default-system"] if wanted is None else [f"--latency={wanted:.0f}"]),
    ]
    with _stressed(system, loaded=loaded):
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS + 30, check=False)
    latency = percentile99(done.stdout)
    if done.returncode or latency is None:
        raise MeasureError(f"cyclictest failed: {(done.stderr or done.stdout).strip()[-300:]}")
    return latency


def percentile99(histogram: str) -> float | None:
    """The 99th percentile of a histogram of cyclictest, µs; None if it is empty."""
    bins = [(int(late), int(count)) for late, count in re.findall(r"^(\d+)\s+(\d+)\s*$", histogram, re.MULTILINE)]
    bins += [(LONGEST, int(count)) for count in re.findall(r"^# Histogram Overflows: *(\d+)", histogram, re.MULTILINE)]
    total, passed = sum(count for _, count in bins), 0
    for late, count in bins:
        passed += count
        if passed >= 0.99 * total > 0:
            return float(max(late, 1))
    return None


def _nodes(system: System, *, loaded: bool) -> float:
    """The p99 of the driver's wake-up in one run of the simulated robot, on a master of its own."""
    rate = float(system.robot.get("rate", 1000))
    settings = {
        key: system.robot[key] for key in ("core", "realtime", "rate", "cpu_dma_latency") if key in system.robot
    }
    lines = "".join(f"  {key}: {value}\n" for key, value in settings.items() if value is not None)
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = str(probe.getsockname()[1])
    with tempfile.TemporaryDirectory(prefix="doctor-") as name:
        folder = Path(name)
        (folder / "measure.yaml").write_text(f"robot:\n{lines}telemetry: {{record: always}}\n")
        command = ["roslaunch", "-p", port, "robot_control", "sim.launch", "telemetry:=true", "black_box:=false"]
        command += [f"params:={folder}/measure.yaml", f"out:={folder}", f"cycles:={(START + SECONDS) * rate:.0f}"]
        values = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_HOME": name}
        launch = Child(command, folder / "launch.log", values)
        try:
            _run_out(system, launch, folder, loaded=loaded)
            log = read_log(folder / "run.bag")
        except (OSError, LogError, TimeoutError) as error:
            said = launch.output.read_text(errors="replace")[-500:]
            raise MeasureError(f"the nodes left no log: {error}; they said: {said}") from None
        finally:
            launch.end()
        return loop_timing({name: values[log["cycle"] >= START * rate] for name, values in log.items()}).wake_up.p99


def _run_out(system: System, launch: Child, folder: Path, *, loaded: bool) -> None:
    """Waits for the end of the nodes; the load begins with their log, so that it does not delay their start. Raises
    TimeoutError.
    """
    end = time.monotonic() + START_LIMIT
    while not any(folder.glob("run*.bag*")) and launch.running and time.monotonic() < end:
        time.sleep(0.1)
    with _stressed(system, loaded=loaded):
        if time.monotonic() > end or not launch.wait(START + SECONDS + START_LIMIT):
            raise TimeoutError("roslaunch does not end")


@contextlib.contextmanager
def _stressed(system: System, *, loaded: bool) -> Iterator[None]:
    """Work on every core, memory and disk while the block runs, if it is `loaded`."""
    if not loaded:
        yield
        return
    workers = str(len(os.sched_getaffinity(0)) if system.live else 1)
    command = ["stress-ng", "--quiet", "--cpu", workers, "--vm", "1", "--vm-bytes", "64M", "--hdd", "1"]
    with tempfile.TemporaryDirectory(prefix="doctor-") as folder:
        stress = subprocess.Popen([*command, "--hdd-bytes", "64M", "--temp-path", folder])
        try:
            yield
        finally:
            stress.terminate()
            stress.wait()
