"""Judges the rows of `bench_legs`, kinematics and equations of motion of robots on four legs, and of `bench_legs_loop`,
the same robots in the closed loop.

The robots are the project's own quadruped and descriptions of real ones if a folder of them exists. It has a subfolder
per robot with `robot.urdf`, and FACTS.json. ROBOT_QUADRUPEDS names it; otherwise `shared/quadrupeds` above the
repository is used.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robot_control.installed_files import share_file

from bench.markdown import ALLOWED, NO_BOUND
from bench.rows import Result, Say

PARTS = (
    "kinematics",
    "cost",
    "postures",
    "pose",
    "circle",
    "stop",
    "push",
    "rest",
    "silent",
    "replayed",
    "hour",
    "odometry",
    "contact",
    "trot",
    "gaits",
    "robots",
    "walking_stop",
    "walking_cost",
    "walking_replayed",
    "switches",
    "disturbances",
    "kicks",
    "push_limits",
    "faults",
    "faults_uneven",
    "walking_hours",
    "walking_silent",
    "leaning_walks",
    "weak_hips",
    "slopes",
    "steps",
    "stairs",
    "terrain",
)
SEEDS = {
    "postures": 8,
    "stop": 4,
    "replayed": 4,
    "odometry": 24,
    "contact": 4,
    "trot": 24,
    "gaits": 24,
    "robots": 4,
    "walking_stop": 40,
    "walking_replayed": 4,
    "switches": 24,
    "disturbances": 24,
    "kicks": 24,
    "faults": 20,
    "faults_uneven": 20,
    "walking_hours": 12,
    "leaning_walks": 84,
    "weak_hips": 50,
    "slopes": 8,
    "steps": 40,
    "stairs": 40,
    "terrain": 40,
}
"""of each robot; others have one"""
RATES = (1000.0, 500.0)
"""Hz, of the loop"""
OWN_ROBOT = ("cost", "walking_cost", "pose", "circle", "trot", "gaits")
"""parts that are promised of the project's own quadruped alone"""
BOUNDS = {
    "round trip of reachable feet": 1e-9,  # m
    "reachable feet not reached": 0,
    "allocations": 0,
    "mass matrix against MuJoCo": 1e-9,
    "bias against MuJoCo": 1e-9,
    "position and Jacobian of a leg": 0.2,  # µs
    "inverse of a leg": 0.4,
    "mass matrix and bias": 5,
    "estimator": 5,
    "controller": 10,
    "controller, walking, median": 25,
    "controller with a plan, median": 150,
    "controller, walking, 99 %": 400,
    "gate": 1,
    "monitor": 1,
    "controller that does not stand": 0,
    "controller that does not walk": 0,
    "gate that brakes": 0,
    "monitor that stops": 0,
    "cycle of ClosedLoop, of a bare mj_step": 2.5,
    "cycle of ClosedLoop, walking, of a bare mj_step": 4,
    "effort of the limit": 0.9,
    "height after 2 s": 0.008,  # m
    "tilt after 2 s": 0.03,  # rad
    "creep": 0.001,  # m/min
    "not lying at the end": 0,
    "stops": 0,
    "RMS of the place": 0.005,  # m
    "RMS of the angle": 0.015,  # rad
    "slip of a foot": 0.002,  # m
    "RMS of foot": 0.005,  # m
    "tilt with foot": 0.04,  # rad
    "cycles to the brake": 2,  # the stop's own and the next
    "rest": 1.5,  # s
    "acceleration": 40,  # m/s²
    "tilt": 0.15,  # rad
    "0.5 m/s, turned over": 0,
    "way of the body in 10 min without power": 0.01,  # m
    "speed after 10 min without power": 0.001,  # m/s
    "way of the body by": 0.01,  # m
    "replay that is not exact": 0,
    "speed off, 0.25 m/s": 0.02,
    "speed off, ": 0.05,
    "speed off, crawl": 0.03,
    "speed off, walking trot": 0.03,
    "speed off, trot": 0.03,
    "speed off, pace": 0.03,
    "roll RMS, ": 0.05,  # rad
    "pitch RMS, ": 0.05,
    "largest tilt, ": 0.15,
    "joint speed, ": 0.9,
    "cycles not passed, ": 0,
    "stops, ": 0,
    "stands after, ": 1.2,  # s
    "way after zero from the predicted one, ": 0.1,  # m
    "turned over, ": 0,
    "tilt of a stop, ": 0.35,  # rad
    "tilt of a stop, 0.5 m/s": 0.21,
    "tilt of a stop, 1.5 m/s": 0.61,
    "rest of a stop, ": 1.0,  # s
    "way of a stop, 1.5 m/s": 0.8,  # m
    "way of a stop, ": 0.4,
    "tilt while gaits change": 0.3,  # rad
    "dip of the speed while gaits change": 0.3,
    "pushed over": 0.02,
    "turned over, kicks": 0.05,
    "not caught, kicks": 0.05,
    "tilt with a silent ": 0.15,  # rad
    "stops in an hour": 0,
    "time with a warning in an hour": 0,  # s
    "stops in ten minutes": 0,
    "time with a warning in ten minutes": 0,  # s
    "turned over by a fault": 0.05,
    "neither named nor walked through": 0,
    "error of the way": 1,  # %
    "error of yaw": 1.5,  # °
    "drift of height": 5,  # mm/m
    "error of a climb of 1 m": 0.03,  # m
    "RMS of the speed": 0.03,  # m/s
    "error beyond 1.1 of the plain estimate": 0,  # %
    "NEES of": 2,
    "stopped or degraded": 0,
    "touchdowns not found in 15 ms": 2,  # %
    "swing taken for a stance": 2,  # %
    "no touchdown": 0,
    "stopped walks with ": 0,
    "joint speed of walks with poses": 1,
    "joint beyond its range in walks with poses": 0,  # rad
    "neither stands nor refuses on ": 0,
    "turned over on ": 0,
    "stops on ": 0,
}
"""largest value of each figure, by the beginning of its name"""
BOTH_WAYS = ("NEES of",)
"""beginnings of figures that may not be below the inverse of their bound either"""
WITHOUT_BOUND = (
    "kernel",
    "sine and cosine",
    "bare mj_step",
    "0.5 m/s, ",
    "1.0 m/s, ",
    "1.5 m/s, ",
    "stopped by a push, ",
    "push taken, ",
    "neither, ",
    "mean error of",
    "set by hand, ",
    "error of height",
    "stands on ",
    "crossed, ",
    "speed, ",
)
"""beginnings of figures that are measured alone"""


