"""A run in numbers: tracking, timing and safety; as a value, as JSON and as a table."""

import dataclasses
import json
import math
import textwrap
from dataclasses import dataclass

import numpy as np

from robot_control.data.brakes import Brake, brakes_in_drive
from robot_control.data.demo.tracking import ON_LEGS, ON_WHEELS, SETTLE, NotSteadyError, Tracking, judge
from robot_control.data.loop_timing import Distribution, LoopTiming, loop_timing
from robot_control.data.run_log import FloatArray, Log, last
from robot_control.files.json_values import finite
from robot_control.loop.signal_names import causes_in, states
from robot_control.robot.diagnosis.lateness import BY_LATENESS, REMEDY, SENTENCE, load_in_words

BRAKES_SHOWN = 4
LYING = "lying"
WIDTH = 80
"""columns of the table"""


@dataclass(frozen=True)
class Safety:
    """The reports of the safety monitor."""

    state: str
    """State at the end of the log."""
    states: tuple[str, ...]
    """States in the order in which they were entered."""
    causes: tuple[str, ...]
    """Causes of all stops during the run."""


@dataclass(frozen=True)
class RunSummary:
    """One run on a constant command."""

    tracking: Tracking | None
    """None if there was nothing to judge."""
    untracked: str
    """Why nothing was judged; empty otherwise."""
    timing: LoopTiming | None
    """None in lockstep, which has no deadlines."""
    stolen_share: float
    """Share of the processors' time, 0 … 1."""
    safety: Safety
    brakes: tuple[Brake, ...] = ()
    """Brakes of the gate while a motion was requested."""
    postures: tuple[str, ...] = ()
    """Postures of a robot on legs in the order in which they were entered."""

    @property
    def passed(self) -> bool:
        """True if the robot tracked its command, and on legs lies again; timing does not count."""
        return self.tracking is not None and self.tracking.passed and (not self.postures or self.lies)

    @property
    def lies(self) -> bool:
        """True if the robot on legs lies at the end of the log."""
        return self.postures[-1:] == (LYING,)


def summarize(
    log: Log,
    linear: float,
    angular: float,
    driven: float,
    stolen_share: float = 0.0,
    *,
    legged: bool = False,
    clock: str = "wall",
) -> RunSummary:
    """Judges a run.

    Args:
        log: of one run.
        linear: m/s, commanded.
        angular: rad/s, commanded.
        driven: s of this clock from the command's arrival to its end. A log whose steady part ends early, because
            something died, tracked nothing.
        stolen_share: of the processors' time during the run.
        legged: of a robot on legs.
        clock: wall or lockstep.
    """
    tracking, untracked = None, ""
    tolerances = ON_LEGS if legged else ON_WHEELS
    try:
        tracking = judge(log, linear, angular, tolerances)
    except NotSteadyError as error:
        untracked = str(error)
    timing = loop_timing(log) if clock == "wall" else None
    if tracking is not None:
        # The time that a slow plant lost against the wall clock is no fault.
        missing = driven - (timing.slipped if timing else 0.0) - (tracking.end - tracking.begin)
        if missing > tolerances.rise + SETTLE:
            tracking, untracked = None, f"{missing:.1f} s of the {driven:g} s driven are not in the steady part"
    postures = entered(log["legged_phase"], "LegPhase") if legged else ()
    return RunSummary(tracking, untracked, timing, stolen_share, safety(log), brakes_in_drive(log), postures)


def safety(log: Log) -> Safety:
    """States and causes in the log."""
    numbers = log["supervisor_state"]
    state = _name(last(numbers), "SupervisorState")
    causes = tuple(causes_in(log["permit_causes"]))
    return Safety(state=state, states=entered(numbers, "SupervisorState"), causes=causes)


def entered(numbers: FloatArray, kind: str) -> tuple[str, ...]:
    """Names of the states of this kind in the order in which they were entered."""
    known = numbers[~np.isnan(numbers)]
    return tuple(_name(state, kind) for i, state in enumerate(known) if i == 0 or state != known[i - 1])


def to_json(summary: RunSummary) -> str:
    """Every number of the summary, by name; null where it is not a number."""
    tree = dataclasses.asdict(summary)
    tree["passed"] = summary.passed
    if summary.tracking is not None:
        tree["tracking"]["passed"] = summary.tracking.passed
        for check, entry in zip(summary.tracking.checks, tree["tracking"]["checks"], strict=True):
            entry["passed"] = check.passed
    return json.dumps(finite(tree), indent=2, allow_nan=False) + "\n"


def to_table(summary: RunSummary) -> str:
    """The summary for a reader at a terminal, at most 80 columns wide."""
    lines = [*_lateness_lines(summary), *_motion_lines(summary), ""]
    if summary.timing is not None:
        lines += [*_timing_lines(summary.timing, summary.stolen_share), ""]
    lines += [_safety_line(summary.safety), *_posture_lines(summary), *_brake_lines(summary.brakes)]
    return "\n".join(lines)


