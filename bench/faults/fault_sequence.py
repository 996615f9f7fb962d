"""A random sequence of faults during a random drive; each seed of the campaign stands for one.

    0 … driven       the sender asks for the legs of the drive; faults, emergency stops, resets come in between
    … rested         the sender says zero, or nothing; what fails may go on failing
    … released       faults end or do not; a reset is requested, no command is sent

Drawing is a pure function of the seed and of the robots that are there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from robot_control.loop.signal_names import states
from robot_control.setup.description import describe

from bench.faults.random_drive import Leg, draw_drive
from bench.robot_corpus import DIFFBOT, QUADBOT, SCENES, urdf_of

GAITS = states("Gait")
COMPONENTS = (
    "left_encoder",
    "right_encoder",
    "gyro",
    "accelerometer",
    "left_motor",
    "right_motor",
    "controller",
    "estimator",
    "monitor",
    "battery",
    "e_stop_button",
)
"""The order is part of what a seed means."""
KINDS = states("FaultKind")[1:]  # without "ok"

ALL_RUNS = 10_000
OWN_SHARE = 0.75  # share of the sequences with the project's own robot
LINEAR_LIMIT = 1.0  # m/s, max_linear_speed
ANGULAR_LIMIT = 2.0  # rad/s, max_angular_speed
BATTERY_VOLTAGE = 24.0  # V
WALKED_LIMIT = 0.6  # m/s
TURNED_LIMIT = 1.0  # rad/s, of a walk
REST_TIME = 5.5  # s; sequence_judge.py says for what it has to suffice
RELEASE_TIME = 0.8  # s


@dataclass(frozen=True)
class Event:
    """At `time` [s]: "inject" (component, kind), "e_stop", "e_stop_reset" or "reset" (of the plant)."""

    time: float
    action: str
    component: str = ""
    kind: str = ""


@dataclass(frozen=True)
class FaultSequence:
    """Times in s of simulated time, from the start on."""

    seed: int
    robot: str
    scene: str
    legs: list[Leg]
    interval: float  # s, at which the sender repeats itself
    driven: float
    falls_silent: bool  # nothing is sent after `driven`; otherwise zeros are
    faults_end: bool  # before the release
    events: list[Event] = field(default_factory=list)
    wheel_command: str = "torque"  # one of WHEEL_COMMANDS
    gait: str = ""  # one of GAITS; empty: on wheels
    ground: Mapping[str, Any] = field(default_factory=dict)  # parameters of mujoco_plant over the scene

    @property
    def rested(self) -> float:
        """s, time of the reset request."""
        return self.driven + REST_TIME

    @property
    def released(self) -> float:
        """s, the end."""
        return self.rested + RELEASE_TIME

    def describe(self) -> str:
        """One line: robot, scene, and the events with their times."""
        events = ", ".join(f"{e.time:.3f} s {e.action} {e.component} {e.kind}".rstrip() for e in self.events)
        silent = "then silence" if self.falls_silent else "then zero"
        drives = "" if self.wheel_command == "torque" else f" with drives of {self.wheel_command}"
        drives += f" in gait {self.gait}" if self.gait else ""
        drives += "".join(f" on {name} {value}" for name, value in self.ground.items())
        return f"{self.robot}{drives} in {self.scene}, driven {self.driven:.2f} s, {silent}: {events or 'no fault'}"


def draw_sequence(seed: int, robots: Sequence[str], wheel_command: str = "torque") -> FaultSequence:
    """The sequence of this seed; `robots`: those that are there, the project's own first."""
    random = np.random.default_rng(seed)
    others = robots[1:]
    robot = str(random.choice(others)) if others and random.random() >= OWN_SHARE else DIFFBOT
    driven = random.uniform(2.0, 5.0)
    events = _faults(random, driven) + _operator(random, driven)
    return FaultSequence(
        seed=seed,
        robot=robot,
        scene=str(random.choice(SCENES)),
        legs=draw_drive(random, driven, LINEAR_LIMIT, ANGULAR_LIMIT),
        interval=float(random.choice([0.02, 0.1, 0.5])),
        driven=driven,
        falls_silent=bool(random.random() < 0.5),
        faults_end=bool(random.random() < 0.5),
        events=sorted(events, key=lambda event: event.time),
        wheel_command=wheel_command,
    )


def draw_walk(seed: int) -> FaultSequence:
    """The sequence of this seed for quadbot, which stands up and walks; on every second seed the ground is flat."""
    random = np.random.default_rng(seed)
    driven = random.uniform(5.0, 9.0)
    joints = [joint["name"] for joint in describe(urdf_of(QUADBOT))["joints"]]
    components = [f"{name}_{part}" for name in joints for part in ("encoder", "motor")]
    components += [name for name in COMPONENTS if not name.startswith(("left_", "right_"))]
    events = _faults(random, driven, components) + _operator(random, driven)
    return FaultSequence(
        seed=seed,
        robot=QUADBOT,
        scene="flat",
        legs=draw_drive(random, driven, WALKED_LIMIT, TURNED_LIMIT),
        interval=float(random.choice([0.02, 0.1])),
        driven=driven,
        falls_silent=bool(random.random() < 0.5),
        faults_end=bool(random.random() < 0.5),
        events=sorted(events, key=lambda event: event.time),
        gait=str(random.choice(GAITS)),
        ground=_ground(np.random.default_rng([seed, 1])) if seed % 2 else {},
    )


def _ground(random: np.random.Generator) -> dict[str, Any]:
    """Its random numbers are its own, so that the rest of a sequence is the one of the seed on flat ground."""

    def between(low: float, high: float) -> float:
        return float(random.uniform(low, high))

    begins = {"distance": 0.5, "heading": between(-0.5, 0.5)}
    grounds: dict[str, dict[str, Any]] = {
        "slope": {"slope": between(0.05, 0.175), "slope_heading": between(-math.pi, math.pi)},
        "step": {"terrain": {"kind": "stairs", "count": 1, "height": between(0.02, 0.1), **begins}},
        "rough": {"terrain": {"kind": "rough", "count": 20, "length": 0.2, "height": 0.03, **begins}},
        "ice": {"terrain": {"kind": "ice", "length": 1.0, **begins}},
    }
    return grounds.get(str(random.choice(["flat"] * len(grounds) + list(grounds))), {})


def _faults(random: np.random.Generator, driven: float, components: Sequence[str] = COMPONENTS) -> list[Event]:
    """0 … 4 faults; every second one ends, after 5 ms … 2 s."""
    events = []
    for _ in range(random.integers(5)):
        component = str(random.choice(components))
        begins = random.uniform(0.3, driven)
        events.append(Event(begins, "inject", component, str(random.choice(KINDS))))
        if random.random() < 0.5:
            events.append(Event(begins + random.choice([0.005, 0.03, 0.2, 2.0]), "inject", component, "ok"))
    return events


def _operator(random: np.random.Generator, driven: float) -> list[Event]:
    """Every third drive is stopped on the way, every second one reset as well; one plant in twenty is reset."""
    events = []
    if random.random() < 1 / 3:
        events.append(Event(random.uniform(0.3, driven), "e_stop"))
    if random.random() < 0.5:
        events += [Event(random.uniform(0.3, driven + 1.0), "e_stop_reset") for _ in range(3)]
    if random.random() < 0.05:
        events.append(Event(random.uniform(0.3, driven), "reset"))
    return events
