"""Runs one function over many items, which are seeds as a rule, and gives the outcomes in the order of the items.

The outcome of an item depends on the item alone, so a verdict does not depend on where the items run.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Protocol, TypeVar

from bench.rows import Say

Item = TypeVar("Item")
Outcome = TypeVar("Outcome")

REPORT_EVERY = 20.0
"""s between two lines of progress"""


class Runner(Protocol):
    """A place where items run."""

    def outcomes(
        self, one: Callable[[Item], Outcome], items: Sequence[Item], say: Say, chunk: int = 1
    ) -> Iterator[Outcome]:
        """Yields `one(item)` of every item, in the order of `items`.

        Args:
            one: importable by name, for other processes call it.
            items: what it is called with.
            say: receives the progress every `REPORT_EVERY` seconds.
            chunk: number of items that are sent to a process together.
        """


class Processes:
    """The processes of this machine, one per processor unless `count` says otherwise; 1: this process alone."""

    def __init__(self, count: int | None = None) -> None:
        self._count = count

    def outcomes(
        self, one: Callable[[Item], Outcome], items: Sequence[Item], say: Say, chunk: int = 1
    ) -> Iterator[Outcome]:
        """Yields outcomes as `Runner.outcomes` does."""
        if self._count == 1:
            yield from with_progress(map(one, items), len(items), say)
            return
        with multiprocessing.Pool(self._count) as pool:
            yield from with_progress(pool.imap(one, items, chunksize=chunk), len(items), say)


def with_progress(outcomes: Iterator[Outcome], total: int, say: Say) -> Iterator[Outcome]:
    """The same outcomes; every `REPORT_EVERY` s one line says how many are done and how long the rest takes."""
    began = last = time.monotonic()
    for done, outcome in enumerate(outcomes, 1):
        yield outcome
        now = time.monotonic()
        if now - last > REPORT_EVERY:
            last = now
            left = (now - began) / done * (total - done)
            say(f"{done} of {total}, {left / 60:.0f} min left")
