"""Normal driving goes from waypoint to waypoint near the start, with pauses, reverse and a silent sender.

The drive is steered by the truth of the log, as a person steers by sight; no node receives it. It is a pure function of
the seed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from robot_control.loop.closed_loop import ClosedLoop, Log

STEP = 0.1  # s, between two commands
LINEAR_LIMIT, ANGULAR_LIMIT = 1.0, 2.0  # m/s, rad/s: full speed of the default parameters
ARRIVED = 0.15  # m
TIMEOUT = 15.0  # s, after which another waypoint is drawn
WHEEL_COLUMNS = ("effort", "velocity_measured", "velocity_command")
COLUMNS = (
    *("permit_action", "permit_causes", "permit_warnings", "gate_verdict", "supervisor_state"),
    *("truth_x", "truth_y", "truth_yaw", "estimate_flags", "time"),
    *("limited_linear", "limited_angular", "estimate_linear", "estimate_angular"),
)


@dataclass(frozen=True)
class Area:
    """Area of the waypoints, m, in the frame of the start."""

    x_min: float
    x_max: float
    y_max: float  # and -y_max


@dataclass
class Trip:
    """A trip to a waypoint with a `pause` [s] there; `quiet`: the sender is silent in it, so that its command times
    out.
    """

    x: float
    y: float
    speed: float  # m/s
    reverse: bool
    pause: float
    quiet: bool
    until: float  # s


def area_of(scene: str) -> Area:
    """The area is free of walls, with room to turn; it lies over bumps and ice if the scene has them."""
    if scene == "walls":
        return Area(-1.0, 1.0, 1.0)
    return Area(-1.0, 4.0, 1.5)


class NormalDrive:
    """Drives `loop`, whose robot stands at the start; `seed` draws the waypoints."""

    def __init__(self, loop: ClosedLoop, area: Area, seed: int, top_speed: float = LINEAR_LIMIT) -> None:
        self._top_speed = top_speed  # m/s
        self._loop = loop
        self._area = area
        self._random = np.random.default_rng(seed)
        self._cycles = max(1, round(STEP / loop.period))
        self._trip = self._draw()
        self._paused_until: float | None = None

    def run(self, seconds: float) -> Log:
        """Log of the `COLUMNS`, of each wheel's `WHEEL_COLUMNS`, and path length [m] as `distance`, shape (1,)."""
        parts: list[Log] = []
        wheels = [f"{wheel['joint']}_{name}" for wheel in self._loop.robot["wheels"] for name in WHEEL_COLUMNS]
        log = self._loop.step(self._cycles)
        until = self._loop.time + seconds
        while self._loop.time < until:
            self._command(log)
            log = self._loop.step(self._cycles)
            parts.append({name: log[name] for name in (*COLUMNS, *wheels, "cycle")})
        whole = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        whole["distance"] = np.array([np.hypot(np.diff(whole["truth_x"]), np.diff(whole["truth_y"])).sum()])
        return whole

    def _draw(self) -> Trip:
        random, area = self._random, self._area
        return Trip(
            x=random.uniform(area.x_min, area.x_max),
            y=random.uniform(-area.y_max, area.y_max),
            speed=self._top_speed * random.choice([1.0, 1.0, random.uniform(0.1, 1.0)]),
            reverse=bool(random.random() < 0.25),
            pause=random.choice([0.0, random.uniform(0.1, 3.0)]),
            quiet=bool(random.random() < 0.3),
            until=self._loop.time + TIMEOUT,
        )

    def _command(self, log: Log) -> None:
        trip, time = self._trip, self._loop.time
        dx, dy = trip.x - log["truth_x"][-1], trip.y - log["truth_y"][-1]
        if self._paused_until is not None:
            if time >= self._paused_until:
                self._paused_until = None
                self._trip = self._draw()
            elif not trip.quiet:
                self._loop.command(0.0, 0.0)
            return
        if np.hypot(dx, dy) < ARRIVED or time > trip.until:
            self._paused_until = time + trip.pause
            return
        heading = np.arctan2(dy, dx) - log["truth_yaw"][-1] + (np.pi if trip.reverse else 0.0)
        error = float(np.remainder(heading + np.pi, 2 * np.pi) - np.pi)
        slowing = np.sqrt(2 * 0.5 * np.hypot(dx, dy))  # at half of max_linear_acceleration
        forward = min(trip.speed, slowing) * max(0.0, np.cos(error)) ** 3
        self._loop.command(
            -forward if trip.reverse else forward, float(np.clip(2 * error, -ANGULAR_LIMIT, ANGULAR_LIMIT))
        )
