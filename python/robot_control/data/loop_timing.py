"""Measures how punctual the loop was. It is reported, never judged: the machine may be shared."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from robot_control.data.run_log import FloatArray, Log


@dataclass(frozen=True)
class Distribution:
    """Distribution of a duration, µs."""

    p50: float
    p99: float
    max: float


@dataclass(frozen=True)
class Latency:
    """Time from one stamp of a cycle to another; an empty `begin` stands for that of the cycle before."""

    name: str
    meaning: str
    begin: str = ""
    end: str = ""


def _published(begin: str, end: str) -> Latency:
    meaning = f"from the published {begin} to the published {end}"
    return Latency(f"{begin}_to_{end}", meaning, f"{begin}_published_ns", f"{end}_published_ns")


WOKE, COMMANDED = "driver_woke_ns", "command_published_ns"
PERIOD = Latency("period", "from one wake-up of the driver to the next")
WAKE_UP = Latency("wake_up", "from the driver's deadline to its wake-up")
TO_COMMAND = Latency("sensors_to_command", "from the driver's wake-up to the published command", WOKE, COMMANDED)
CHAIN = (_published("sensors", "state"), _published("state", "command"), _published("sensors", "permit"))
LATENCIES = (PERIOD, WAKE_UP, *CHAIN, TO_COMMAND)


@dataclass(frozen=True)
class LoopTiming:
    """Timing of one wall-clock run. A deadline is missed when a tick finds no fresh command or permit, or ends late."""

    period: Distribution
    """From one wake-up of the driver to the next."""
    wake_up: Distribution
    """From the driver's deadline to its wake-up."""
    sensors_to_command: Distribution
    """From the driver's wake-up to the published command."""
    cycles: int
    held: int
    """Ticks k on a command of cycle k-4 … k-2."""
    missed: int
    """Ticks braked for want of a command."""
    late_permits: int
    overruns: int
    """Ticks that ended after the next deadline."""
    slipped: float
    """s by which the simulated plant fell behind the wall clock."""


def loop_timing(log: Log) -> LoopTiming:
    """Reads the columns of kind kTiming, which only wall-clock runs have, and the gate's counters."""
    log = while_all_ran(log)
    period, wake_up, to_command = (distribution(durations_ns(log, each)) for each in (PERIOD, WAKE_UP, TO_COMMAND))
    return LoopTiming(
        period=period,
        wake_up=wake_up,
        sensors_to_command=to_command,
        cycles=int(np.nanmax(log["cycle"]) + 1),
        held=_count(log["held"]),
        missed=_count(log["missed"]),
        late_permits=_count(log["late_permits"]),
        overruns=_count(log["overruns"]),
        slipped=_count(log["slipped_ns"]) / 1e9,
    )


def durations_ns(log: Log, latency: Latency) -> FloatArray:
    """Durations by row of the log; NaN where a cycle does not hold them."""
    unknown = np.full(log["time"].shape, np.nan)
    if not np.any(np.nan_to_num(log.get(COMMANDED, unknown))):  # a loop in one process reads no clock
        return unknown
    # The wake-up is logged relative to the time at which the cycle was due: its stamp, later by what has slipped so
    # far. The tick that slips begins the new grid itself, and was late by what slipped in it.
    woke, slipped = log.get(WOKE, unknown), np.diff(log.get("slipped_ns", unknown), prepend=np.nan)
    duration: FloatArray
    if latency is WAKE_UP:
        duration = woke + slipped
    elif latency is PERIOD:
        duration = np.diff(log.get("stamp_ns", unknown), prepend=np.nan) + slipped + np.diff(woke, prepend=np.nan)
        duration[np.diff(log["cycle"], prepend=np.nan) != 1] = np.nan
    else:
        duration = log.get(latency.end, unknown) - log.get(latency.begin, unknown)
    return duration


def while_all_ran(log: Log) -> Log:
    """Without the tail in which the nodes end one after the other: no deadline is missed there."""
    together = ~np.isnan(log[COMMANDED]) & ~np.isnan(log["permit_published_ns"])
    if not together.any():
        return log
    rows = int(np.flatnonzero(together)[-1]) + 1
    return {name: values[:rows] for name, values in log.items()}


def distribution(nanoseconds: FloatArray) -> Distribution:
    """Median, 99th percentile and maximum of the values that are not NaN."""
    known = nanoseconds[~np.isnan(nanoseconds)]
    if known.size == 0:
        return Distribution(np.nan, np.nan, np.nan)
    p50, p99, top = np.percentile(known, [50, 99, 100]) / 1000
    return Distribution(float(p50), float(p99), float(top))


def _count(counter: FloatArray) -> int:
    """A counter of the run at its end; it never falls."""
    return 0 if np.isnan(counter).all() else int(np.nanmax(counter))


@dataclass(frozen=True)
class ProcessorTime:
    """Time of all processors together since boot, in clock ticks."""

    total: int
    stolen: int
    """Time in which a task was runnable, but the hypervisor gave the processor to another machine."""


def parse_processor_time(stat: str) -> ProcessorTime:
    """From the text of /proc/stat; fields as in proc(5): user nice system idle iowait irq softirq steal …"""
    fields = [int(field) for field in stat.splitlines()[0].split()[1:9]]
    return ProcessorTime(total=sum(fields), stolen=fields[7])


def processor_time() -> ProcessorTime:
    """The processor time now."""
    return parse_processor_time(Path("/proc/stat").read_text())


def stolen_share(before: ProcessorTime, after: ProcessorTime) -> float:
    """0 … 1 of the processors' time that was stolen between the two."""
    total = after.total - before.total
    return (after.stolen - before.stolen) / total if total > 0 else 0.0
