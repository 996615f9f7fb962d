"""Judges whether a robot survived a fault sequence, by the truth of the plant, which no node receives, and by the gate.

The speed s is that of the faster side over the ground, m/s: |v| + |ω| b/2, with the wheel base b. The robot stands if
the means of v and ω over MEAN_TIME give less than STANDING_SPEED. It also stands if it rocks on its casters, as light
robots do for seconds.

    permit     Where the gate does not brake, a permit to drive or to ramp of one of the last four cycles is there.
    brake      While it brakes, s does not grow (but while wheels that spun pull on, SPIN_TIME), and after STOP_TIME +
               s/a the robot stands, a what brakes reach on the ground of the scene.
    speed      s stays below SPEED_FACTOR times the fastest that the controller may ask for, plus SPEED_MARGIN.
    rest       At the end of the rest the robot stands.
    release    After the release it stands on, and after each reset that was accepted until a command comes. A robot on
               legs may lie down by its brake meanwhile.
    tilt       It never leans by TILT_LIMIT, nor among walls and bumps, which lift it, by HIT_TILT_LIMIT.
    machine    The simulation does not diverge.

No rule demands more than a brake can do. A motor that is off, intermittent or sends garbage has no brake
(drivers/mujoco/motors/motor_faults.h). Meanwhile s may grow by what the slope gives a free robot, g sin 5° t, and by
GARBAGE_SPEED; the robot need not come to rest. A monitor that errs (garbage, wrong) gives permits by itself. Then
the rules of the gate alone count: "permit", "machine", that "brake" ends at rest, and "rest" after its recovery. A
blocked wheel, or a motor with a wrong torque, jolts the robot harder than any brake. Its tilt then does not count. A
drive that is slow or delayed receives the brake LATE_DRIVE later.

A drive that closes the loop of its own speed holds a blocked wheel with the torque that its integral had before the
brake. When the wheel comes free, that torque turns it until the integral has discharged. So "brake" counts the time
to standstill from there, and "release" does not judge what follows. The gain of s stays within BRAKE_MARGIN.

A robot on legs lies down by its brake. A body that falls gains speed, so its way is judged in place of s: FOLD_WAY at
most. It rests after FOLD_TIME. Instead of TILT_LIMIT, it must not turn over, OVER_LIMIT. Its brake follows encoders:
random angles are a random torque. With a motor that is off or reversed it rests, too, because the stop ends with the
brakes of the drives (gate/stop_action.h). While it stands, its motors hold it: on an intermittent one it sways by up
to SWAY_SPEED.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from robot_control.loop.closed_loop import Log
from robot_control.loop.signal_names import number_of

from bench.faults.fault_sequence import FaultSequence
from bench.robot_corpus import ICE, stop_deceleration_of

BRAKE = number_of("GateVerdict", "brake")
RAMP, DRIVE = (number_of("PermitAction", name) for name in ("ramp", "drive"))
PERMIT_LIFE = 4  # cycles that are promised, whatever the tested code says
DRIVER_FAULT = number_of("DriverState", "fault")
STOPPED_STATES = [number_of("SupervisorState", name) for name in ("STOPPED", "FAULT")]
RULES = ("permit", "brake", "speed", "rest", "release", "tilt", "machine")

STANDING_SPEED = 0.01  # m/s
SWAY_SPEED = 0.1  # m/s
MEAN_TIME = 0.3  # s
ROCKING = 0.005  # rad, change of tilt within MEAN_TIME
LATE_DRIVE = 0.02  # s, for 10 cycles of 1 ms and the reaction
STOP_TIME = 1.0  # s, with the mean and the fall of a light robot back on its casters
SPIN_TIME = 0.15  # s
BRAKE_MARGIN = 0.3  # m/s; walls turn v into ω
SPEED_FACTOR, SPEED_MARGIN = 1.5, 0.7  # 1, m/s: 0.1 s of the strongest drives, until a fault is certain
GARBAGE_SPEED = 1.0  # m/s
TILT_LIMIT = np.radians(10)
HIT_TILT_LIMIT = np.radians(30)  # a light robot that runs into a wall at 1 m/s stands up by 20° and falls back
FOLD_TIME = 1.8  # s, the 1.5 s of docs/evidence/stop_times.md and the mean
FOLD_WAY = 0.4  # m, what `scripts/bench legs walking_stop` allows up to 1.0 m/s
OVER_LIMIT = np.radians(60)
ICY, DRY = "low_friction_patch", 1.0  # the scene with ice, friction of the others
GRAVITY_ON_SLOPE = 9.81 * np.sin(np.radians(5))  # m/s²

Mask = NDArray[np.bool_]
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Violation:
    """The violated rule, `time` [s] after the beginning."""

    rule: str
    time: float
    text: str

    def __str__(self) -> str:
        return f"{self.rule} at {self.time:.3f} s: {self.text}"


def failing_each(log: Log, component: str, *kinds: str) -> Mask:
    """Cycles in which `component` fails in one of these ways; shape (components, cycles). A "motor" has one row per
    joint.
    """
    digit = (log["injected"].astype(np.int64) >> (3 * number_of("FaultComponent", component))) & 7
    failures = [digit, *(log[name] for name in log if name.endswith(f"_injected_{component}"))]
    return np.isin(failures, [number_of("FaultKind", kind) for kind in kinds])


def failing(log: Log, component: str, *kinds: str) -> Mask:
    """Cycles in which any `component` fails in one of these ways; shape (cycles,)."""
    return np.asarray(failing_each(log, component, *kinds).any(axis=0))


def judge(sequence: FaultSequence, log: Log, wheel_base: float, period: float, fastest: float) -> list[Violation]:
    """The first violation of each rule; `wheel_base` m, `period` s, `fastest` m/s that the controller requests of a
    rim.
    """
    court = _Court(sequence, log, wheel_base, period)
    rules = (court.permit, court.brake, court.rest, court.release, court.tilt, court.machine)
    found = [next(rule(), None) for rule in rules] + [next(court.speed(fastest), None)]
    return [violation for violation in found if violation is not None]


def blocks(mask: Mask) -> list[tuple[int, int]]:
    """[first, end) of every stretch in which `mask` holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]])))
    return [(int(first), int(end)) for first, end in zip(edges[::2], edges[1::2], strict=True)]


