"""`scripts/bench data_return`: a bad link with kills of both sides, files that change meanwhile, cost for the loop."""

from __future__ import annotations

import hashlib
import os
import random
import statistics
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from robot_control.data.data_return.parts import MANIFEST, GapError, put_together, read_manifest

from bench.data_return.changes import Changes
from bench.data_return.server import KINDS, missing
from bench.data_return.system import System
from bench.realtime.chain import CHAIN, ros_master
from bench.realtime.loops import FREE_WHEELS, loop_for
from bench.rows import Result, Row, Say, bounded, judged

FILES, BYTES = 200, 2_000_000_000
LOSSES = {"cut": 25, "stall": 25, "data_return killed": 10, "far side killed": 10}
"""at random moments of the whole upload; a share of it has as many per byte, but one of each at least"""
LIMIT = 3600.0
"""s for one upload"""
LINK = 20.0
"""MB/s, so that the losses come within parts"""
STALLS = (1.0, 5.0, 25.0)
"""s; the last one is longer than rclone waits"""
BANDWIDTH = 2.0
"""MB/s"""
CHANGES = 1000
"""of files, each within a call of the sender's"""
BLOCKS, SECONDS = 7, 15.0
"""of the loop with and without an upload, alternating"""


def bench(parts: Sequence[str], first: int, share: float, programs: Path, say: Say) -> Result:
    """The rows of these parts, and whether all bounds hold.

    Raises:
        RuntimeError: rclone is missing.
    """
    if why := missing():
        raise RuntimeError(why)
    rows: list[Row] = []
    with ros_master() as environment:
        for kind in KINDS if "upload" in parts else ():
            rows += _upload(kind, first, share, environment, say)
        if "cost" in parts:
            rows += _cost(environment, programs, say)
    for hashes in (True, False) if "changes" in parts else ():
        rows += _changes(first, share, say, hashes=hashes)
    return judged("data_return", rows)


