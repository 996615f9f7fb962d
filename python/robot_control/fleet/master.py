"""fleet_master.py: a small master. It sends a square with updates and prints what the robot answers."""

import argparse
import json
import math
import queue
import sys
import time
import uuid
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from robot_control.fleet.v2.messages import Message, headed

PATIENCE = 120.0
"""s for one order"""


class Master:
    """One robot's topics, over paho."""

    def __init__(self, host: str, port: int, topic: str, version: str = "2.1.0") -> None:
        """`topic`: interface/v2/manufacturer/serialNumber. Raises OSError: there is no broker."""
        import paho.mqtt.client as mqtt

        self._topic, self._version, self._numbers = topic, version, {"order": 0, "instantActions": 0}
        self._received: queue.SimpleQueue[tuple[str, Message]] = queue.SimpleQueue()
        self.last: dict[str, Message] = {}
        self._client = mqtt.Client()
        self._client.on_connect = lambda client, *_: client.subscribe(f"{topic}/+")
        self._client.on_message = self._message
        self._client.connect(host, port)
        self._client.loop_start()

    def _message(self, _client: object, _data: object, message: Any) -> None:
        name = message.topic.rpartition("/")[2]
        if name not in self._numbers:
            self._received.put((name, json.loads(message.payload)))

    def send(self, topic: str, content: Message) -> None:
        """With its header."""
        _, _, manufacturer, serial = self._topic.split("/")
        self._numbers[topic] += 1
        payload = headed(self._numbers[topic], self._version, manufacturer, serial, content)
        self._client.publish(f"{self._topic}/{topic}", payload)

    def act(self, kind: str, action_id: str = "", /, **parameters: object) -> str:
        """Sends an instant action, again if its id is given; its actionId."""
        action_id = action_id or str(uuid.uuid4())
        pairs = [{"key": key, "value": value} for key, value in parameters.items()]
        action = {"actionId": action_id, "actionType": kind, "blockingType": "HARD", "actionParameters": pairs}
        self.send("instantActions", {"actions": [action]})
        return action_id

    def messages(self, seconds: float) -> Iterator[tuple[str, Message]]:
        """The messages of this time, as they come."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                name, message = self._received.get(timeout=left)
            except queue.Empty:
                return
            self.last[name] = message
            yield name, message

    def end(self) -> None:
        """Disconnects."""
        self._client.disconnect()
        self._client.loop_stop()


def square(size: float, map_id: str, speed: float) -> list[tuple[list[Message], list[Message]]]:
    """Nodes and edges of a square: the first two sides, then each further one as an update."""
    corners = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size), (0.0, 0.0)]
    nodes: list[Message] = [
        {"nodeId": f"corner{number % 4}", "nodePosition": {"x": x, "y": y, "mapId": map_id}}
        for number, (x, y) in enumerate(corners)
    ]
    nodes[-1]["nodePosition"]["theta"] = 0.0
    ends = [{"startNodeId": before["nodeId"], "endNodeId": after["nodeId"]} for before, after in pairwise(nodes)]
    edges: list[Message] = [{"edgeId": f"side{number}", "maxSpeed": speed, **end} for number, end in enumerate(ends)]
    for first, elements in ((0, nodes), (1, edges)):
        for number, element in enumerate(elements):
            element |= {"sequenceId": 2 * number + first, "released": True, "actions": []}
    return [(nodes[0:3], edges[0:2]), (nodes[2:4], edges[2:3]), (nodes[3:5], edges[3:4])]


def summary(state: Message) -> str:
    """One line."""
    at = state["agvPosition"]
    errors = ", ".join(f"{each['errorType']}: {each['errorDescription']}" for each in state["errors"])
    return (
        f"order {state['orderId'] or '-'} update {state['orderUpdateId']}, last node {state['lastNodeId'] or '-'}, "
        f"{len(state['nodeStates'])} nodes to go, x {at['x']:.2f} y {at['y']:.2f} "
        f"{math.degrees(at['theta']):.0f} deg, {'driving' if state['driving'] else 'standing'}"
        f"{', paused' if state.get('paused') else ''}{', wants a base' if state.get('newBaseRequest') else ''}"
        f"{'; ' + errors if errors else ''}"
    )


def drive(master: Master, given: argparse.Namespace) -> str:
    """Why the square was not driven; empty if it was."""
    action = ""  # initPosition, once the robot is there
    order, parts = str(uuid.uuid4())[:8], square(given.size, given.map, given.speed)
    sent = 0
    for name, message in master.messages(PATIENCE):
        if name == "connection":
            print(f"connection: {message['connectionState']}")
        if name != "state" or master.last.get("connection", {}).get("connectionState") != "ONLINE":
            continue
        if not action:
            action = master.act("initPosition", x=0.0, y=0.0, theta=0.0, mapId=given.map)
            master.act("stopPause")
        print(summary(message))
        known = {each["actionId"]: each for each in message["actionStates"]}
        if not sent and known.get(action, {}).get("actionStatus") == "FAILED":
            return f"initPosition failed: {known[action].get('resultDescription', '')}"
        placed = sent or known.get(action, {}).get("actionStatus") == "FINISHED"
        taken = not sent or (message["orderId"], message["orderUpdateId"]) == (order, sent - 1)
        refused = [each for each in message["errors"] if ("orderId", order) in map(_pair, each["errorReferences"])]
        if refused:
            return str(refused[0]["errorDescription"])
        if placed and taken and sent < len(parts):
            nodes, edges = parts[sent]
            master.send("order", {"orderId": order, "orderUpdateId": sent, "nodes": nodes, "edges": edges})
            sent += 1
        elif sent == len(parts) and taken and not message["nodeStates"] and not message["driving"]:
            return ""
    return f"not completed within {PATIENCE:g} s" if action else "the robot is not ONLINE: start vda5050.py"


def _pair(reference: Message) -> tuple[str, str]:
    return reference["referenceKey"], reference["referenceValue"]


def main() -> None:
    """Entry point of scripts/fleet_master.py."""
    parser = argparse.ArgumentParser(
        prog="fleet_master.py",
        description="A small master of VDA 5050, to try vda5050.py. It sets the position of the robot (initPosition), "
        "sends a square as an order with two updates, and prints every state. Exit code 0: it was driven.",
    )
    for name, default, meaning in (
        ("--host", "127.0.0.1", "of the broker"),
        ("--port", 1883, "of the broker"),
        ("--topic", "uagv/v2/robot_control/r1", "of the robot"),
        ("--map", "hall", "mapId"),
        ("--size", 2.0, "m, side of the square"),
        ("--speed", 0.4, "m/s, maxSpeed of its edges"),
    ):
        parser.add_argument(name, type=type(default), default=default, help=f"{meaning} (default %(default)s)")
    given = parser.parse_args()
    try:
        master = Master(given.host, given.port, given.topic)
    except ImportError:
        sys.exit("fleet_master.py: needs Debian's python3-paho-mqtt: scripts/setup --fleet")
    except OSError as error:
        sys.exit(f"fleet_master.py: no broker at {given.host}:{given.port}: {error.strerror or error}")
    why = drive(master, given)
    master.end()
    if why:
        sys.exit(f"fleet_master.py: {why}")
    print("driven")
