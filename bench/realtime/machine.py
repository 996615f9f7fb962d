"""The machine as reference and under load: cyclictest, stress-ng, /dev/cpu_dma_latency."""

from __future__ import annotations

import re
import shutil
import struct
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from robot_control.data.run_log import FloatArray

DMA_LATENCY = Path("/dev/cpu_dma_latency")
PRIORITY = 83  # LoopPriority::kDriver
CORE = 0  # robot.core
BUCKETS = 20_000  # µs


def require_programs() -> None:
    """Raises RuntimeError with the remedy where one is missing."""
    absent = [name for name in ("cyclictest", "stress-ng") if shutil.which(name) is None]
    if absent:
        raise RuntimeError(f"{' and '.join(absent)} not installed: scripts/setup --realtime")


@contextmanager
def shallow_sleep(*, asked: bool) -> Iterator[None]:
    """Keeps the processors in their shallowest idle state while the block lasts, if `asked`; needs root."""
    if not asked:
        yield
        return
    with DMA_LATENCY.open("wb", buffering=0) as file:
        file.write(struct.pack("i", 0))
        yield


@contextmanager
def load(*, asked: bool) -> Iterator[None]:
    """Processors, memory and files are busy while the block lasts, if `asked`."""
    if not asked:
        yield
        return
    words = [
        "stress-ng",
        "--quiet",
        "--cpu",
        "2",
        "--vm",
        "1",
        "--vm-bytes",
        "256M",
        "--hdd",
        "1",
        "--temp-path",
        "/tmp",
    ]
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield
    finally:
        process.terminate()
        process.wait()


def start_cyclictest(seconds: float, threads: int = 1) -> subprocess.Popen[str]:
    """Threads as the driver's: 1 kHz, absolute deadlines, same core and priority. It does not ask for shallow sleep
    itself (--laptop).
    """
    words = ["cyclictest", "-q", "-m", "--laptop", f"-t{threads}", f"-p{PRIORITY}", f"-a{CORE}", "-i1000"]
    words += [f"-h{BUCKETS}", f"-l{int(seconds * 1000)}"]
    return subprocess.Popen(words, stdout=subprocess.PIPE, text=True)


def latencies(process: subprocess.Popen[str]) -> FloatArray:
    """Its wake-up latencies, µs, whole numbers; those beyond the histogram count as its end."""
    text, _ = process.communicate()
    return parse_histogram(text)


def parse_histogram(text: str) -> FloatArray:
    """The output of cyclictest -h: lines of latency and count, then "# Histogram Overflows: N"."""
    pairs = re.findall(r"^(\d+)\s+(\d+)$", text, re.MULTILINE)
    values = np.repeat([float(each) for each, _ in pairs], [int(count) for _, count in pairs])
    overflow = re.search(r"^# Histogram Overflows:\s*(\d+)", text, re.MULTILINE)
    beyond = int(overflow[1]) if overflow else 0
    if values.size + beyond == 0:
        raise RuntimeError(f"cyclictest has measured nothing:\n{text[-500:]}")
    return np.concatenate([values, np.full(beyond, float(BUCKETS))])
