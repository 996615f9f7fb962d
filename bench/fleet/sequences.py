"""Random orders, updates, cancels and actions, against a model that is written from the standard's text alone."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from typing import Any

from robot_control.fleet.v2.messages import RefusedError
from robot_control.fleet.v2.order import Action, order_of
from robot_control.fleet.v2.vehicle import ActionState, Vehicle

from bench.fleet.messages import action, order

ALL_SEQUENCES = 100_000
STEPS = 30
TAKEN, IGNORED, REFUSED = "taken", "ignored", "refused"
OVER = ("FINISHED", "FAILED")


class Model:
    """Sections 6.6.2 to 6.6.4, 6.10.2 and 6.12, over plain lists."""

    def __init__(self) -> None:
        self.order, self.update = "", 0
        self.reached: tuple[str, int] = ("", 0)
        self.nodes: list[dict[str, Any]] = []  # nodeStates
        self.released: set[int] = set()  # sequenceIds that the master released, of this order
        self.status: dict[str, str] = {}
        self.cancelling = False  # cancelOrder runs
        self.dropped = True  # it was not completed: the robot may be anywhere
        self.of: dict[str, tuple[int, str]] = {}  # sequenceId and blockingType of each action

    @property
    def executing(self) -> bool:
        return bool(self.nodes) or self.cancelling or any(status not in OVER for status in self.status.values())

    def decide(self, message: dict[str, Any], near: bool) -> str:
        """Figure 8."""
        first = message["nodes"][0]
        start = (first["nodeId"], first["sequenceId"])
        if message["orderId"] != self.order:
            near = near or (not self.dropped and start[0] == self.reached[0])
            return REFUSED if self.executing or not near else TAKEN
        if message["orderUpdateId"] < self.update:
            return REFUSED
        if message["orderUpdateId"] == self.update:
            return IGNORED
        base = [(node["nodeId"], node["sequenceId"]) for node in self.nodes if node["released"]]
        if self.executing:
            point = base[-1] if base else self.reached
            return TAKEN if start == point and not self.cancelling and (near or not self.dropped) else REFUSED
        return TAKEN if start == self.reached and (near or not self.dropped) else REFUSED

    def take(self, message: dict[str, Any]) -> None:
        """Populates or appends the states."""
        new = message["orderId"] != self.order
        self.order, self.update, self.dropped = message["orderId"], message["orderUpdateId"], False
        first = message["nodes"][0]["sequenceId"]
        if new:
            self.nodes, self.released, self.status, self.of = [], set(), {}, {}
        for name in [name for name, (at, _) in self.of.items() if at > first]:  # of the horizon that was replaced
            del self.status[name], self.of[name]
        self.nodes = [node for node in self.nodes if node["sequenceId"] <= first]
        self.nodes += message["nodes"] if new else message["nodes"][1:]
        for element in [*message["nodes"], *message["edges"]]:
            if element["released"]:
                self.released.add(element["sequenceId"])
            if new or element["sequenceId"] > first:
                for each in element["actions"]:
                    self.status[each["actionId"]] = "WAITING"
                    self.of[each["actionId"]] = element["sequenceId"], each["blockingType"]
        if new:
            self.reach()

    def reach(self) -> None:
        node = self.nodes.pop(0)
        self.reached = node["nodeId"], node["sequenceId"]
        for name, (at, _) in self.of.items():
            if at % 2 and at < node["sequenceId"] and self.status[name] not in OVER:  # the edge was left
                self.status[name] = "FINISHED" if self.status[name] == "RUNNING" else "FAILED"

    def settle(self, standing: bool) -> None:
        """Figure 9: the order ends when the robot stands and its actions are over."""
        if self.cancelling and standing and all(status in OVER for status in self.status.values()):
            self.nodes, self.cancelling, self.dropped = [], False, True

    def may_start(self, name: str) -> bool:
        """6.12: reached or entered, in its sequence, and no HARD one beside another."""
        at, blocking = self.of[name]
        running = [each for each, status in self.status.items() if status == "RUNNING"]
        entered = at % 2 and at == self.reached[1] + 1 and at in self.released
        before = [each for each, (other, _) in self.of.items() if other < at]
        alone = blocking != "HARD" or not running
        free = all(self.of[each][1] != "HARD" for each in running)
        in_turn = all(self.status[each] != "WAITING" for each in before)
        return bool((at == self.reached[1] or entered) or at < self.reached[1]) and alone and free and in_turn


class Trial:
    """One sequence."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.vehicle, self.model = Vehicle(), Model()
        self.count = 0  # of actions and orders, for ids
        self.seen: dict[str, int] = {}

    def note(self, event: str) -> None:
        self.seen[event] = self.seen.get(event, 0) + 1

    def run(self) -> None:
        """Raises AssertionError."""
        events: list[tuple[Callable[[], None], int]] = [
            (self.send_new, 2),
            (self.send_update, 5),
            (self.drive, 10),
            (self.end_action, 6),
            (self.cancel, 1),
            (self.pause, 1),
            (self.clear, 1),
            (self.restart, 1),
        ]
        calls, weights = zip(*events, strict=True)
        for _ in range(STEPS):
            self.vehicle.standing = self.random.random() < 0.7
            self.random.choices(calls, weights)[0]()
            self.start_actions()
            self.vehicle.settle()
            self.model.settle(self.vehicle.standing)
            self.check()

    def message(self, name: str, update: int, first: int) -> dict[str, Any]:
        size = self.random.randint(1, 5)
        actions: dict[int, list[dict[str, Any]]] = {}
        for sequence in range(2 * first, 2 * (first + size) - 1):
            for _ in range(self.random.choice([0, 0, 0, 1, 2])):
                self.count += 1
                blocking = self.random.choice(["NONE", "SOFT", "HARD"])
                actions.setdefault(sequence, []).append(action("horn", f"a{self.count}", blocking))
        places = [(float(first + n), 0.0) for n in range(size)]
        return order(places, self.random.randint(1, size), name=name, update=update, first=first, actions=actions)

    def send(self, message: dict[str, Any]) -> None:
        near = self.random.random() < 0.8
        expected = self.model.decide(message, near)
        try:
            got = TAKEN if self.vehicle.receive(order_of(message), lambda _: near, lambda _: None) else IGNORED
        except RefusedError as error:
            got = REFUSED
            self.vehicle.refuse(error.error)
        assert got == expected, f"{got}, by the model {expected}: {json.dumps(message)}"
        if got == TAKEN:
            assert not self.vehicle.refusals
            self.model.take(message)
        kind = "new" if message["orderUpdateId"] == 0 else "update"
        self.note(f"{kind} {got}")

    def send_new(self) -> None:
        self.count += 1
        self.send(self.message(f"o{self.count}", 0, 0))

    def send_update(self) -> None:
        base = [node.sequence // 2 for node in self.vehicle.nodes if node.released]
        first = base[-1] if base else self.model.reached[1] // 2
        update = self.model.update + 1
        match self.random.randint(0, 9):
            case 0:
                update = max(0, self.model.update - 1)
            case 1:
                update = self.model.update
            case 2:
                first = max(0, first + self.random.choice([-1, 1]))
        self.send(self.message(self.model.order or "none", update, first))

    def drive(self) -> None:
        vehicle = self.vehicle
        if not vehicle.may_drive:
            return
        edge, node = vehicle.base[:2]
        assert {edge.sequence, node.sequence} <= self.model.released, "a node was driven that was not released"
        blocked = [n for n, (at, kind) in self.model.of.items() if kind != "NONE" and self.model.status[n] == "RUNNING"]
        assert not blocked, "it drove beside a blocking action"
        waiting = [n for n, (at, kind) in self.model.of.items() if kind != "NONE" and at <= self.model.reached[1]]
        assert all(self.model.status[n] in OVER for n in waiting), "it drove on before a blocking action"
        vehicle.traverse()
        self.model.reach()
        assert (vehicle.last_id, vehicle.last_sequence) == self.model.reached
        self.note("node")

    def start_actions(self) -> None:
        before = dict(self.model.status)
        for state in self.vehicle.started():
            name = state.action.id
            if state.sequence < 0:
                continue
            assert self.model.may_start(name), f"{name} began out of turn"
            assert state.action.blocking == "NONE" or self.vehicle.standing, f"{name} began while it drove"
            assert before[name] == "WAITING"
            self.model.status[name] = "RUNNING"
            self.note("action")

    def end_action(self) -> None:
        running = [state for state in self.vehicle.actions if state.status == "RUNNING" and state.sequence >= 0]
        if running:
            state = self.random.choice(running)
            state.end(self.random.choice(OVER))
            self.model.status[state.action.id] = state.status

    def cancel(self) -> None:
        self.count += 1
        state = self.vehicle.add_instant(Action.of(action("cancelOrder", f"c{self.count}", "HARD")))
        assert isinstance(state, ActionState)
        executing = self.model.executing
        running = self.vehicle.cancel(state)
        assert (state.status == "RUNNING") == executing
        assert executing or self.vehicle.refusals[-1].kind == "noOrderToCancel"
        if executing:
            self.fail_waiting()
        self.model.cancelling = executing
        assert {each.action.id for each in running} == {n for n, s in self.model.status.items() if s == "RUNNING"}
        self.note("cancel" if executing else "cancel refused")

    def fail_waiting(self) -> None:
        self.model.status = {n: "FAILED" if s == "WAITING" else s for n, s in self.model.status.items()}

    def pause(self) -> None:
        self.vehicle.paused = not self.vehicle.paused

    def clear(self) -> None:
        self.vehicle.clear("MANUAL")
        self.fail_waiting()
        self.model.nodes, self.model.cancelling, self.model.dropped = [], False, True

    def restart(self) -> None:
        dumped = json.loads(json.dumps(self.vehicle.dump()))
        held = bool(self.vehicle.nodes)
        self.vehicle = Vehicle()
        self.vehicle.load(dumped)
        assert self.vehicle.paused or not held, "an order went on by itself"
        self.model.status = {n: "FAILED" if s == "RUNNING" else s for n, s in self.model.status.items()}

    def check(self) -> None:
        """The state is consistent."""
        vehicle = self.vehicle
        states = [(node.id, node.sequence, node.released) for node in vehicle.nodes]
        assert states == [(n["nodeId"], n["sequenceId"], n["released"]) for n in self.model.nodes]
        edges = [edge.sequence for edge in vehicle.edges]
        assert edges == [node.sequence - 1 for node in vehicle.nodes]
        assert (vehicle.order_id, vehicle.update_id) == (self.model.order, self.model.update)
        assert (vehicle.last_id, vehicle.last_sequence) == self.model.reached
        own = {s.action.id: s.status for s in vehicle.actions if s.sequence >= 0}
        assert own == self.model.status, f"{own}, by the model {self.model.status}"
        running = [self.model.of[n][1] for n, status in own.items() if status == "RUNNING"]
        assert "HARD" not in running or len(running) == 1
        assert vehicle.executing == self.model.executing


def run(first: int, count: int) -> tuple[int, dict[str, int], str]:
    """Failed sequences, how often each event happened, and the first failure with its seed."""
    failed, seen, why = 0, dict[str, int](), ""
    for seed in range(first, first + count):
        trial = Trial(seed)
        try:
            trial.run()
        except AssertionError as error:
            failed += 1
            why = why or f"seed {seed}: {error}"
        for event, times in trial.seen.items():
            seen[event] = seen.get(event, 0) + times
    return failed, seen, why
