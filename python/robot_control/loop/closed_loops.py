"""Many closed loops at once, in threads, for learning and planning.

loops = ClosedLoops(64, threads=2)
values = loops.step(20, commands, ("truth_linear", "truth_angular"))  # (64, 2), of the last of 20 cycles
"""

from __future__ import annotations  # help() shows the names of the types

import os
from collections.abc import Sequence
from operator import index
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robot_control._robot_control import ClosedLoop as _ClosedLoop
from robot_control._robot_control import ClosedLoops as _ClosedLoops
from robot_control._robot_control import Columns
from robot_control.loop.closed_loop import ClosedLoop, File, Params, given_layers

_KEPT = ("_path", "_values", "_seeds", "_threads")
"""Attributes that a copy shares and a pickle holds."""


class ClosedLoops:
    """Robots with the same parameters and different seeds, each with its control loop, in virtual time.

        loops = ClosedLoops(64, threads=2, seed=0)
        loops.step(20, np.full((64, 2), (0.5, 0.2)), ("truth_linear",))  # array of shape (64, 1)
        loops[3].inject_fault("left_encoder", "stuck")                  # one loop, as a ClosedLoop

    Loop i gives the bits of `ClosedLoop(seed=seed + i)` with the same calls, whatever the number of threads. A pickle
    holds the arguments and the seeds: it makes the same loops again, in any process.

    Args:
        n: number of loops.
        threads: that run them, the calling one included; None: one per processor of this process.
        seed: of the first loop, or one per loop.
        params: as of `ClosedLoop`, as are `urdf`, `scene` and `drives`.

    Raises:
        ValueError: no loop, no thread, or not one seed per loop. Beside it the errors of `ClosedLoop`.
    """

    def __init__(
        self,
        n: int,
        threads: int | None = None,
        seed: int | Sequence[int] = 0,
        *,
        params: Params = None,
        urdf: File | None = None,
        scene: File | None = None,
        drives: File | None = None,
    ) -> None:
        """Takes the arguments above."""
        self._path, self._values = given_layers(params, urdf, scene, drives)
        self._threads = len(os.sched_getaffinity(0)) if threads is None else threads
        self._seeds = _seeds(seed, n)
        self._begin()

    def _begin(self) -> None:
        self._loops = _ClosedLoops(self._path, self._values, self._seeds, self._threads)
        self._views: dict[int, _LoopOfMany] = {}
        self._columns: dict[tuple[str, ...], Columns] = {}

    def step(self, cycles: int, commands: ArrayLike | None = None, columns: Sequence[str] = ()) -> NDArray[np.float64]:
        """Runs `cycles` cycles of every loop. Other Python threads run meanwhile.

        Args:
            cycles: 0 or more; 0 reads the last cycle again
            commands: array of shape (n, 2), linear m/s and angular rad/s, or (n, 3), linear, lateral and angular:
                each row arrives in the first cycle as a message on cmd_vel, and times out like it. NaN sends nothing
                to that loop, None to none.
            columns: names of columns of the log, as in `units`

        Returns:
            Values of the columns in the last cycle, shape (n, len(columns)); NaN where a node published nothing.

        Raises:
            ValueError: another shape, or an unknown column.
        """
        return self._loops.step(cycles, commands, self._chosen(columns))

    def _chosen(self, names: Sequence[str]) -> Columns:
        key = tuple(names)
        if key not in self._columns:
            self._columns[key] = self._loops.loop(0).choose(key)
        return self._columns[key]

    def reset(self, seeds: Sequence[int], which: Sequence[int] | None = None) -> None:
        """Makes loops again, each as `ClosedLoop(seed=...)`; `which` are their numbers, None: all."""
        chosen = range(len(self)) if which is None else [self._checked(i) for i in which]
        for i, seed in zip(chosen, seeds, strict=True):
            self._seeds[i] = index(seed)
        self._loops.reset(list(chosen), [self._seeds[i] for i in chosen])
        for i in set(self._views).intersection(chosen):
            self._views[i].follow(self._loops.loop(i), self._seeds[i])

    def clone(self, which: Sequence[int] | None = None, threads: int | None = None) -> ClosedLoops:
        """Copies of these loops in the same state, which from now on give the same bits.

        Args:
            which: numbers of the loops to copy, one more than once where several ways into the future are tried;
                None: each once
            threads: None: as many as here

        Raises:
            DriverError: simulated drives (`drives`) cannot be copied.
        """
        chosen = list(range(len(self))) if which is None else [self._checked(i) for i in which]
        threads = self._threads if threads is None else threads
        kept = {name: self.__dict__[name] for name in (*_KEPT, "_columns")}
        kept |= {"_seeds": [self._seeds[i] for i in chosen], "_threads": threads, "_views": {}}
        copy = ClosedLoops.__new__(ClosedLoops)
        copy.__dict__.update(kept, _loops=self._loops.clone(chosen, threads))
        return copy

    def __copy__(self) -> ClosedLoops:
        return self.clone()

    def __deepcopy__(self, _memo: dict[int, Any]) -> ClosedLoops:
        return self.clone()

    def __getstate__(self) -> dict[str, Any]:
        """The arguments and the seeds.

        Raises:
            TypeError: a loop was used since its start.
        """
        if not all(self._loops.loop(i).fresh for i in range(len(self))):
            raise TypeError(
                "ClosedLoops that have run cannot be pickled: a pickle contains only their arguments and their seeds. "
                "Pickle them before the first call or after reset(seeds); within this process copy them by clone()"
            )
        return {name: self.__dict__[name] for name in _KEPT}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._begin()

    def __len__(self) -> int:
        return len(self._seeds)

    def __getitem__(self, i: int) -> ClosedLoop:
        """Loop i, to be driven, stopped, broken or read by itself between two steps."""
        i = self._checked(i)
        if i not in self._views:
            self._views[i] = _LoopOfMany(self, i, (self._path, self._values), self._loops.loop(i))
        return self._views[i]

    def _checked(self, i: int) -> int:
        if not -len(self) <= i < len(self):
            raise IndexError(f"there is no loop {i}; there are {len(self)}")
        return i % len(self)

    @property
    def seeds(self) -> tuple[int, ...]:
        """Seed of each loop."""
        return tuple(self._seeds)

    @property
    def threads(self) -> int:
        """Threads that run the loops, the calling one included."""
        return self._threads

    @property
    def period(self) -> float:
        """Duration [s] of a cycle."""
        return self[0].period

    @property
    def units(self) -> dict[str, str]:
        """As of `ClosedLoop`."""
        return self[0].units


class _LoopOfMany(ClosedLoop):
    """One of many loops, which `reset(seed)` makes again in its place."""

    def __init__(self, loops: ClosedLoops, i: int, layers: tuple[str, list[Any]], loop: _ClosedLoop) -> None:
        self._many, self._i = loops, i
        self._path, self._values = layers
        self._paused = self._running = False
        self._columns = {}
        self.follow(loop, loops.seeds[i])

    def follow(self, loop: _ClosedLoop, seed: int) -> None:
        """The loop in this place is `loop` from now on."""
        self._loop, self._seed, self._paused = loop, seed, False

    def _new_loop(self, seed: int) -> _ClosedLoop:
        self._many.reset([seed], [self._i])
        return self._loop

    def __reduce__(self) -> tuple[Any, ...]:
        """A pickle makes a ClosedLoop of its own."""
        return ClosedLoop.__new__, (ClosedLoop,), self.__getstate__()


def _seeds(seed: int | Sequence[int], n: int) -> list[int]:
    seeds = [index(seed) + i for i in range(n)] if not isinstance(seed, Sequence) else [index(one) for one in seed]
    if len(seeds) != n:
        raise ValueError(f"there are {len(seeds)} seeds for {n} loops")
    return seeds
