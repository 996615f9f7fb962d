"""The order rules as a state machine (6.6 to 6.12): which order is taken, what is driven, which action runs.

The master's messages and the robot's events go in; `may_drive`, `base` and `started` come out. A node is driven to only
while it and the edge before it are released. Decision on an order (figure 8):

    orderId    orderUpdateId    it is taken if
    another    any              nothing is executed, and the robot stands on its first node, or reached it last
    the same   lower            never
    the same   equal            never; it is ignored
    the same   higher           executing: its first node is the decision point, the last released node
    the same   higher           completed: its first node is the last one reached
    the same   higher           dropped: the same, and the robot stands on it

Executing: `nodeStates` is not empty, an action is neither FINISHED nor FAILED, or the robot does not stand yet after
cancelOrder. Dropped: by cancelOrder, a person who drove or initPosition. The robot may be anywhere then. A node that
counted as reached is not measured again: its deviation held at that time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

from robot_control.fleet.v2.messages import LIMITS, Error, Message, RefusedError
from robot_control.fleet.v2.order import HARD, NONE, Action, Edge, Node, Order, in_sequence

WAITING, RUNNING, FINISHED, FAILED = "WAITING", "RUNNING", "FINISHED", "FAILED"
OVER = (FINISHED, FAILED)
IMMEDIATE = ("startPause", "stopPause", "cancelOrder", "stateRequest", "factsheetRequest")
"""instant actions that concern the order itself: they wait for none and hold none up, whatever their blockingType"""
MAX_ERRORS = 20
"""refusals that are reported; an older one makes room"""
MAX_NODES = 2 * LIMITS["nodes"]
"""nodes that are still to be traversed; so an update may be as long as an order while that is driven"""
MAX_OVER = 1000
"""finished actions of an order that are kept, where an older one makes room"""
MAX_INSTANT = 100
"""finished instant actions that are kept until the next order, where an older one makes room; and that may run"""

Near = Callable[[Node], bool]
"""True if the robot stands on this node, within its deviation, or has its orientation"""


@dataclass
class ActionState:
    """An action with its status."""

    action: Action
    sequence: int  # of its node or edge; −1: instant
    status: str = WAITING
    result: str = ""
    triggered: bool = False  # its node was reached, its edge entered

    @property
    def over(self) -> bool:
        """True if it is FINISHED or FAILED."""
        return self.status in OVER

    def end(self, status: str, result: str = "") -> None:
        """FINISHED or FAILED, for good."""
        if not self.over:
            self.status, self.result = status, result


class Vehicle:
    """One robot and its order, as the standard describes them."""

    def __init__(self) -> None:
        self.order_id, self.update_id = "", 0
        self.last_id, self.last_sequence = "", 0
        self.last: Node | None = None  # the node of these, as its first order described it; None: dropped
        self.nodes: list[Node] = []  # that are still to be traversed
        self.edges: list[Edge] = []
        self.actions: list[ActionState] = []
        self.refusals: list[Error] = []  # kept until an order is accepted (6.6.4)
        self.paused = False
        self.standing = True

    # what the master wants

    def receive(
        self, order: Order, near: Near, refuse: Callable[[Order], None], aligned: Near = lambda _: True
    ) -> bool:
        """True if the order, or the update, is taken; False if it is already here.

        Args:
            order: a valid one.
            near: says whether the robot stands on a node.
            refuse: raises RefusedError for what this robot cannot do.
            aligned: says whether the robot has the orientation of a node.

        Raises:
            RefusedError: with the reason, for `refuse`.
        """
        if order.id != self.order_id:
            self._check_new(order, near)
            refuse(order)
            self._take_new(order)
            if aligned(order.nodes[0]):
                self.traverse()
        else:
            if order.update == self.update_id:
                return False
            self._check_update(order, near)
            refuse(order)
            self._take_update(order)
        self.refusals.clear()
        return True

    def refuse(self, error: Error) -> None:
        """Reports it until an order is accepted."""
        if error not in self.refusals:
            self.refusals = [*self.refusals, error][-MAX_ERRORS:]

    @property
    def executing(self) -> bool:
        """True while an order is held that is not completed, or is being cancelled; a horizon counts."""
        return bool(self.nodes or self.cancelling) or any(
            not state.over for state in self.actions if state.sequence >= 0
        )

    def _check_new(self, order: Order, near: Near) -> None:
        if self.executing:
            raise _refused(order, "orderError", f"order {self.order_id} is not completed", "OTHER_ORDER_ACTIVE")
        self._check_ids(order, order.elements, (s for s in self.actions if s.sequence < 0 and not s.over))
        self._check_start(order, order.nodes[0], near)

    def _check_start(self, order: Order, node: Node, near: Near) -> None:
        if not self._stands_on(node) and not near(node):
            kind = "orderUpdateError" if order.id == self.order_id else "orderError"
            why = f"the robot is not at node {node.id}"
            raise _refused(order, kind, why, "START_NODE_OUT_OF_RANGE", nodeId=node.id)

    def _stands_on(self, node: Node) -> bool:
        """True if it is the last one reached, at the same place: the robot has not driven since."""
        last, place = self.last, node.place
        if last is None or last.place is None or place is None or last.id != node.id:
            return False
        known = last.place
        same = (known.x, known.y, known.map_id) == (place.x, place.y, place.map_id)
        return same and place.theta in (None, known.theta)

    def _check_update(self, order: Order, near: Near) -> None:
        first = order.nodes[0]
        if order.update < self.update_id:
            raise _refused(order, "orderUpdateError", f"update {self.update_id} was accepted before it")
        point = (self.last_id, self.last_sequence)
        if self.executing:
            point = next(((n.id, n.sequence) for n in reversed(self.nodes) if n.released), point)
        if (first.id, first.sequence) != point:
            why = f"it must begin with node {point[0]}, sequenceId {point[1]}"
            raise _refused(order, "orderUpdateError", why, nodeId=first.id)
        if sum(node.sequence <= first.sequence for node in self.nodes) + len(order.nodes) - 1 > MAX_NODES:
            raise _refused(order, "orderUpdateError", f"more than {MAX_NODES} nodes are still to be traversed")
        self._check_ids(order, order.elements[1:], (s for s in self.actions if s.sequence <= first.sequence))
        if self.cancelling:
            raise _refused(order, "orderUpdateError", "the order is being cancelled")
        if self.last is None:
            self._check_start(order, first, near)

    def _check_ids(self, order: Order, elements: Iterable[Node | Edge], kept: Iterable[ActionState]) -> None:
        known = {state.action.id for state in kept}
        for action in (action for each in elements for action in each.actions):
            if action.id in known:
                raise _refused(order, "orderError", "the actionId is in use", actionId=action.id)

    def _take_new(self, order: Order) -> None:
        self.actions = [state for state in self.actions if state.sequence < 0 and not state.over]
        self.order_id, self.update_id = order.id, order.update
        self.nodes, self.edges = list(order.nodes), list(order.edges)
        self._add_actions(order.elements)
        self.last = order.nodes[0]  # the robot stands on it

    def _take_update(self, order: Order) -> None:
        """The stitching node keeps its content; the horizon makes room for the new one."""
        after = order.nodes[0].sequence
        self.update_id, self.last = order.update, self.last or order.nodes[0]
        self.nodes = [node for node in self.nodes if node.sequence <= after] + list(order.nodes[1:])
        self.edges = [edge for edge in self.edges if edge.sequence < after] + list(order.edges)
        self.actions = [state for state in self.actions if state.sequence <= after]
        self._forget([state for state in self.actions if state.over and state.sequence >= 0], MAX_OVER)
        self._add_actions(order.elements[1:])
        self._enter_edge()

    def _add_actions(self, elements: Iterable[Node | Edge]) -> None:
        self.actions += [ActionState(action, each.sequence) for each in elements for action in each.actions]

    # instant actions

    def add_instant(self, action: Action) -> ActionState | None:
        """Its state, triggered; None if an action of this id is here already: it came twice. If too many are not
        over, one that concerns the order itself takes the place of the oldest one of its kind.

        Raises:
            RefusedError: too many others of the robot are not over.
        """
        if any(state.action.id == action.id for state in self.actions):
            return None
        instant = [state for state in self.actions if state.sequence < 0]
        going_on = [state for state in instant if not state.over]
        why = f"{MAX_INSTANT} instant actions have not ended"
        if len(going_on) >= MAX_INSTANT:
            if action.kind not in IMMEDIATE:
                raise RefusedError("orderError", why, actionId=action.id)
            for state in [each for each in going_on if each.action.kind == action.kind][:1]:
                state.end(FAILED, why)
        self._forget([state for state in instant if state.over], MAX_INSTANT - 1)
        state = ActionState(action, -1, triggered=True)
        self.actions.append(state)
        return state

    def _forget(self, over: list[ActionState], kept: int) -> None:
        """The oldest of these make room, until so many are kept."""
        for state in over[: max(0, len(over) - kept)]:
            self.actions.remove(state)

    @property
    def cancelling(self) -> list[ActionState]:
        """The cancelOrder actions that run."""
        return [state for state in self.actions if state.action.kind == "cancelOrder" and state.status == RUNNING]

    def cancel(self, state: ActionState) -> list[ActionState]:
        """Begins cancelOrder (6.6.3); the running actions of the order, which have to be ended."""
        if not self.executing:
            state.end(FAILED, "there is no order")
            why = "no order can be cancelled"
            self.refuse(Error("noOrderToCancel", why, (("actionId", state.action.id),)))
            return []
        state.status = RUNNING
        return self._fail_waiting("the order was cancelled")

    def _fail_waiting(self, why: str) -> list[ActionState]:
        of_order = [state for state in self.actions if state.sequence >= 0]
        for state in of_order:
            if state.status == WAITING:
                state.end(FAILED, why)
        return [state for state in of_order if not state.over]

    def settle(self) -> None:
        """Ends cancelOrder once the robot stands and no action of the order runs, and startPause once it stands."""
        running = any(state.sequence >= 0 and not state.over for state in self.actions)
        if self.cancelling and self.standing and not running:
            for state in self.cancelling:
                state.end(FINISHED)
            self._drop()
        for state in self.actions:
            if state.action.kind == "startPause" and state.status == RUNNING and self.standing:
                state.end(FINISHED)

    def _drop(self) -> None:
        self.nodes, self.edges, self.last = [], [], None

    def clear(self, why: str) -> list[ActionState]:
        """Drops the order at once (MANUAL); the running actions of the order, which have to be ended."""
        running = self._fail_waiting(why)
        self._drop()
        for state in self.cancelling:
            state.end(FINISHED)
        return running

    # what the robot does

    @property
    def base(self) -> list[Node | Edge]:
        """Edges and nodes that are released, from the last node on: they may be driven."""
        elements = in_sequence(self.nodes, self.edges)
        released = next((n for n, each in enumerate(elements) if not each.released), len(elements))
        return elements[:released]

    @property
    def horizon(self) -> bool:
        """True if nodes follow that are not released."""
        return any(not node.released for node in self.nodes)

    @property
    def may_drive(self) -> bool:
        """True if the next node is released and nothing forbids to drive to it."""
        blocked = any(s.triggered and not s.over and s.action.blocking != NONE for s in self.actions if not _own(s))
        return bool(self.base) and not self.paused and not self.cancelling and not blocked

    def traverse(self) -> list[ActionState]:
        """The first node of `nodes` was reached (6.10.2); the running actions of the edge that was left, which have to
        be ended.
        """
        node = self.nodes.pop(0)
        left = [edge for edge in self.edges if edge.sequence < node.sequence]
        self.edges = [edge for edge in self.edges if edge.sequence > node.sequence]
        self.last, self.last_id, self.last_sequence = node, node.id, node.sequence
        ended = []
        for state in self.actions:
            if any(state.sequence == edge.sequence for edge in left) and not state.over:
                if state.status == RUNNING:
                    ended.append(state)
                state.end(FINISHED if state.status == RUNNING else FAILED, "the edge was left")
            elif state.sequence == node.sequence:
                state.triggered = True
        self._enter_edge()
        return ended

    def _enter_edge(self) -> None:
        """Triggers the actions of the next edge, once it is released and its first node was reached."""
        for edge in self.edges[:1]:
            if edge.released and (not self.nodes or self.nodes[0].sequence > edge.sequence):
                for state in self.actions:
                    state.triggered = state.triggered or state.sequence == edge.sequence

    def started(self) -> list[ActionState]:
        """The actions that begin now, in their sequence (6.12); they are RUNNING from here on."""
        begun = []
        for state in self.actions:
            if not state.triggered or state.over or _own(state):
                continue
            if state.status == RUNNING:
                continue
            active = [each for each in self.actions if each.status == RUNNING and not _own(each)]
            if any(each.action.blocking == HARD for each in active) or (state.action.blocking == HARD and active):
                break
            if state.action.blocking != NONE and not self.standing:
                break
            state.status = RUNNING
            begun.append(state)
        return begun

    @property
    def revision(self) -> object:
        """Differs after every change of what `dump` holds."""
        statuses = tuple((each.action.id, each.status) for each in self.actions)
        point = (self.order_id, self.update_id, self.last_id, self.last_sequence, len(self.nodes), self.paused)
        return *point, statuses

    def copy(self) -> Vehicle:
        """One that changes without this one: an order is taken by it first, and it is then this one, or forgotten."""
        other = Vehicle()
        other.__dict__ |= self.__dict__
        other.nodes, other.edges, other.refusals = [*self.nodes], [*self.edges], [*self.refusals]
        other.actions = [replace(state) for state in self.actions]
        return other

    # across a restart

    def dump(self) -> Message:
        """Everything but the errors, for `load`."""
        return {
            "paused": self.paused,
            "ids": [self.order_id, self.update_id, self.last_id, self.last_sequence],
            "last": self.last and self.last.raw,
            "nodes": [node.raw for node in self.nodes],
            "edges": [edge.raw for edge in self.edges],
            "actions": [[s.action.raw, s.sequence, s.status, s.result, s.triggered] for s in self.actions],
        }

    def load(self, dumped: dict[str, Any]) -> None:
        """Paused, if there is an order; what ran when the program ended has FAILED."""
        self.order_id, self.update_id, self.last_id, self.last_sequence = dumped["ids"]
        self.last = Node.of(dumped["last"]) if dumped["last"] else None
        self.nodes, self.edges = list(map(Node.of, dumped["nodes"])), list(map(Edge.of, dumped["edges"]))
        self.actions = [ActionState(Action.of(raw), *rest) for raw, *rest in dumped["actions"]]
        for state in self.actions:
            if state.status == RUNNING and state.action.kind != "cancelOrder":
                state.end(FAILED, "the program was restarted")
        self.paused = dumped["paused"] or bool(self.nodes)


def _own(state: ActionState) -> bool:
    """True for what concerns the order and not the robot."""
    return state.sequence < 0 and state.action.kind in IMMEDIATE


def _refused(order: Order, kind: str, why: str, name: str = "", **references: object) -> RefusedError:
    """`name`: that of the error in version 3.0, as a further reference."""
    named = {"errorName": name} if name else {}
    return RefusedError(kind, f"order refused: {why}", **order.references, **references, **named)
