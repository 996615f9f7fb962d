"""Our client against a master by others, in virtual time: MasterClient of PyPI's vda5050-sdk. Its models and schemas
check every message of ours.
"""

import asyncio
import json

import pytest
from robot_control.fleet.v2.messages import time_text
from robot_control.fleet.v2.state import visualization
from support.pypi_package import imported
from support.virtual_robot import Run

from bench.fleet.messages import MANUFACTURER, SERIAL

TARGET = f"{MANUFACTURER}/{SERIAL}"
TOPIC = f"uagv/v2/{TARGET}"


class Wire:
    """A transport of the SDK: what the master publishes reaches the client, what the client sends the master."""

    def __init__(self, run):
        self.run, self.handlers, self.numbers, self.sent = run, [], {}, 0

    async def connect(self, *, will=None):
        self.run.client.connected()

    async def disconnect(self):
        pass

    async def publish(self, topic, payload, *, qos=0, retain=False):
        name = topic.rpartition("/")[2]
        payload = payload if isinstance(payload, bytes) else payload.encode()
        self.run.client.receive(name, payload, self.run.now, retained=retain)

    async def subscribe(self, topic, handler, *, qos=0):
        self.handlers.append((topic.rpartition("/")[2], handler))

    async def deliver(self, name, message):
        self.numbers[name] = self.numbers.get(name, -1) + 1
        head = {"headerId": self.numbers[name], "timestamp": time_text(self.run.now), "version": "2.1.0"}
        whole = {**head, "manufacturer": MANUFACTURER, "serialNumber": SERIAL, **message}
        for wanted, handler in self.handlers:
            if wanted == name:
                await handler(f"{TOPIC}/{name}", json.dumps(whole).encode())

    async def step(self, seconds):
        for _ in range(round(seconds / 0.1)):
            self.run.step(0.1)
            sent, self.sent = self.run.sent[self.sent :], len(self.run.sent)
            for name, message in sent:
                await self.deliver(name, message)
            await self.deliver("visualization", visualization(self.run.robot.facts()))


async def drive(vda5050):
    run = Run()
    wire = Wire(run)
    config = vda5050.MasterConfig(validate_messages=True, visualization=True)
    master = vda5050.MasterClient(config, transport=wire)
    states, errors, seen = [], [], []
    master.on_state(lambda state, _: states.append(state))
    master.on_error(errors.append)
    master.on_connection(lambda message, _: seen.append(message.connection_state.value))
    master.on_factsheet(lambda *_: seen.append("factsheet"))
    master.on_visualization(lambda *_: seen.append("visualization"))
    await master.connect()
    await wire.deliver("connection", {"connectionState": "ONLINE"})
    await wire.step(0.5)

    def builder(order_id):
        return vda5050.OrderBuilder(order_id=order_id, manufacturer=MANUFACTURER, serial_number=SERIAL)

    first = builder("o1").add_node("a", x=0.0, y=0.0, map_id="hall").add_edge("a", "b")
    first = first.add_node("b", x=1.0, y=0.0, map_id="hall").build()
    assert (await master.dispatch(first, TARGET)).accepted
    await wire.step(1.0)
    more = builder("x").add_node("b", x=1.0, y=0.0, map_id="hall").add_edge("b", "c")
    more = more.add_node("c", x=2.0, y=0.0, map_id="hall").add_edge("c", "d").add_node("d", x=3.0, y=0.0, map_id="hall")
    more = more.build()
    result = await master.extend_base(TARGET, list(more.nodes)[1:], list(more.edges))
    assert result.accepted, result
    await wire.step(4.0)
    await master.cancel_order(TARGET, action_id="cancel-1")
    await wire.step(4.0)
    at = run.robot.pose
    again = builder("o2").add_node("here", x=at.x, y=at.y, map_id="hall").add_edge("here", "a")
    again = again.add_node("a", x=0.0, y=0.0, map_id="hall").build()
    assert (await master.dispatch(again, TARGET)).accepted
    await wire.step(20.0)
    await master.disconnect()
    return run, states, errors, seen


def test_a_master_by_others_assigns_extends_cancels_and_sees_every_node():
    run, states, errors, seen = asyncio.run(drive(imported("vda5050", "fleet", "vda5050-sdk")))
    assert errors == []
    assert {"ONLINE", "factsheet", "visualization"} <= set(seen)
    reached = [(state.order_id, state.last_node_id) for state in states]
    for expected in (("o1", "a"), ("o1", "b"), ("o1", "c"), ("o2", "here"), ("o2", "a")):
        assert expected in reached
    ended = {each.action_id: each.action_status.value for state in states for each in state.action_states}
    assert ended["cancel-1"] == "FINISHED"
    assert not states[-1].node_states
    assert states[-1].errors == []
    assert (run.robot.pose.x, run.robot.pose.y) == pytest.approx((0.0, 0.0), abs=0.02)
