"""Finds stops, brakes, slip, warnings and lost rows in a log, each with its evidence."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from robot_control.data.intervals import intervals, joined
from robot_control.data.report.drive import MOVING, Drive, IntArray
from robot_control.data.report.figures import DEGRADED, SLIP, STOPPED
from robot_control.loop import signal_names as names

TOGETHER = 0.5
"""s: two of a kind that are closer count as one"""
STOPPING = names.number_of("SupervisorState", "STOPPING")
MOMENT = 20
"""cycles without a node; a longer stretch is reported on its own"""
MAX_STOP = 10.0
"""s in which a robot is expected to come to rest"""


@dataclass(frozen=True)
class Incident:
    """One event."""

    severity: int
    """0: a latched stop, 1: a brake, 2: a warning, 3: a note"""
    kind: str
    begin: float
    """s"""
    end: float
    """s"""
    title: str
    evidence: list[str] = field(default_factory=list)


def incidents(drive: Drive) -> list[Incident]:
    """In the order of time."""
    found = [*_stops(drive), *_brakes(drive), *_slips(drive), *_warnings(drive), *_faults(drive), *_gaps(drive)]
    worded = [replace(one, evidence=[drive.kind.worded(line) for line in one.evidence]) for one in found]
    return sorted(worded, key=lambda one: (one.begin, one.severity))


def _span(drive: Drive, begin: int, end: int) -> tuple[float, float]:
    return float(drive.time[begin]), float(drive.time[min(end, drive.time.size - 1)])


def _rows(drive: Drive, seconds: float) -> int:
    return max(1, round(seconds / drive.period))


def _cycles(count: int) -> str:
    return f"{count} cycle" if count == 1 else f"{count} cycles"


def _union(values: IntArray) -> int:
    return int(np.bitwise_or.reduce(values, initial=0))


def _stops(drive: Drive) -> Iterator[Incident]:
    state = drive.column("supervisor_state")
    causes = drive.bits("permit_causes")
    for begin, end in intervals(np.isin(state, (*STOPPED, STOPPING)) & (causes != 0), state):
        bits = names.bits_in("StopCause", _union(causes[begin:end]))
        title = ", ".join(one.name for one in bits)
        evidence = [one.sentence + (f" (remedy: {one.remedy})" if one.remedy else "") for one in bits]
        evidence += [*_measured(drive, begin), _standstill(drive, begin)]
        if end < drive.time.size:
            evidence.append(f"released after {drive.time[end] - drive.time[begin]:.2f} s")
        else:
            evidence.append("not released until the end of the log")
        yield Incident(0, "stop", *_span(drive, begin, end), title, evidence)


def _measured(drive: Drive, row: int) -> Iterator[str]:
    cause = int(drive.bits("evidence_cause")[row])
    value, limit = drive.column("evidence_value")[row], drive.column("evidence_limit")[row]
    if cause != 0 and not np.isnan(value):
        bit = names.bit("StopCause", cause.bit_length() - 1)
        if bit.unit:
            yield f"{bit.name}: measured {value:.4g} {bit.unit}, limit {limit:.4g} {bit.unit}"


def _standstill(drive: Drive, row: int) -> str:
    """The distance to standstill after it."""
    speed = np.abs(drive.column("truth_linear" if drive.has("truth_linear") else "estimate_linear"))
    turning = np.abs(drive.column("truth_angular" if drive.has("truth_angular") else "estimate_angular"))
    after = slice(row, row + _rows(drive, MAX_STOP))
    still = np.flatnonzero((speed[after] < MOVING) & (turning[after] < MOVING))
    begin = f"{speed[row]:.2f} m/s, {turning[row]:.2f} rad/s"
    if still.size == 0:
        return f"at {begin}; no standstill within {MAX_STOP:g} s"
    if still[0] == 0:
        return "the robot stood"
    rows = slice(row, row + int(still[0]) + 1)
    distance = float(np.nansum(speed[rows]) * drive.period)
    return f"at {begin}; standstill after {drive.time[rows][-1] - drive.time[row]:.3f} s and {distance:.3f} m"


def _brakes(drive: Drive) -> Iterator[Incident]:
    """Brakes of the gate alone; those that the monitor ordered are stops."""
    braked = drive.gate_braked()
    reasons = drive.bits("gate_reasons")
    for begin, end in joined(intervals(braked), _rows(drive, TOGETHER)):
        bits = names.bits_in("GateReason", _union(reasons[begin:end][braked[begin:end]]))
        cycles = int(np.count_nonzero(braked[begin:end]))
        title = ", ".join(one.name for one in bits) or "brake"
        yield Incident(1, "brake", *_span(drive, begin, end), title, [_cycles(cycles), *(one.sentence for one in bits)])


def _slips(drive: Drive) -> Iterator[Incident]:
    flags, slip = drive.bits("estimate_flags"), drive.bits("estimate_slip")
    column = drive.column("estimate_flags")
    for begin, end in joined(intervals(flags & SLIP != 0, column), _rows(drive, TOGETHER)):
        bits = names.bits_in("SlipReason", _union(slip[begin:end]))
        title = ", ".join(one.name for one in bits) or "slip"
        yield Incident(3, "slip", *_span(drive, begin, end), title, [one.sentence for one in bits])
    (flag,) = names.bits_in("StateFlag", DEGRADED)
    reasons = names.bits_in("DegradedReason", names.mask_of("DegradedReason", "position", "heading"))
    evidence = [f"perhaps {one.sentence} (remedy: {one.remedy})" for one in reasons]
    for begin, end in joined(intervals(flags & DEGRADED != 0, column), _rows(drive, TOGETHER)):
        yield Incident(2, "degraded", *_span(drive, begin, end), flag.sentence, evidence)


def _warnings(drive: Drive) -> Iterator[Incident]:
    yield from _bits(drive, "permit_warnings", "StopCause", "warning")


def _faults(drive: Drive) -> Iterator[Incident]:
    yield from _bits(drive, "faults", "DriverFault", "driver fault")
    injected = drive.column("injected")
    for begin, end in intervals(injected != 0, injected):
        yield Incident(3, "injected fault", *_span(drive, begin, end), f"code {int(injected[begin])}")


def _bits(drive: Drive, column: str, kind: str, what: str) -> Iterator[Incident]:
    values = drive.bits(column)
    for number in range(_union(values).bit_length()):
        bit = names.bit(kind, number)
        true = intervals(values >> number & 1 != 0, drive.column(column))
        for begin, end in joined(true, _rows(drive, TOGETHER)):
            remedy = [f"remedy: {bit.remedy}"] if bit.remedy else []
            yield Incident(2, what, *_span(drive, begin, end), bit.name, [bit.sentence, *remedy])


def _gaps(drive: Drive) -> Iterator[Incident]:
    steps = np.diff(drive.log["cycle"])
    # If no row was lost, an absent row was not to be recorded: telemetry.record is `motion`.
    for row in np.flatnonzero(steps > 1).tolist() if drive.lost != 0 else ():
        span = float(drive.time[row]), float(drive.time[row + 1])
        yield Incident(2, "rows lost", *span, f"{_cycles(int(steps[row]) - 1)} not in the log")
    nodes = (("estimate_x", "estimator"), ("command_reasons", "controller"), ("permit_action", "monitor"))
    absent = {node: np.isnan(drive.column(column)) for column, node in nodes if column in drive.log}
    if not absent:
        return
    any_absent = np.any(list(absent.values()), axis=0)
    any_absent[0] = False  # the driver is alone in its first tick
    moments = []
    for begin, end in joined(intervals(any_absent), _rows(drive, TOGETHER)):
        missing = [node for node, rows in absent.items() if rows[begin:end].any()]
        cycles = int(np.count_nonzero(any_absent[begin:end]))
        title = f"{_cycles(cycles)} without a row of {', '.join(missing)}"
        one = Incident(2, "node absent", *_span(drive, begin, end), title)
        if cycles > MOMENT:
            yield one
        else:
            moments.append((cycles, one))
    yield from _as_one(moments)


def _as_one(moments: list[tuple[int, Incident]]) -> Iterator[Incident]:
    """Joins short ones, because many of them would hide their consequence."""
    if len(moments) < 2:
        yield from (one for _, one in moments)
        return
    total, (max_cycles, longest) = sum(cycles for cycles, _ in moments), max(moments, key=lambda each: each[0])
    evidence = [f"{_cycles(total)} in all; the longest at {longest.begin:.2f} s: {longest.title}"]
    title = f"at {len(moments)} moments, {_cycles(max_cycles)} at most"
    yield Incident(2, "node absent", moments[0][1].begin, moments[-1][1].end, title, evidence)