def quadruped_folder() -> Path | None:
    """The folder of real quadrupeds; None if there is none."""
    named = os.environ.get("ROBOT_QUADRUPEDS")
    if named:
        return Path(named)
    for parent in Path(__file__).resolve().parents:
        if (parent / "shared" / "quadrupeds" / "FACTS.json").is_file():
            return parent / "shared" / "quadrupeds"
    return None


def urdfs() -> list[str]:
    """Paths of the descriptions: the project's own first."""
    folder = quadruped_folder()
    own = share_file("urdf/quadbot.urdf")
    if folder is None:
        return [own]
    names = sorted(json.loads((folder / "FACTS.json").read_text()))
    return [own, *(str(folder / name / "robot.urdf") for name in names)]


def _bound(figure: str) -> float | None:
    """The bound of the figure's longest known beginning; None if that has none."""
    known = max((name for name in (*BOUNDS, *WITHOUT_BOUND) if figure.startswith(name)), key=len)
    return BOUNDS.get(known)


def judged(row: dict[str, Any], part: str) -> dict[str, Any]:
    """The row beside its bound, named after robot, part and figure. The ratio of every value but zero is above 1 if the
    bound is zero.
    """
    robot, figure = row["name"].split(" ", 1)
    bound = _bound(figure)
    row = row | {"name": f"{robot} {part}: {figure}"}
    if bound is None:
        return row | {"reference": 0, "reference_name": NO_BOUND, "ratio": 0}
    if figure.startswith(BOTH_WAYS):
        row["value"] = max(row["value"], 1 / row["value"])
    ratio = row["value"] / bound if bound else (1 + row["value"] if row["value"] > 0 else 0)
    return row | {"reference": bound, "reference_name": ALLOWED, "ratio": ratio}


def bench(
    parts: list[str],
    first: int,
    runs: int | None,
    run_program: Callable[..., dict[str, Any]],
    say: Say,
    *,
    rate: float = RATES[0],
    delay: float | None = None,
) -> Result:
    """The rows of these parts, and whether each meets its bound. `run_program` runs the program of this name.

    `rate` is that of the loop in Hz, `delay` the time from sensor to torque in s: whole periods, one by default.
    """
    rows = []
    late = max(0, round((delay or 0) * rate) - 1)
    for part in parts:
        seeds = runs or SEEDS.get(part, 1)
        program = ("bench_legs",) if part == "kinematics" else ("bench_legs_loop", part, first, seeds, rate, late)
        robots = urdfs()[:1] if part in OWN_ROBOT else urdfs()
        measured = [judged(row, part) for row in run_program(*program, *robots)["rows"]]
        for row in measured:
            if row["ratio"] > 1:
                say(f"missed: {row['name']}: {row['value']:.3g} {row['unit']}, at most {row['reference']:g}")
        rows += measured
    return {"bench": "legs", "rows": rows}, all(row["ratio"] <= 1 for row in rows)
