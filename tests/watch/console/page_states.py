"""The console's page with a robot that is made up: each state of a robot, without ROS, served by the real server."""

from __future__ import annotations

import asyncio
import base64
import math
import threading
import time
from pathlib import Path
from types import SimpleNamespace

from robot_control.loop.roles import LEGGED, WHEELED, Kind
from robot_control.robot.diagnosis.state import Cause, Facts, Report, Safety
from robot_control.robot.services import Answer
from robot_control.watch.console.authority import Authority
from robot_control.watch.console.calls import CALLS
from robot_control.watch.console.settings import Settings
from robot_control.watch.console.view import rounded, state_of

from bench.console.process import free_port

ROOT = Path(__file__).parents[3]
FEET = ("front_left", "front_right", "rear_left", "rear_right")
LEG = {"hip": 0.0, "thigh": 0.75, "knee": -1.5}
LYING = {"hip": 0.0, "thigh": 1.3, "knee": -2.6}
CAUSE = Cause(
    "wheel_speed",
    "a wheel is faster than allowed",
    "check load, slope, encoder and motor of that wheel",
    "technician",
    "17.3 rad/s, limit 15 rad/s, left_wheel_joint",
    first=True,
    active=True,
)
STATES = ("wheels", "legs", "navigation", "stopped", "no_robot", "limited")


SERVICES = {call.service for call in CALLS.values()}


