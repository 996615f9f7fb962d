"""Orders and instant actions as a master sends them, for tests and measurements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

MANUFACTURER, SERIAL = "robot_control", "r1"
Message = dict[str, Any]


def header(number: int = 1) -> Message:
    """The header of any message."""
    return {
        "headerId": number,
        "timestamp": "2026-01-31T12:00:00.00Z",
        "version": "2.1.0",
        "manufacturer": MANUFACTURER,
        "serialNumber": SERIAL,
    }


def action(kind: str, number: object, blocking: str = "NONE", **parameters: object) -> Message:
    """An action with the id `number`."""
    result: Message = {"actionType": kind, "actionId": str(number), "blockingType": blocking}
    if parameters:
        result["actionParameters"] = [{"key": key, "value": value} for key, value in parameters.items()]
    return result


def order(
    places: Sequence[tuple[float, ...]],
    released: int | None = None,
    *,
    name: str = "o1",
    update: int = 0,
    first: int = 0,
    actions: dict[int, list[Message]] | None = None,
    **edge_fields: object,
) -> Message:
    """Nodes n0, n1 … at these x, y and, where given, theta.

    Args:
        places: of the nodes.
        released: number of nodes in the base; None: all.
        name: orderId.
        update: orderUpdateId.
        first: number of the first node.
        actions: by sequenceId.
        edge_fields: of each edge.
    """
    base = len(places) if released is None else released
    given = actions or {}
    nodes: list[Message] = []
    for number, place in enumerate(places):
        at: Message = {"x": place[0], "y": place[1], "mapId": "hall"}
        if len(place) > 2:
            at["theta"] = place[2]
        sequence = 2 * (first + number)
        node = {"nodeId": f"n{first + number}", "sequenceId": sequence, "released": number < base}
        nodes.append({**node, "nodePosition": at, "actions": given.get(sequence, [])})
    edges: list[Message] = [
        {
            "edgeId": f"e{number}",
            "sequenceId": 2 * number + 1,
            "released": number - first + 1 < base,
            "startNodeId": f"n{number}",
            "endNodeId": f"n{number + 1}",
            "actions": given.get(2 * number + 1, []),
            **edge_fields,
        }
        for number in range(first, first + len(places) - 1)
    ]
    return {**header(), "orderId": name, "orderUpdateId": update, "nodes": nodes, "edges": edges}


def unknown_names(message: Any, described: Message, path: str = "") -> list[str]:
    """Paths of fields that the schema does not describe, which it does not forbid."""
    if isinstance(message, list):
        items = described.get("items", {})
        return [name for number, each in enumerate(message) for name in unknown_names(each, items, f"{path}[{number}]")]
    known = described.get("properties")
    if not isinstance(message, dict) or known is None:
        return []
    wrong = [f"{path}.{name}" for name in message if name not in known]
    return wrong + [
        each
        for name, value in message.items()
        if name in known
        for each in unknown_names(value, known[name], f"{path}.{name}")
    ]