def resting_speed(log: Log, period: float, arms: Mapping[str, float]) -> Array:
    """m/s, by which a robot rests below STANDING_SPEED: the means of these columns over MEAN_TIME, each times its arm.

    At the beginning the means are over fewer cycles. `period` is in s.
    """
    window = max(1, round(MEAN_TIME / period))
    return np.asarray(sum(np.abs(_mean(log[name], window)) * arm for name, arm in arms.items()))


def _mean(values: Array, window: int) -> Array:
    """Means over the last `window` values, at the beginning over fewer."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    rows = np.arange(1, len(sums))
    first = np.maximum(rows - window, 0)
    return np.asarray((sums[rows] - sums[first]) / (rows - first))


class _Court:
    """The data that all rules share. Every rule yields violations in the order of time."""

    def __init__(self, sequence: FaultSequence, log: Log, wheel_base: float, period: float) -> None:
        self._sequence = sequence
        self._log = log
        self._period = period
        self._speed = np.abs(log["truth_linear"]) + np.abs(log["truth_angular"]) * wheel_base / 2
        window = max(1, round(MEAN_TIME / period))
        tilt = log["truth_tilt"]
        rocks = np.abs(tilt - tilt[np.maximum(np.arange(len(tilt)) - window, 0)]) > ROCKING
        mean_speed = resting_speed(log, period, {"truth_linear": 1, "truth_angular": wheel_base / 2})
        self._standing = (mean_speed <= STANDING_SPEED) | rocks
        self._on_legs = bool(sequence.gait)
        self._unbraked = failing(log, "motor", "garbage", *([] if self._on_legs else ["off", "intermittent"]))
        if self._on_legs:
            self._unbraked |= failing(log, "encoder", "garbage")
            sways = failing(log, "motor", "intermittent") & (log["gate_verdict"] != BRAKE)
            self._standing |= sways & (mean_speed <= SWAY_SPEED)
        jolts = ("stuck", "wrong", "garbage")
        self._jolted = failing(log, "motor", *jolts)
        freed = np.diff(failing_each(log, "motor", "stuck").astype(int), prepend=0) < 0
        self._freed = freed.any(axis=0) & (sequence.wheel_command == "velocity")
        self._folding = np.zeros_like(self._standing)
        for first, end in blocks((log["gate_verdict"] == BRAKE) & self._on_legs):
            self._folding[first : min(end, first + round(FOLD_TIME / period))] = True
        self._late = failing(log, "motor", "slow", "delayed")
        self._monitor_errs = failing(log, "monitor", "garbage", "wrong")
        self._new_run = np.concatenate([[True], np.diff(log["run"]) != 0])

    def _violation(self, rule: str, cycle: int, text: str) -> Violation:
        return Violation(rule, cycle * self._period, text)

    def permit(self) -> Iterator[Violation]:
        """A live permit is there whenever the gate lets a command pass."""
        log = self._log
        rows = np.flatnonzero(log["gate_verdict"] != BRAKE)
        age = log["cycle"][rows] - log["gate_permit_cycle"][rows]
        action = log["permit_action"][np.maximum(rows - age.astype(int), 0)]
        live = (age >= 1) & (age <= PERMIT_LIFE) & np.isin(action, [RAMP, DRIVE])
        for row in rows[~live]:
            yield self._violation("permit", row, f"verdict {log['gate_verdict'][row]:.0f} without a live permit")

    def brake(self) -> Iterator[Violation]:
        """Braking slows the robot down and ends at standstill; with a dead motor it gains no more than by slope or
        garbage.
        """
        braking = self._log["gate_verdict"] == BRAKE
        for first, end in blocks(braking & ~self._new_run):
            mask = np.zeros_like(braking)
            mask[first:end] = True
            for start, stop in blocks(mask & ~self._unbraked):
                begins = [start, *(start + 1 + np.flatnonzero(self._freed[start + 1 : stop])), stop]
                for part in pairwise(begins):
                    yield from self._braked(*part)
            for start, stop in blocks(mask & self._unbraked):
                yield from self._coasting(start, stop)

    def _braked(self, start: int, stop: int) -> Iterator[Violation]:
        if self._late[start]:
            start = min(stop - 1, start + round(LATE_DRIVE / self._period))
        speed = self._speed[start:stop]
        spun = float(np.max(speed[: max(1, round(SPIN_TIME / self._period))]))
        if not self._monitor_errs[:start].any():
            yield from self._far(start, stop) if self._on_legs else self._faster(start, stop, spun + BRAKE_MARGIN)
        slows_down = stop_deceleration_of(self._sequence.robot, ICE if self._sequence.scene == ICY else DRY)
        stop_time = FOLD_TIME if self._on_legs else STOP_TIME
        deadline = round((stop_time + spun / slows_down) / self._period)
        late = np.flatnonzero(~self._standing[start:stop][deadline:])
        if late.size:
            row = start + deadline + int(late[0])
            yield self._violation("brake", row, f"{self._speed[row]:.3f} m/s, braking from {speed[0]:.3f} m/s")

    def _faster(self, start: int, stop: int, limit: float) -> Iterator[Violation]:
        for row in start + np.flatnonzero(self._speed[start:stop] > limit)[:1]:
            yield self._violation("brake", row, f"{limit - BRAKE_MARGIN:.3f} m/s grew to {self._speed[row]:.3f} m/s")

    def _far(self, start: int, stop: int) -> Iterator[Violation]:
        x, y = (self._log[name][start:stop] for name in ("truth_x", "truth_y"))
        way = np.hypot(x - x[0], y - y[0])
        jolted = np.logical_or.accumulate(self._jolted)[start:stop]
        for row in np.flatnonzero((way > FOLD_WAY) & ~jolted)[:1]:
            yield self._violation("brake", start + row, f"the body is {way[row]:.3f} m from where the brake began")

    def _coasting(self, start: int, stop: int) -> Iterator[Violation]:
        speed = self._speed[start:stop]
        gain = GRAVITY_ON_SLOPE * self._period * np.arange(stop - start) if "slope" in self._sequence.scene else 0.0
        growing = np.flatnonzero(speed > speed[0] + BRAKE_MARGIN + GARBAGE_SPEED + gain)
        if growing.size:
            row = start + int(growing[0])
            yield self._violation("brake", row, f"without motors {speed[0]:.3f} m/s grew to {self._speed[row]:.3f} m/s")

    def speed(self, fastest: float) -> Iterator[Violation]:
        """The robot does not run away."""
        limit = SPEED_FACTOR * fastest + SPEED_MARGIN
        excused = np.logical_or.accumulate(self._unbraked | self._monitor_errs)  # `brake` judges a coasting robot
        for row in np.flatnonzero((self._speed > limit) & ~excused):
            yield self._violation("speed", row, f"{self._speed[row]:.3f} m/s above {limit:.3f} m/s")

    def rest(self) -> Iterator[Violation]:
        """The robot stands in the last tenth of a second of the rest."""
        last = round(self._sequence.rested / self._period)
        first = last - round(0.1 / self._period)
        if (self._unbraked | self._monitor_errs)[first:last].any():
            return
        for row in range(first, last):
            if not self._standing[row]:
                yield self._violation("rest", row, f"still {self._speed[row]:.3f} m/s")

    def release(self) -> Iterator[Violation]:
        """The robot stands from each accepted reset on until a motion is requested."""
        log = self._log
        stopped = np.isin(log["supervisor_state"], STOPPED_STATES)
        resets = np.flatnonzero(stopped[:-1] & ~stopped[1:] & ~np.isnan(log["supervisor_state"][1:]))
        asked = (np.nan_to_num(log["requested_linear"]) != 0) | (np.nan_to_num(log["requested_angular"]) != 0)
        for reset in resets:
            commands = np.flatnonzero(asked[reset:])
            end = reset + int(commands[0]) if commands.size else len(asked)
            first = reset + round(MEAN_TIME / self._period)  # from here on the mean contains no earlier values
            excused = self._unbraked | self._monitor_errs | self._new_run | self._freed
            moving = ~(self._standing | self._folding)[reset:end] & ~np.logical_or.accumulate(excused[reset:end])
            for row in range(first, end):
                if not moving[row - reset]:
                    continue
                yield self._violation("release", row, f"{self._speed[row]:.3f} m/s without a command")

    def tilt(self) -> Iterator[Violation]:
        """The robot stays upright, unless a motor jolted it."""
        tilt = self._log["truth_tilt"]
        on_wheels = HIT_TILT_LIMIT if self._sequence.scene in ("walls", "bumps") else TILT_LIMIT
        limit = OVER_LIMIT if self._on_legs else on_wheels
        for row in np.flatnonzero((tilt > limit) & ~np.logical_or.accumulate(self._jolted | self._monitor_errs)):
            yield self._violation("tilt", row, f"leans by {np.degrees(tilt[row]):.1f}°")

    def machine(self) -> Iterator[Violation]:
        """The simulation did not diverge."""
        for row in np.flatnonzero(self._log["driver_state"] == DRIVER_FAULT):
            yield self._violation("machine", row, "driver fault")
