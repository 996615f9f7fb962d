"""Carries a fault sequence out on `ClosedLoop`."""

from __future__ import annotations

from typing import Any

import numpy as np
from robot_control.loop.closed_loop import ClosedLoop, Log

from bench.drives.wheel_command import for_drives
from bench.faults.fault_sequence import BATTERY_VOLTAGE, Event, FaultSequence
from bench.faults.random_drive import leg_at
from bench.robot_corpus import scene_of, stop_deceleration_of, urdf_of

COLUMNS = (
    "run",
    "cycle",
    "truth_x",
    "truth_y",
    "truth_tilt",
    "truth_linear",
    "truth_angular",
    "requested_linear",
    "requested_angular",
    "permit_action",
    "supervisor_state",
    "permit_causes",
    "gate_verdict",
    "gate_reasons",
    "gate_permit_cycle",
    "driver_state",
    "injected",
)
JOINT_COLUMNS = ("_injected_encoder", "_injected_motor")
"""end the names of columns for each joint"""


def loop_arguments(sequence: FaultSequence) -> dict[str, Any]:
    """Arguments for the robot of this sequence in its scene; its sensors err as the seed says."""
    params = {
        "mujoco_plant": {"sensor_errors": "data_sheet", "battery_voltage": BATTERY_VOLTAGE, **sequence.ground},
        "safety_monitor": {"stop_deceleration": stop_deceleration_of(sequence.robot)},
    }
    return {
        "params": for_drives(sequence.wheel_command, params),
        "seed": sequence.seed,
        "urdf": urdf_of(sequence.robot),
        "scene": scene_of(sequence.scene),
    }


def make_loop(sequence: FaultSequence) -> ClosedLoop:
    """A loop with these arguments."""
    return ClosedLoop(**loop_arguments(sequence))


def run_sequence(sequence: FaultSequence, loop: ClosedLoop) -> Log:
    """The log's `COLUMNS` and those of each joint, one value per cycle from the first to the last."""
    player = _Player(sequence, loop)
    if sequence.gait:
        loop.set_gait(sequence.gait)
    for event in sequence.events:
        player.run_until(event.time)
        player.act(event)
    player.run_until(sequence.rested)
    if sequence.faults_end:
        for component in {event.component for event in sequence.events if event.action == "inject"}:
            loop.inject_fault(component, "ok")
    loop.e_stop_reset()
    player.run_until(sequence.released)
    names = [*COLUMNS, *(name for name in player.parts[0] if name.endswith(JOINT_COLUMNS))]
    return {name: np.concatenate([part[name] for part in player.parts]) for name in names}


class _Player:
    """Runs to the next event and sends like the sender of the sequence."""

    def __init__(self, sequence: FaultSequence, loop: ClosedLoop) -> None:
        self.parts: list[Log] = []
        self._sequence = sequence
        self._loop = loop
        self._cycles = 0
        self._send_cycle = 1  # messages in cycle 0 are dropped
        self._interval = max(1, round(sequence.interval / loop.period))

    def act(self, event: Event) -> None:
        match event.action:
            case "inject":
                self._loop.inject_fault(event.component, event.kind)
            case "e_stop":
                self._loop.e_stop()
            case "e_stop_reset":
                self._loop.e_stop_reset()
            case "reset":
                self._loop.reset()

    def run_until(self, time: float) -> None:
        """Runs to `time` s after the first cycle."""
        until = round(time / self._loop.period)
        while self._cycles < until:
            if self._cycles == self._send_cycle:
                self._send()
                self._send_cycle += self._interval
            cycles = min(until, self._send_cycle) - self._cycles
            self.parts.append(self._loop.step(cycles))
            self._cycles += cycles

    def _send(self) -> None:
        time = self._cycles * self._loop.period
        if time < self._sequence.driven:
            leg = leg_at(self._sequence.legs, time)
            self._loop.command(leg.linear, leg.angular)
        elif not self._sequence.falls_silent and time < self._sequence.rested:
            self._loop.command(0.0, 0.0)
