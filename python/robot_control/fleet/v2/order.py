"""An order: nodes, edges and actions, with the rules that a valid one keeps (6.6.1, 6.6.6)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from robot_control.fleet.v2.messages import Message, RefusedError

NONE, SOFT, HARD = "NONE", "SOFT", "HARD"


@dataclass(frozen=True)
class Action:
    """An action of a node, of an edge, or instant."""

    raw: Message = field(repr=False)
    id: str
    kind: str  # actionType
    blocking: str

    @classmethod
    def of(cls, raw: Message) -> Action:
        """From its message."""
        return cls(raw, raw["actionId"], raw["actionType"], raw["blockingType"])

    @property
    def parameters(self) -> dict[str, Any]:
        """Values of its keys."""
        return {each["key"]: each["value"] for each in self.raw.get("actionParameters", [])}


@dataclass(frozen=True)
class Place:
    """The position of a node on its map."""

    x: float  # m
    y: float  # m
    theta: float | None  # rad
    deviation_xy: float  # m; 0: the tolerance of the robot
    deviation_theta: float | None  # rad; 0: the tolerance of the robot, None: none is given
    map_id: str


@dataclass(frozen=True)
class Node:
    """A node with its actions."""

    raw: Message = field(repr=False)
    id: str
    sequence: int
    released: bool
    place: Place | None
    actions: tuple[Action, ...]

    @classmethod
    def of(cls, raw: Message) -> Node:
        """From its message."""
        at = raw.get("nodePosition")
        place = at and Place(
            at["x"],
            at["y"],
            at.get("theta"),
            at.get("allowedDeviationXY", 0.0),
            at.get("allowedDeviationTheta"),
            at["mapId"],
        )
        actions = tuple(map(Action.of, raw["actions"]))
        return cls(raw, raw["nodeId"], int(raw["sequenceId"]), raw["released"], place, actions)


@dataclass(frozen=True)
class Edge:
    """The way from one node to the next."""

    raw: Message = field(repr=False)
    id: str
    sequence: int
    released: bool
    actions: tuple[Action, ...]

    @classmethod
    def of(cls, raw: Message) -> Edge:
        """From its message."""
        actions = tuple(map(Action.of, raw["actions"]))
        return cls(raw, raw["edgeId"], int(raw["sequenceId"]), raw["released"], actions)


@dataclass(frozen=True)
class Order:
    """A valid order, or an update of one."""

    id: str
    update: int
    nodes: tuple[Node, ...]
    edges: tuple[Edge, ...]
    zone_set: str = ""

    @property
    def elements(self) -> list[Node | Edge]:
        """Nodes and edges by their sequenceId."""
        return in_sequence(self.nodes, self.edges)

    @property
    def references(self) -> dict[str, object]:
        """For an error about it."""
        return {"orderId": self.id, "orderUpdateId": self.update}


def in_sequence(nodes: Sequence[Node], edges: Sequence[Edge]) -> list[Node | Edge]:
    """Nodes and edges by their sequenceId."""
    return sorted([*nodes, *edges], key=lambda each: each.sequence)


def order_of(message: Message) -> Order:
    """The order of a message that the schema allows.

    Raises:
        RefusedError: validationError, for it breaks a rule of its structure.
    """
    nodes, edges = tuple(map(Node.of, message["nodes"])), tuple(map(Edge.of, message["edges"]))
    order = Order(message["orderId"], int(message["orderUpdateId"]), nodes, edges, message.get("zoneSetId", ""))
    for rule, path in _broken(order):
        raise RefusedError("validationError", f"{path}: {rule}", parameter=path, **order.references)
    return order


def _broken(order: Order) -> Iterator[tuple[str, str]]:
    """Rules that are broken, with the path of the field."""
    if not order.id:
        yield "must not be empty", "orderId"
    if len(order.edges) != len(order.nodes) - 1:
        yield f"{len(order.nodes)} nodes need {max(0, len(order.nodes) - 1)} edges, not {len(order.edges)}", "edges"
        return
    if order.nodes[0].sequence % 2:
        yield "the sequenceId of a node must be even", "nodes[0].sequenceId"
    for number, node in enumerate(order.nodes):
        if node.sequence != order.nodes[0].sequence + 2 * number:
            yield "must run over nodes and edges without a gap", f"nodes[{number}].sequenceId"
    for number, edge in enumerate(order.edges):
        begin, end = order.nodes[number], order.nodes[number + 1]
        if edge.sequence != begin.sequence + 1:
            yield "must run over nodes and edges without a gap", f"edges[{number}].sequenceId"
        if (edge.raw["startNodeId"], edge.raw["endNodeId"]) != (begin.id, end.id):
            yield f"must lead from {begin.id} to {end.id}", f"edges[{number}]"
    yield from _broken_releases(order.elements)
    ids = [action.id for each in order.elements for action in each.actions]
    if len(set(ids)) < len(ids) or "" in ids:
        yield "each action needs an id of its own", "actionId"


def _broken_releases(elements: list[Node | Edge]) -> Iterator[tuple[str, str]]:
    """The base comes first, and it ends with a node."""
    if not elements[0].released:
        yield "the first node must be released", "nodes[0].released"
    for before, after in pairwise(elements):
        if after.released and not before.released:
            yield "a released part must not follow an unreleased one", f"sequenceId {after.sequence}"
    for before, after in pairwise(elements):
        if isinstance(before, Edge) and before.released and not after.released:
            yield "an edge is released only with both its nodes", f"sequenceId {before.sequence}"
