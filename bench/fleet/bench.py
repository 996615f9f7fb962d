"""`scripts/bench fleet`: random sequences against the model; orders, losses, latency and cost on a simulated robot."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import pairwise
from typing import Any

from robot_control.fleet.v2.curve import points_of

from bench.fleet import sequences
from bench.fleet.broker import missing
from bench.fleet.system import KEEP_ALIVE, System
from bench.rows import Result, Row, Say, bounded, judged

Places = list[tuple[float, ...]]
BLOCK = 5_000
"""sequences in one process"""
SPEED = 0.5
"""m/s"""
ARC = {
    "degree": 2,
    "knotVector": [0, 0, 0, 1, 1, 1],
    "controlPoints": [{"x": 0, "y": 0}, {"x": 1.2, "y": 0, "weight": math.sqrt(0.5)}, {"x": 1.2, "y": 1.2}],
}
SHAPES: dict[str, tuple[Places, dict[str, Any]]] = {
    "line": ([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], {"maxSpeed": SPEED}),
    "loop": ([(0.0, 0.0), (0.8, 0.0), (0.8, 0.8), (0.0, 0.8), (0.0, 0.0, 0.0)], {}),
    "reversed": ([(0.0, 0.0), (-0.8, 0.0), (-1.6, 0.0, 0.0)], {"orientation": math.pi}),
    "NURBS": ([(0.0, 0.0), (1.2, 1.2, math.pi / 2)], {"trajectory": ARC}),
    "turn at a node": ([(0.0, 0.0), (1.0, 0.0, math.pi / 2), (2.0, 0.0, 0.0)], {}),
}
EVENTS = ("", "pause", "broker", "cancel")
LOSSES = (
    "broker killed",
    "broker stalled",
    "cable cut",
    "client killed",
    "client stopped",
    "master silent",
    "path stopped",
)


def bench(parts: Sequence[str], first: int, runs: int | None, say: Say) -> Result:
    """The rows of these parts, and whether all bounds hold. `runs`: sequences, losses of each kind, or
    minutes of the cost.

    Raises:
        RuntimeError: a package is missing.
    """
    rows: list[Row] = []
    if "sequences" in parts:
        rows += _sequences(first, runs or sequences.ALL_SEQUENCES, say)
    if set(parts) - {"sequences"}:
        if why := missing():
            raise RuntimeError(why)
        system = System()
        try:
            if "orders" in parts:
                rows += _orders(system, say)
            if "losses" in parts:
                rows += _losses(system, runs or 20, say)
            if "cost" in parts:
                rows += _cost(system, runs or 1, say)
        finally:
            system.end()
    return judged("fleet", rows)


def _sequences(first: int, count: int, say: Say) -> list[Row]:
    failed, decisions = 0, 0
    starts = range(first, first + count, BLOCK)
    with ProcessPoolExecutor() as pool:
        sizes = [min(BLOCK, first + count - start) for start in starts]
        for wrong, seen, why in pool.map(sequences.run, starts, sizes):
            failed += wrong
            decisions += sum(times for name, times in seen.items() if name.startswith(("new", "update")))
            if why:
                say(why)
    say(f"{count} sequences, {decisions} decisions on orders")
    return [bounded("sequences that differ from the model", failed, f"of {count}", 0)]


class _Figures:
    """The figures of all orders."""

    def __init__(self) -> None:
        self.off, self.turned, self.aside, self.passing = [0.0], [0.0], [0.0], [1.0]
        self.latency: list[float] = []
        self.unfinished = 0


def _orders(system: System, say: Say) -> list[Row]:
    found = _Figures()
    for event in EVENTS:
        for name in SHAPES:
            try:
                _one_order(system, name, event, found)
            except AssertionError as error:
                found.unfinished += 1
                say(f"{name} {event}: {error}")
    count = len(SHAPES) * len(EVENTS)
    return [
        bounded("orders not finished", found.unfinished, f"of {count}", 0),
        bounded("end beside its node, worst", 1000 * max(found.off), "mm", 20.0),
        bounded("end turned from its node, worst", math.degrees(max(found.turned)), "deg", 2.0),
        bounded("cross-track, worst", 1000 * max(found.aside), "mm", 30.0),
        bounded("lowest speed at a node where the base goes on", min(found.passing), "of the edge's", 0.9),
        bounded("order to wheels, median", 1000 * statistics.median(found.latency), "ms", 150.0),
    ]


def _one_order(system: System, name: str, event: str, found: _Figures) -> None:
    places, fields = SHAPES[name]
    system.place()
    began = time.monotonic()
    base = max(2, len(places) - 1)
    sent = system.send(places, base, **fields)
    moved = _await_motion(system, sent)
    found.latency.append(moved - sent)
    if event == "pause":
        system.act("startPause")
        system.robot.await_rest()
        system.act("stopPause")
    elif event == "broker":
        system.broker.kill()
        time.sleep(1.0)
        system.broker.start()
        system.master.last.pop("connection", None)
        system.listen("ONLINE again", lambda: system.connection == "ONLINE")
    elif event == "cancel":
        time.sleep(0.5)
        system.act("cancelOrder")
        x, y, yaw = system.here
        ahead = 0.8 if name != "reversed" else -0.8
        places = [(x, y), (x + ahead * math.cos(yaw), y + ahead * math.sin(yaw))]
        fields = {"orientation": math.pi} if name == "reversed" else {}
        began = system.send(places, **fields)
        base = 2
    if base < len(places):
        system.listen("newBaseRequest", lambda: system.state["newBaseRequest"])
        system.send(places[base - 1 :], update=1, first=base - 1, **fields)
    system.await_end()
    x, y, yaw = system.here
    end = places[-1]
    found.off.append(math.hypot(x - end[0], y - end[1]))
    if len(end) > 2:
        found.turned.append(abs(math.remainder(yaw - end[2], math.tau)))
    way = [place[:2] for place in places] if "trajectory" not in fields else list(points_of(ARC))
    samples = [(pose.seen_from(system.origin), speed) for _, pose, speed in system.poses(began)]
    found.aside.append(max(_beside(way, point) for point, _ in samples))
    if name in ("line", "reversed") and not event:
        near = [abs(speed) for point, speed in samples if abs(point[0] - places[1][0]) < 0.1]
        found.passing.append(min(near) / SPEED)


def _await_motion(system: System, sent: float) -> float:
    """s, monotonic, of the first odometry with a speed."""
    moved: list[float] = []

    def moves() -> bool:
        moved[:] = [at for at, _, speed in system.poses(sent) if abs(speed) > 0.005][:1]
        return bool(moved)

    system.listen("motion", moves, 10.0)
    return moved[0]


def _beside(way: Sequence[Sequence[float]], point: Sequence[float]) -> float:
    """m from a polyline."""
    best = math.inf
    for (ax, ay), (bx, by) in pairwise([(each[0], each[1]) for each in way]):
        size = (bx - ax) ** 2 + (by - ay) ** 2
        share = min(1.0, max(0.0, ((point[0] - ax) * (bx - ax) + (point[1] - ay) * (by - ay)) / size)) if size else 0.0
        best = min(best, math.hypot(point[0] - ax - share * (bx - ax), point[1] - ay - share * (by - ay)))
    return best


def _losses(system: System, runs: int, say: Say) -> list[Row]:
    failed, wills = 0, [0.0]
    for number in range(runs):
        say(f"losses: round {number + 1} of {runs}")
        for kind in LOSSES:
            try:
                _one_loss(system, kind, 0.3 + 0.1 * (number % 10), wills)
            except AssertionError as error:
                failed += 1
                say(f"{kind}: {error}")
                system.repair()
    return [
        bounded("losses that did not end as stated", failed, f"of {runs * len(LOSSES)}", 0),
        bounded("will seen by the master, worst", max(wills) / KEEP_ALIVE, "of keep_alive", 1.5),
    ]


def _one_loss(system: System, kind: str, after: float, wills: list[float]) -> None:
    """An order of two released edges and a horizon; the loss comes while it drives."""
    system.place()
    sent = system.send([(0.0, 0.0), (0.7, 0.0), (1.4, 0.0), (2.1, 0.0)], 3)
    _await_motion(system, sent)
    expected = 1.4
    if kind == "path stopped":  # while it brakes
        system.listen("the way", lambda: system.here[0] > expected + 0.1 - 0.4 * after)
        system.pause("follow_path.py")
    else:
        time.sleep(after)
    lost = time.monotonic()
    if kind == "broker killed":
        system.broker.kill()
    elif kind == "broker stalled":
        system.broker.stall()
    elif kind == "cable cut":
        system.cable.stalled = True
    elif kind == "client killed":
        system.kill("vda5050.py")
    elif kind == "client stopped":
        system.pause("vda5050.py")
    if kind.startswith(("cable", "client")):
        system.listen("the will", lambda: system.connection == "CONNECTIONBROKEN", 3 * KEEP_ALIVE)
        wills.append(time.monotonic() - lost)
    time.sleep(1.0)
    system.robot.await_rest()
    at = system.here[0]
    short = expected if kind == "path stopped" else 0.02
    assert -short < at - expected < 0.02, f"the robot stands at {at:.3f} m, not at the end of the base"
    system.repair()
    system.master.last.pop("state", None)
    system.listen("a state", lambda: system.connection == "ONLINE" and _fresh(system))
    name = f"o{system.count}"
    known = (system.state["orderId"], [each["released"] for each in system.state["nodeStates"]][-1])
    assert known == (name, False), f"the order was lost: {system.state}"
    system.act("stopPause")
    system.send([(1.4, 0.0), (2.1, 0.0)], update=1, first=2)
    system.await_end()
    end = system.here[0]
    assert abs(end - 2.1) < 0.02, f"the order went on to {end:.2f} m"


def _fresh(system: System) -> bool:
    """A state after the loss; it is requested, for a silent master hears none."""
    if not system.state:
        system.master.act("stateRequest")
        for _ in system.master.messages(0.5):
            pass
    return bool(system.state)


def _cost(system: System, minutes: int, say: Say) -> list[Row]:
    system.place()
    system.send([(0.0, 0.0), (0.8, 0.0)])
    system.await_end()
    before, memory = system.cost("vda5050.py")
    began, update = time.monotonic(), 0
    while time.monotonic() - began < 60 * minutes:
        update += 1
        ends = [(0.8, 0.0), (0.0, 0.0)] if update % 2 else [(0.0, 0.0), (0.8, 0.0)]
        system.send(ends, update=update, first=update, orientation=math.pi if update % 2 else 0.0)
        try:
            system.await_end()
        except AssertionError as error:  # the machine stood still, and the order was paused
            say(f"cost: {error}")
            system.act("stopPause")
            system.await_end()
    after, grown = system.cost("vda5050.py")
    share = 100 * (after - before) / (time.monotonic() - began)
    return [
        bounded("client, driving", share, "% of a core", 3.0),
        bounded(f"client, growth in {minutes} min", (grown - memory) / 1e6, "MB", 2.0),
    ]
