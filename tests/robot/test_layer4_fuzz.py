"""Damaged messages at the boundary of every program beside the loop that has no fuzz of its own: none ends one.

Each mutant crosses the real deserialization and what the program does with it. Nothing may raise, nothing may surprise
the boundary, and no message may take longer than `timed` allows.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import random
import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import genpy
import pytest
from robot_control import _robot_control
from robot_control.drive.pad.main import Source
from robot_control.drive.pad_law import Pad
from robot_control.drive.path.frames import Tf, located
from robot_control.drive.path.robot import Robot
from robot_control.drive.path.waypoints import PathError, Waypoint
from robot_control.drive.send_cmd.main import Statuses
from robot_control.drive.send_cmd.release import Release
from robot_control.drive.speed_limits import SpeedLimits
from robot_control.installed_files import share_file
from robot_control.robot.diagnosis.listener import Listener
from robot_control.robot.pose import Pose
from robot_control.robot.safety_watch import SafetyWatch
from robot_control.robot.services import Answer, in_words
from robot_control.robot.view import View as RobotView
from robot_control.settings.parameter_layers import layered
from robot_control.setup.calibrate.robot import CalibratedRobot
from robot_control.watch.latency import main as latency
from robot_control.watch.latency.figures import table
from robot_control.watch.status.main import Status
from robot_control.watch.view import main as view
from robot_control.watch.why.screen import Layout, render
from support.mutants import mutants
from support.timed import longest, timed
from support.topics import Topics, graph, surprises_of, wire

COUNT = 100_000 if os.environ.get("ROBOT_CONTROL_NIGHTLY") else 2000
"""mutants of each topic and input"""
ROWS = 3
"""of each list in a sample"""
Step = Callable[[], object]


def sample(kind: type[genpy.Message], draw: random.Random) -> genpy.Message:
    """A message of this type whose every list has ROWS entries."""
    message = kind()
    for name, of in zip(kind.__slots__, kind._slot_types, strict=True):
        element, is_list, size = of.partition("[")
        count = int(size[:-1] or ROWS) if is_list else 1
        values = [_value(element, draw) for _ in range(count)]
        setattr(message, name, bytes(values) if of.startswith("uint8[") else values if is_list else values[0])
    return message


def _value(kind: str, draw: random.Random) -> Any:
    if "/" in kind or kind == "Header":
        import roslib.message

        return sample(roslib.message.get_message_class("std_msgs/Header" if kind == "Header" else kind), draw)
    if kind == "string":
        return draw.choice(("odom", "READY", "state_estimator", "left_wheel_joint", "a: b, c", "0.5", ""))
    if kind in ("time", "duration"):
        return genpy.Time(draw.randrange(1 << 31)) if kind == "time" else genpy.Duration(draw.randrange(100))
    return draw.random() if kind.startswith("float") else draw.randrange(2)


@pytest.fixture
def surprises(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    return surprises_of(monkeypatch)


@pytest.fixture
def topics(monkeypatch: pytest.MonkeyPatch) -> Iterator[Topics]:
    with graph(monkeypatch) as made:
        yield made


def console() -> Step:
    pytest.importorskip("aiohttp")
    from robot_control.watch.console.authority import Role
    from robot_control.watch.console.backend import Backend
    from robot_control.watch.console.navigation import NoGridError
    from robot_control.watch.console.settings import Settings

    backend = Backend(Settings())
    page = backend.authority.join("anna", Role.MAINTAIN)
    backend.authority.take(page, time.monotonic())

    def step() -> None:
        backend.step()
        backend.view.navigation._places = backend.view.navigation._places_of_now()
        shown = [backend.fast(), backend.slow(), backend.authority_of(page), backend.view.wanted[1]]
        json.dumps(shown, allow_nan=False)
        for name in ("map", "costmap"):
            with contextlib.suppress(NoGridError):
                json.dumps(backend.view.navigation.grid(name), allow_nan=False)

    return step


def status() -> Step:
    robot_status = Status()
    return lambda: robot_status.poll(time.monotonic())


def why() -> Step:
    listener = Listener()

    def step() -> None:
        facts = listener.facts()
        render(facts, Layout(80, colour=True))
        in_words(Answer("e_stop_reset", accepted=False, text=""), facts)

    return step


def teleop() -> Step:
    limits, watch = SpeedLimits(), SafetyWatch()
    return lambda: (limits.newest(), watch.interrupted(), watch.drivable(), watch.revoked(0.0, waited=True))


def pad() -> Step:
    law, robot = Pad(), RobotView("drive_state", "leg_state")
    source = Source(law, None, topic=True)
    return lambda: (source.poll(time.monotonic()), law.command(time.monotonic()), law.state(0.0), robot.refused)


def send_cmd() -> Step:
    statuses, release = Statuses(), Release(time.monotonic())
    statuses._subscriber = SimpleNamespace(get_num_connections=lambda: 1)
    return lambda: statuses.update(release)


def view_markers() -> Step:
    legs = _robot_control.legs(*layered({}, share_file("urdf/quadbot.urdf")))
    shown = view.View()
    shown._legs = legs
    return shown.draw


def calibrate() -> Step:
    robot = CalibratedRobot()
    return lambda: (robot.observe(), robot.path(), robot.wheels, robot.truth, robot.logs, robot.begin())


def latencies() -> Step:
    listener = latency.Listener()
    return lambda: table(listener.nodes())


def follow_path() -> Step:
    robot, tf = Robot(attended=True), Tf()
    tf._complete_at = -math.inf

    def step() -> None:
        robot.against_driving(time.monotonic())
        robot.revoked(0.0, waited=True)
        with contextlib.suppress(PathError):
            located([Waypoint(0.0, 0.0)], "map", robot.frames, tf)[1].pose(Pose(0.0, 0.0, 0.0), time.monotonic())

    return step


@pytest.mark.parametrize(
    "program",
    [console, status, why, teleop, pad, send_cmd, view_markers, calibrate, latencies, follow_path],
    ids=lambda p: p.__name__,
)
def test_no_damaged_message_ends_or_surprises_it(
    program: Callable[[], Step], topics: Topics, surprises: list[str]
) -> None:
    step = program()
    step()
    longest[0] = 0.0
    count = COUNT // 4 if program is console else COUNT  # its step makes a whole page
    for topic, kind in sorted(topics.types.items()):
        draw = random.Random(topic)
        for number, mutant in enumerate(mutants(wire(sample(kind, draw)), count, seed=len(topic))):
            timed(lambda message: (topics.send_bytes(topic, message), step()), mutant)  # noqa: B023 (called at once)
            assert not surprises, (topic, number, mutant, surprises)
    print(f"{count} mutants of each of {len(topics.types)} topics: the slowest took {1000 * longest[0]:.1f} ms")