class _Files:
    """Random files of all kinds, one of twenty compressible; all that is known of what becomes of them."""

    def __init__(self, logs: Path, share: float, source: random.Random) -> None:
        count = max(10, round(FILES * share))
        weights = [source.uniform(0.5, 1.5) for _ in range(count)]
        self._logs, self._sums, self.count = logs, dict[str, str](), count
        self._returned = set[str]()
        self.wrong: list[str] = []
        for number, weight in enumerate(weights):
            size = round(BYTES * share * weight / sum(weights))
            content = source.randbytes(size) if number % 20 else source.randbytes(1000) * (size // 1000)
            kind = ("black_box/stop.{}.bag", "trial/run.{}.html")[number % 2] if number % 10 < 2 else "run.{}.bag"
            path = logs / kind.format(number)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
            os.utime(path, (1e9 + number, 1e9 + number))
            self._sums[str(path.relative_to(logs))] = hashlib.sha256(content).hexdigest()

    def check(self, far: Path) -> None:
        """Each file that is no more on the robot must be whole on the far side."""
        gone = {name for name in self._sums if not (self._logs / name).exists()} - self._returned
        if gone:
            self.wrong += [f"{name} was deleted early" for name in gone if not self._whole(far, name)]
            self._returned |= gone

    def not_whole(self, far: Path) -> list[str]:
        """Names of the files that are not on the far side, byte by byte."""
        return [name for name in self._sums if not self._whole(far, name)]

    def _whole(self, far: Path, name: str) -> bool:
        for path in far.rglob(f"*-{Path(name).name}/{MANIFEST}"):
            with tempfile.TemporaryFile() as file:
                try:
                    content = put_together(lambda part, path=path: (path.parent / part).read_bytes(), file)  # type: ignore[misc]
                except GapError:
                    return False
                file.seek(0)
                if content["name"] == name:
                    return hashlib.file_digest(file, "sha256").hexdigest() == self._sums[name]
        return False

    @staticmethod
    def payload(far: Path) -> int:
        """Bytes of all parts and manifests."""
        manifests = [path.read_bytes() for path in far.rglob(MANIFEST)]
        return sum(len(each) + sum(part.size for part in read_manifest(each)["parts"]) for each in manifests)


def _upload(kind: str, seed: int, share: float, environment: dict[str, str], say: Say) -> list[Row]:
    source = random.Random(seed)
    with System(kind, environment, bandwidth=LINK, local_quota=BYTES * share / 2e9) as system:
        files = _Files(system.logs, share, source)
        losses = [name for name, count in LOSSES.items() for _ in range(max(1, round(count * share)))]
        source.shuffle(losses)
        due = sorted(source.uniform(0.02, 0.9) * BYTES * share for _ in losses)
        protocol, before = system.protocol(), system.cable.sent
        began = time.monotonic()
        system.begin()
        while not system.done():
            if time.monotonic() - began > LIMIT:
                say(f"{kind}: not done within {LIMIT:.0f} s: {system.last_words()}")
                break
            if due and system.cable.sent - before > due[0]:
                due.pop(0)
                system.lose(losses[len(due)], source.choice(STALLS))
            files.check(system.far)
            time.sleep(0.05)
        seconds = time.monotonic() - began
        files.check(system.far)
        bad = files.not_whole(system.far)
        for each in (*files.wrong, *bad):
            say(f"{kind}: {each}")
        twice = 100 * ((system.cable.sent - before) / protocol / max(1, files.payload(system.far)) - 1)
    say(f"{kind}: {files.count} files, {len(losses)} losses, {seconds:.0f} s")
    return [
        bounded(f"{kind}: files not whole on the far side", len(bad), f"of {files.count}", 0),
        bounded(f"{kind}: files deleted early", len(files.wrong), f"with {len(losses) - len(due)} losses", 0),
        bounded(f"{kind}: sent twice", twice, f"%; protocol {100 * (protocol - 1):.1f} %", 10.0),
    ]


def _changes(first: int, share: float, say: Say, *, hashes: bool) -> list[Row]:
    kind = f"changes, remote {'with' if hashes else 'without'} hashes"
    count = max(1, round(CHANGES * share))
    with tempfile.TemporaryDirectory(prefix="data-return-bench-") as folder:
        changes = Changes(Path(folder), first, hashes=hashes)
        left = changes.run(count)
    for name in changes.wrong:
        say(f"{kind}: {name} was deleted, and the remote lacks it")
    what = f"of {changes.deleted}, with {count} changes"
    return [
        bounded(f"{kind}: files deleted that it lacks", len(changes.wrong), what, 0),
        bounded(f"{kind}: files that did not return", left, what, 0),
    ]


def _cost(environment: dict[str, str], programs: Path, say: Say) -> list[Row]:
    """The far side has the lowest priority, too: on a robot it is another machine."""
    alone, beside, rates = [], [], []
    with System("sftp", environment, bandwidth=BANDWIDTH, prefix=("chrt", "--idle", "0")) as system:
        (system.logs / "run.1.bag").write_bytes(4 * random.Random(1).randbytes(100_000_000))
        os.utime(system.logs / "run.1.bag", (1e9, 1e9))
        for number in range(BLOCKS):
            say(f"cost: block {number + 1} of {BLOCKS}")
            alone.append(_worst_percent(programs))
            system.begin()
            system.await_upload()
            sent, began = system.cable.sent, time.monotonic()
            beside.append(_worst_percent(programs))
            rates.append((system.cable.sent - sent) / (time.monotonic() - began) / 1e6)
            system.end_program()
    ratio = statistics.median(b / a for a, b in zip(alone, beside, strict=True))
    return [
        bounded("chain, p99, beside an upload", statistics.median(beside), "µs", 1.1 * statistics.median(alone)),
        bounded("chain, p99, to that without an upload", ratio, "median of the ratios", 1.1),
        bounded("rate of an upload, highest", max(rates), f"MB/s of {BANDWIDTH:g}", 1.1 * BANDWIDTH),
        bounded("lowest rate of an upload", min(rates), f"MB/s of {BANDWIDTH:g}", 0.9 * BANDWIDTH),
    ]


def _worst_percent(programs: Path) -> float:
    rows = loop_for(SECONDS, programs, FREE_WHEELS)
    begin, end = CHAIN
    return float(np.nanpercentile(rows[end] - rows[begin], 99)) / 1000
