"""Says what this robot can do of an order, as the factsheet does."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from robot_control.drive.path.waypoints import JUMP
from robot_control.fleet.v2.curve import STEP
from robot_control.fleet.v2.leg import way_of
from robot_control.fleet.v2.messages import RefusedError
from robot_control.fleet.v2.order import Action, Node, Order

MAX_POINTS = 10_000
"""of all edges of an order: 500 m of curves, which are planned in less than 0.1 s"""
INSTANT, NODE, EDGE = "INSTANT", "NODE", "EDGE"


@dataclass(frozen=True)
class ActionKind:
    """An actionType with its scopes, and the parameters that it needs."""

    scopes: tuple[str, ...]
    needs: tuple[str, ...] = ()
    description: str = ""


STANDARD = {
    "startPause": ActionKind((INSTANT,)),
    "stopPause": ActionKind((INSTANT,)),
    "cancelOrder": ActionKind((INSTANT,)),
    "stateRequest": ActionKind((INSTANT,)),
    "factsheetRequest": ActionKind((INSTANT,)),
    "logReport": ActionKind((INSTANT,), description="resultDescription: the newest incident of the black box"),
    "initPosition": ActionKind((INSTANT,), ("x", "y", "theta", "mapId"), "at standstill without an order"),
    "waitForTrigger": ActionKind((NODE,), description="until the service vda5050/trigger is called"),
}


@dataclass(frozen=True)
class Capabilities:
    """The capabilities of one robot."""

    map_id: str = ""  # of the map on which it is; empty: not known
    height: float = 0.0  # m
    actions: Mapping[str, ActionKind] = field(default_factory=lambda: dict(STANDARD))

    def refuse(self, order: Order, last: Node | None = None) -> None:
        """Raises RefusedError: orderError with the field. `last`: the node that an update continues."""
        try:
            self._check(order, last)
        except RefusedError as error:
            found = error.error
            references = dict(found.references) | order.references
            raise RefusedError(found.kind, found.description, **references) from None

    def refuse_action(self, action: Action, scope: str) -> None:
        """Raises RefusedError: orderError, for it is unknown there or lacks a parameter."""
        kind = self.actions.get(action.kind)
        if kind is None or scope not in kind.scopes:
            why = "is not known" if kind is None else f"is not possible on {scope}"
            raise _refused(f"actionType {action.kind} {why}", **_of(action), parameter="actionType")
        for name in kind.needs:
            if name not in action.parameters:
                raise _refused(f"{action.kind} needs {name}", **_of(action), parameter=name)

    def _check(self, order: Order, last: Node | None) -> None:
        if not self.map_id:
            raise _refused("the position of the robot is not initialized: send initPosition")
        if order.zone_set:
            raise _refused("the robot has no zones", parameter="zoneSetId")
        points = 0.0
        nodes = [last or order.nodes[0], *order.nodes[1:]]
        for node in nodes:
            if node.place is None:
                raise _refused(f"node {node.id} needs a nodePosition", nodeId=node.id)
            if node.place.map_id != self.map_id:
                why = f"node {node.id} lies on map {node.place.map_id}, the robot on {self.map_id}"
                unknown = {"mapId": node.place.map_id, "errorName": "UNKNOWN_MAP_ID"}
                raise _refused(why, nodeId=node.id, **unknown)
            for action in node.actions:
                self.refuse_action(action, NODE)
        for edge, begin, end in zip(order.edges, nodes, nodes[1:], strict=False):
            if edge.raw.get("maxHeight", self.height) < self.height:
                why = f"edge {edge.id}: maxHeight is below the robot's {self.height:g} m"
                raise _refused(why, edgeId=edge.id, parameter="maxHeight")
            if begin.place is not None and end.place is not None:
                way = way_of(edge, begin.place, end.place)
                points += len(way.points) + way.length / JUMP
            if points > MAX_POINTS:
                why = f"edge {edge.id}: the path has more than {MAX_POINTS} points, one each {STEP:g} to {JUMP:g} m"
                raise _refused(why, edgeId=edge.id, parameter="trajectory")
            for action in edge.actions:
                self.refuse_action(action, EDGE)


def _refused(why: str, **references: str) -> RefusedError:
    return RefusedError("orderError", why, **references)


def _of(action: Action) -> dict[str, str]:
    return {"actionId": action.id, "errorName": "INVALID_ORDER_ACTION"}
