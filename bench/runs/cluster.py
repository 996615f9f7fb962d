"""Runs seeds with the workers of a Dask cluster (Debian: python3-distributed).

Every worker runs one chunk of items at a time. Each chunk carries the `Identity` of this process, which the worker
compares with its own before it runs the chunk. A worker that differs is refused by name and gets no more chunks. The
chunk of a worker that disappears runs again on another one. Workers that join later are used as well.

A worker is a `dask-worker ADDRESS` in the environment of scripts/bench: install/setup.bash sourced, tests/ on
PYTHONPATH.
"""

from __future__ import annotations

import queue
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from distributed import Client, Future, Security
from distributed.client import CancelledError
from distributed.scheduler import KilledWorker

from bench.rows import Say
from bench.runs.address import check_address
from bench.runs.identity import UNKNOWN, Identity, identity
from bench.runs.runner import Item, Outcome, with_progress

LOOK_EVERY = 0.5
"""s between two looks at the list of workers"""
CONNECTING = 20.0
"""s for the scheduler to answer"""
GATHERING = 20.0
"""s for a worker to hand over the outcomes of a chunk that has ended; after it they are lost"""
WITHOUT_WORKER = 60.0
"""s without any worker that may be used; then the run ends"""
ATTEMPTS = 3
"""Workers that a chunk may lose before the chunk itself is taken for the cause"""


class ClusterError(RuntimeError):
    """The cluster cannot be used any more, or at all; the message names the reason."""


class DifferentWorkerError(RuntimeError):
    """The worker differs from this process; the message says in what."""


def run_chunk(expected: Identity, one: Callable[[Item], Outcome], items: Sequence[Item]) -> list[Outcome]:
    """Runs on the worker.

    Raises:
        DifferentWorkerError: its identity is not the expected one.
    """
    difference = expected.difference(identity())
    if difference:
        raise DifferentWorkerError(difference)
    return [one(item) for item in items]


@dataclass
class _Chunk:
    number: int
    items: Sequence[Any]
    lost: int = 0  # workers that disappeared while they ran it


@dataclass
class _Work:
    """One call of `outcomes`."""

    one: Callable[[Any], Any]
    say: Say
    open: deque[_Chunk]
    running: dict[str, tuple[_Chunk, Future]] = field(default_factory=dict)  # by the worker's address
    ready: queue.Queue[tuple[str, Future]] = field(default_factory=queue.Queue)


class Cluster:
    """The workers of the scheduler at `address`, used as a context.

    `tls`: folder with ca.pem, cert.pem and key.pem; None stands for the configuration of Dask.

    Raises:
        ValueError: the address is refused.
        ClusterError: the scheduler does not answer, or the commit here is unknown.
    """

    def __init__(self, address: str, *, insecure: bool = False, tls: Path | None = None) -> None:
        check_address(address, insecure=insecure)
        self._expected = identity()
        if self._expected.commit == UNKNOWN:
            raise ClusterError("the sources here are no git checkout: workers could not be compared with them")
        try:
            self._client = Client(address, timeout=CONNECTING, security=_security(address, tls))
        except (OSError, TypeError, ValueError) as error:
            raise ClusterError(f"no scheduler at {address}: {error}") from None
        self._refused: set[str] = set()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._client.close()

    def outcomes(
        self, one: Callable[[Item], Outcome], items: Sequence[Item], say: Say, chunk: int = 1
    ) -> Iterator[Outcome]:
        """Yields outcomes as `Runner.outcomes` does.

        Raises:
            ClusterError: there is no worker left, or one chunk ended several.
        """
        chunks = deque(_Chunk(number, items[at : at + chunk]) for number, at in enumerate(range(0, len(items), chunk)))
        yield from with_progress(self._in_order(_Work(one, say, chunks)), len(items), say)

    def _in_order(self, work: _Work) -> Iterator[Any]:
        """Outcomes in the order of the chunks; those of later chunks wait."""
        count, following = len(work.open), 0
        done: dict[int, list[Any]] = {}
        used = looked = time.monotonic()
        self._assign(work)
        while following < count:
            with suppress(queue.Empty):
                done |= self._take(work, *work.ready.get(timeout=LOOK_EVERY))
            now = time.monotonic()
            if work.open or now - looked > LOOK_EVERY:
                looked = now
                self._assign(work)
            used = now if work.running else used
            if now - used > WITHOUT_WORKER:
                raise ClusterError(f"no worker for {WITHOUT_WORKER:g} s; {len(self._refused)} were refused")
            while following in done:
                yield from done.pop(following)
                following += 1

    def _assign(self, work: _Work) -> None:
        """Takes the chunks of lost workers back and gives each idle worker one."""
        present = set(self._client.scheduler_info()["workers"])
        for worker in [worker for worker in work.running if worker not in present]:
            chunk, future = work.running.pop(worker)
            future.cancel()
            self._repeat(work, worker, chunk)
        for worker in sorted(present - self._refused - set(work.running)):
            if not work.open:
                return
            chunk = work.open.popleft()
            task = (run_chunk, self._expected, work.one, chunk.items)
            future = self._client.submit(*task, workers=[worker], allow_other_workers=False, pure=False)
            work.running[worker] = (chunk, future)
            future.add_done_callback(lambda ended, worker=worker: work.ready.put((worker, ended)))

    def _take(self, work: _Work, worker: str, future: Future) -> dict[int, list[Any]]:
        """The outcomes of a chunk that has ended, by its number; none if it has to run again."""
        if worker not in work.running or work.running[worker][1] is not future:
            return {}  # it was taken back before
        chunk, _ = work.running.pop(worker)
        try:
            if future.status == "finished":
                return {chunk.number: future.result(timeout=GATHERING)}
            error = future.exception() if future.status == "error" else None
        except (OSError, TimeoutError, CancelledError):  # the worker disappeared with its outcomes
            error = None
        if isinstance(error, (DifferentWorkerError, ImportError)):
            self._refused.add(worker)
            work.say(f"worker {worker} is refused: {error}")
            work.open.appendleft(chunk)
        elif error is None or isinstance(error, KilledWorker):
            self._repeat(work, worker, chunk)
        else:
            raise error
        return {}

    @staticmethod
    def _repeat(work: _Work, worker: str, chunk: _Chunk) -> None:
        chunk.lost += 1
        if chunk.lost >= ATTEMPTS:
            raise ClusterError(f"{chunk.lost} workers were lost while they ran {list(chunk.items)}")
        work.say(f"worker {worker} is lost: its {len(chunk.items)} are repeated")
        work.open.appendleft(chunk)


def _security(address: str, tls: Path | None) -> Security:
    if not address.startswith("tls:"):
        return Security()
    if tls is None:
        return Security(require_encryption=True)
    return Security(
        require_encryption=True,
        tls_ca_file=str(tls / "ca.pem"),
        tls_client_cert=str(tls / "cert.pem"),
        tls_client_key=str(tls / "key.pem"),
    )
