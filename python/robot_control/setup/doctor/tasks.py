"""Threads and processor times from /proc: two samples, or one since the start of the computer."""

import functools
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

from robot_control.setup.doctor.system import System

TICK = 0.01
"""s, the unit of processor times in /proc (USER_HZ)"""
SPAN = 0.4
"""s between two samples, at least"""
KTHREADD = 2


@dataclass(frozen=True)
class Task:
    """A thread, by the fields of proc_pid_stat(5)."""

    process: int
    thread: int
    name: str
    parent: int
    ticks: int
    start: int
    """Ticks after the start of the machine"""
    core: int
    priority: int
    """SCHED_FIFO and SCHED_RR, 1 … 99; 0: none"""

    @property
    def of_kernel(self) -> bool:
        """True for a thread of the kernel."""
        return KTHREADD in (self.parent, self.process)


@dataclass(frozen=True)
class Sample:
    """All threads, and the times of all cores, at one time."""

    taken: float
    tasks: dict[int, Task] = field(default_factory=dict)
    cores: dict[int, list[int]] = field(default_factory=dict)
    """user, nice, system, idle, iowait, irq, softirq, steal; ticks"""


def _task(system: System, name: str) -> Task | None:
    text = system.text(name)
    if text is None or ")" not in text:
        return None
    begin, _, rest = text.rpartition(")")
    fields = rest.split()  # the first one is field 3, state
    if len(fields) < 39:
        return None
    _, _, process, _, thread, _ = name.split("/")
    parent, user, system_time, start, core, priority = (int(fields[at]) for at in (1, 11, 12, 19, 36, 37))
    called = begin.partition("(")[2]
    return Task(int(process), int(thread), called, parent, user + system_time, start, core, priority)


def sample(system: System) -> Sample:
    """The state now."""
    tasks = (_task(system, name) for name in system.names("proc/[0-9]*/task/[0-9]*/stat"))
    cores = {}
    for line in (system.text("proc/stat") or "").splitlines():
        name, *times = line.split()
        if name.startswith("cpu") and name[3:].isdigit():
            cores[int(name[3:])] = [int(value) for value in times[:8]]
    return Sample(time.monotonic(), {task.thread: task for task in tasks if task}, cores)


@dataclass(frozen=True)
class Load:
    """The work between two samples; of a recorded machine, since its start."""

    first: Sample | None
    second: Sample
    uptime: float

    def busy(self) -> Iterator[tuple[Task, float]]:
        """Every thread with its share of a core."""
        for thread, task in self.second.tasks.items():
            before = self.first.tasks.get(thread) if self.first else None
            if self.first and before is None:
                continue
            ticks = task.ticks - (before.ticks if before else 0)
            span = self.second.taken - self.first.taken if self.first else self.uptime - task.start * TICK
            if span > 0:
                yield task, ticks * TICK / span

    def steal(self, core: int) -> float | None:
        """The share of its time that a hypervisor gave to other machines; None if it is not counted."""
        now = self.second.cores.get(core)
        if now is None or len(now) < 8:
            return None
        before = self.first.cores.get(core, [0] * 8) if self.first else [0] * 8
        spent = [after - earlier for after, earlier in zip(now, before, strict=True)]
        return spent[7] / sum(spent) if sum(spent) > 0 else 0.0


@functools.cache
def first_sample(system: System) -> Sample | None:
    """The state at the first call; a recorded machine has none."""
    return sample(system) if system.live else None


@functools.cache
def load(system: System) -> Load:
    """The load since the first sample; waits until SPAN has passed."""
    first = first_sample(system)
    if first is not None:
        time.sleep(max(0.0, first.taken + SPAN - time.monotonic()))
    return Load(first, sample(system), system.uptime or 0.0)