class MadeUp:
    """A backend of the server that shows one state."""

    live = True

    def __init__(self, state: str) -> None:
        self.state = state
        self.authority, self.said, self.available = Authority(Settings()), [], SERVICES
        self.trail = SimpleNamespace(points=[(-0.04 * i, 0.3 * math.sin(0.1 * i)) for i in range(60)])
        self.wanted, self.view, self.calls, self.navigation = (-math.inf, {}), self, self, self
        self.pose, self.joints, self.silent, self.over = (0.0, 0.0, 0.1, 0.0, 0.0, 0.0), {}, set(), {}
        self.number, self.made = 0, []

    async def e_stop(self) -> Answer:
        """The robot confirms it."""
        self.made.append(("e_stop", {}))
        self.state = "stopped"
        return Answer("e_stop_trigger", accepted=True, text="stopped")

    def make(self, _: object, name: str, arguments: dict) -> str:
        """Takes every call."""
        self.made.append((name, arguments))
        return "key" if name == "reset_asked" else "done"

    def confirm_reset(self, _: object, key: str) -> None:
        assert key == "key"

    def reset(self) -> None:
        self.made.append(("reset", {}))
        self.state = "wheels"

    @property
    def legged(self) -> bool:
        return self.state == "legs"

    def description(self) -> str:
        if self.state == "no_robot":
            raise OSError("there is no robot_description yet")
        return (ROOT / "urdf" / f"{'quad' if self.legged else 'diff'}bot.urdf").read_text()

    def forget(self, _: object) -> None:
        pass

    def grid(self, _: str) -> dict:
        cells = bytes(
            255 if (x < 6 or y < 6) else 100 if x in (10, 90) or y in (10, 90) else 0
            for y in range(100)
            for x in range(100)
        )
        return {
            "x": -2.5,
            "y": -2.5,
            "yaw": 0.0,
            "resolution": 0.05,
            "columns": 100,
            "cells": base64.b64encode(cells).decode(),
        }

    def fast(self) -> dict:
        self.number += 1
        values = {"type": "fast", "ages": {}, "joints": {}}
        if self.state == "no_robot":
            return values
        v = 0.0 if self.state == "stopped" else 0.5
        joints = (
            {f"{foot}_{part}_joint": at for foot in FEET for part, at in LEG.items()}
            if self.legged
            else {"left_wheel_joint": 0.1 * self.number, "right_wheel_joint": 0.1 * self.number}
        )
        values |= {
            "pose": self.pose,
            "covariance": (0.01, 0.0, 0.004),
            "asked": (v, 0.1, 0.0),
            "limited": (v, 0.1, 0.0),
            "measured": (v - 0.01, 0.1, 0.0),
            "truth": (0.02, 0.01, 0.05),
            "true": (v, 0.1, 0.0),
            "joints": joints | self.joints,
            "driven": [{"name": name, "effort": 0.3 * i, "error": 0.01 * i} for i, name in enumerate(joints)],
        }
        if self.legged:
            values["legs"] = {
                "posture": "walking",
                "gait": "walking_trot",
                "chosen": "auto",
                "gaits": ["auto", "trot", "walking_trot", "crawl"],
                "slope": (0.18, -0.02),
                "feet": [
                    {"name": foot, "bears": i in (0, 3), "load": 60.0 - i, "met_riser": i == 1, "reaching": i == 2}
                    for i, foot in enumerate(FEET)
                ],
            }
        for name in self.silent:
            values.pop(name, None)
        return rounded(values)

    def slow(self) -> dict:
        kind = Kind(LEGGED if self.legged else WHEELED)
        safety = Safety(
            "STOPPED" if self.state == "stopped" else "DRIVE",
            "drive",
            causes=(CAUSE,) if self.state == "stopped" else (),
        )
        nodes = {} if self.state == "no_robot" else {node: Report() for node in kind.loop}
        facts = Facts(
            "http://localhost:11311",
            kind=kind,
            safety=None if self.state == "no_robot" else safety,
            reports=nodes,
            measured=(0.5, 0.1),
        )
        navigation = {"grids": {}}
        if self.state == "navigation":
            navigation = {
                "grids": {"map": 1.0, "costmap": 1.0},
                "map": (0.0, 0.0, 0.0),
                "scan": [(2.0, 0.05 * i - 1.0) for i in range(40)],
                "particles": [(0.01 * i, 0.02 * i) for i in range(20)],
            }
        limits = ["the link allows no more"] if self.state == "limited" else []
        return rounded(
            {
                **state_of(facts),
                "nodes": {node: node in nodes for node in facts.loop},
                "asked_by": "/move_base",
                "limits": limits,
                "broken": {},
                "battery": (0.82, 24.0),
                "odometry": [],
                "faults": "",
                "components": ("gyro",),
                "kinds": ("off",),
                "simulated": True,
                "paused": False,
                "sources": [],
                "revoked": [],
                "data_return": "",
                "navigation": navigation,
                "goal": "driving" if self.state == "navigation" else "",
                "path": {"age": None},
            }
            | self.over
        )

    def authority_of(self, page: object) -> dict:
        return rounded(
            {
                **self.authority.seen_by(page),
                "against": {},
                "dead_man": "",
                "chosen": (0.5, 1.0, 0.3),
                "limits": (1.0, 2.0, 0.5),
                "heartbeat": False,
                "link": {"last": 0.004, "p95": 0.008, "gaps": 0, "late": 0, "replayed": 0, "cap": 0.7},
            }
        )


class Served:
    """The server in a thread of its own, with a made-up robot that a test changes."""

    def __init__(self, folder: Path) -> None:
        self.robot, self.port = MadeUp("wheels"), free_port()
        self.stalled = False  # the server stands still
        self._folder, self._loop, self._there = folder, asyncio.new_event_loop(), threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()
        assert self._there.wait(10.0)

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}/?token={self.server.sessions.token}"

    def show(self, state: str) -> MadeUp:
        """Another robot; the page has to be opened again."""
        self.robot.__init__(state)
        return self.robot

    def _run(self) -> None:
        from aiohttp import web
        from robot_control.settings.addresses import origins_of
        from robot_control.watch.console.server import Server

        async def work() -> None:
            origins = origins_of("127.0.0.1", self.port, [], tls=False, further=[])
            self.server = Server(self.robot, origins, None, self._folder, port=self.port, read_only=False)
            runner = web.AppRunner(self.server.app, handle_signals=False)
            await runner.setup()
            await web.TCPSite(runner, "127.0.0.1", self.port).start()
            self._there.set()
            while True:
                while self.stalled:
                    time.sleep(0.02)
                self.server.frames.make(self.robot)
                await asyncio.sleep(0.05)

        self._loop.run_until_complete(work())