def _motion_lines(summary: RunSummary) -> list[str]:
    tracking = summary.tracking
    if tracking is None:
        return [f"{'tracking':<34}FAILED: {summary.untracked}"]
    part = f"steady part, {tracking.begin:.1f} … {tracking.end:.1f} s"
    lines = [f"{part:<34}{'commanded':>12}{'true':>12}{'estimated':>12}"]
    for name, unit, axis in (("linear speed", "m/s", tracking.linear), ("yaw rate", "rad/s", tracking.angular)):
        lines.append(f"  {f'{name} [{unit}], mean':<32}{axis.commanded:12.4f}{axis.truth:12.4f}{axis.estimate:12.4f}")
    poses = (tracking.commanded_pose, tracking.true_pose, tracking.estimated_pose)
    for name, attribute in (("x [m], at its end", "x"), ("y [m]", "y"), ("yaw [rad]", "yaw")):
        lines.append(f"  {name:<32}" + "".join(f"{getattr(pose, attribute):12.4f}" for pose in poses))
    lines += ["", f"{'tracking error':<34}{'value':>12}{'allowed':>12}{'':>12}"]
    for check in tracking.checks:
        verdict = "ok" if check.passed else "FAILED"
        lines.append(f"  {check.name:<32}{check.value * 100:10.3f} %{check.tolerance * 100:10.0f} %{verdict:>12}")
    lines.append(f"  {'RMS, linear [mm/s]':<32}{tracking.linear.rms_error * 1000:12.3f}")
    lines.append(f"  {'RMS, angular [mrad/s]':<32}{tracking.angular.rms_error * 1000:12.3f}")
    lines.append(f"  {'estimated position [mm]':<32}{tracking.position_error * 1000:12.3f}")
    lines.append(f"  {'estimated yaw [mrad]':<32}{tracking.yaw_error * 1000:12.3f}")
    if tracking.excused_cycles:
        lines.append(f"  {'cycles excused: braked, 50 after':<32}{tracking.excused_cycles:12d}")
    return lines


def _lateness_lines(summary: RunSummary) -> list[str]:
    """The reason before its consequences, where a stop of a run on the wall clock followed from lateness."""
    if summary.timing is None or not BY_LATENESS.intersection(summary.safety.causes):
        return []
    late = f"{summary.timing.overruns} ticks overran, the plant slipped by {summary.timing.slipped * 1000:.0f} ms"
    said = f"stopped: {SENTENCE}: {load_in_words()}; {late}. Remedy: {REMEDY}, as scripts/demo without --clock has it"
    return [*textwrap.wrap(said, WIDTH), ""]


def _timing_lines(timing: LoopTiming, stolen: float) -> list[str]:
    def row(name: str, values: Distribution) -> str:
        return f"  {name:<32}{values.p50:12.1f}{values.p99:12.1f}{values.max:12.1f}"

    return [
        f"{'loop [µs]':<34}{'p50':>12}{'p99':>12}{'max':>12}",
        row("period", timing.period),
        row("wake-up after its deadline", timing.wake_up),
        row("sensors to command", timing.sensors_to_command),
        "",
        f"{f'deadlines of {timing.cycles} cycles':<34}(reported, not judged)",
        f"  {'command missed: braked':<32}{timing.missed:12d}",
        f"  {'command late: last one held':<32}{timing.held:12d}",
        f"  {'permit late':<32}{timing.late_permits:12d}",
        f"  {'tick overran':<32}{timing.overruns:12d}",
        f"  {'plant slipped [ms]':<32}{timing.slipped * 1000:12.1f}",
        f"  {'processor time stolen':<32}{stolen * 100:10.2f} %",
    ]


def _safety_line(safety_: Safety) -> str:
    stops = f"stopped by {', '.join(safety_.causes)}" if safety_.causes else "no latched stop"
    return f"{'safety':<34}{safety_.state}, {stops} ({' → '.join(safety_.states)})"


def _posture_lines(summary: RunSummary) -> list[str]:
    if not summary.postures:
        return []
    verdict = "" if summary.lies else ": FAILED, the robot does not lie"
    return textwrap.wrap(f"{'posture':<34}{' → '.join(summary.postures)}{verdict}", WIDTH, subsequent_indent=" " * 34)


def _brake_lines(brakes: tuple[Brake, ...]) -> list[str]:
    if not brakes:
        return [f"{'brakes of the gate while driving':<34}none"]
    cycles = sum(brake.cycles for brake in brakes)
    lines = [
        f"{'brakes of the gate while driving':<34}{len(brakes)}, {cycles} cycle{'s' if cycles != 1 else ''} in all"
    ]
    for brake in brakes[:BRAKES_SHOWN]:
        lines += textwrap.wrap(
            f"  {f'at {brake.begin:.3f} s':<32}{brake.describe()}", WIDTH, subsequent_indent=" " * 36
        )
    if len(brakes) > BRAKES_SHOWN:
        lines.append(f"  and {len(brakes) - BRAKES_SHOWN} more")
    return lines


def _name(state: float, kind: str) -> str:
    known = states(kind)
    if math.isnan(state) or not 0 <= state < len(known):
        return "UNKNOWN"
    return known[int(state)]
