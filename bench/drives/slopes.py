"""On a slope a robot stops and stays at a zero request: slopes, rates, headings and both kinds of drives.

At 20 and 30 Hz the wheel loops do not find the load of a steep slope in the time of a drive. So the drive itself may be
faster than its command, and the planned distance is that of the speed at which it was. The safety monitor may have
stopped it before.
"""

from __future__ import annotations

import itertools
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, radians
from pathlib import Path

import numpy as np
from robot_control.loop.closed_loop import ClosedLoop
from scipy.spatial.transform import Rotation

from bench.drives.wheel_command import WHEEL_COMMANDS, for_drives
from bench.rows import Result, Row, Say, compared, judged

SLOPES = (0, 5, 10, 15)  # degrees
RATES = (20, 30, 50, 100, 1000)  # Hz
HEADINGS = 8
SPEEDS = (0.0, 0.5, -0.2)  # m/s; 0: the request is zero from the start
BEYOND = 0.1  # m, farther than the planned stop
REST, DRIVE, STOP = 1.0, 3.0, 8.0  # s
STANDS = 0.001  # m/s


@dataclass(frozen=True)
class Stop:
    """A stop on a slope: the way beyond its plan [m], whether it stands at the end, and the causes of a latched one."""

    beyond: float
    stands: bool
    causes: int


def scene(slope: float, heading: float) -> str:
    """MJCF of a floor of `slope` [rad]; the robot starts at `heading` [rad] from uphill."""
    floor = Rotation.from_euler("y", -slope)
    start = floor * Rotation.from_euler("z", heading)
    floor_text, start_text = (" ".join(map(repr, each.as_quat()[[3, 0, 1, 2]].tolist())) for each in (floor, start))
    return (
        '<mujoco><worldbody><geom name="floor" type="plane" size="50 50 1" friction="1 0.005 0.0001" '
        f'quat="{floor_text}"/><site name="start" quat="{start_text}"/></worldbody></mujoco>'
    )


def stop_on(slope: float, rate: int, heading: float, wheel_command: str, speed: float) -> Stop:
    """Drives diffbot at `speed` [m/s] on a slope [rad], and requests zero for `STOP` seconds."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "slope.xml")
        path.write_text(scene(slope, heading), encoding="utf-8")
        loop = ClosedLoop(for_drives(wheel_command, {"robot": {"rate": rate}}), scene=path)
    loop.run(REST, (0.0, 0.0))
    before = loop.run(DRIVE, (speed, 0.0))
    log = loop.run(STOP, (0.0, 0.0))
    way = float(np.sum(np.hypot(np.diff(log["truth_x"]), np.diff(log["truth_y"]))))
    was = max(abs(speed), abs(float(before["truth_linear"][-1])))
    stands = bool(np.abs(log["truth_linear"][-round(1 / loop.period) :]).max() < STANDS)
    planned = loop.stop_distance(was) if speed else 0.0
    causes = np.bitwise_or.reduce(log["permit_causes"].astype(np.int64)) & ~int(before["permit_causes"][-1])
    return Stop(way - planned, stands, int(causes))


def worst(slopes: Sequence[float], rates: Sequence[int], headings: int, wheel_command: str) -> list[Row]:
    """A row for each slope [degrees] and rate: the longest way beyond the plan; infinite if a robot does not stand."""
    rows = []
    for slope, rate in itertools.product(slopes, rates):
        stops = [
            stop_on(radians(slope), rate, 2 * pi * number / headings, wheel_command, speed)
            for speed, number in itertools.product(SPEEDS, range(headings))
        ]
        value = max(stop.beyond if stop.stands and not stop.causes else np.inf for stop in stops)
        rows.append(compared(f"{wheel_command}, {slope}°, {rate} Hz", value, "m", BEYOND, "what is allowed"))
    return rows


def bench(say: Say) -> Result:
    """The result, and whether every stop keeps its bound."""
    rows = []
    for wheel_command in WHEEL_COMMANDS:
        for slope in SLOPES:
            rows += worst([slope], RATES, HEADINGS, wheel_command)
            say(f"{wheel_command}, {slope}°: {max(row['value'] for row in rows[-len(RATES) :]):.3f} m beyond the plan")
    return judged("slopes", rows)
