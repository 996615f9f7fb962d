"""The connection of vda5050.py to a broker on the loopback: quality, will, TLS, password."""

import json
import subprocess
import sys
import time
from types import SimpleNamespace

import pytest
from robot_control.fleet.main import Node
from robot_control.fleet.master import Master
from robot_control.fleet.memory import Memory
from robot_control.fleet.settings import Settings
from robot_control.robot.boundary import Boundary
from support.virtual_robot import Run

from bench.fleet.broker import Broker, missing

pytestmark = pytest.mark.skipif(bool(missing()), reason=missing())
ACTIONS = "uagv/v2/robot_control/r1/instantActions"
LIMIT = 20.0  # s; on an idle machine everything here takes a second


def wait_for(condition):
    end = time.monotonic() + LIMIT
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


class Listener:
    """A master's view of the topics."""

    def __init__(self, port):
        import paho.mqtt.client as mqtt

        self.messages, self.ready = [], False
        self.client = mqtt.Client()
        self.client.on_connect = lambda client, *_: client.subscribe("uagv/#", qos=1)
        self.client.on_subscribe = lambda *_: setattr(self, "ready", True)
        self.client.on_message = lambda *given: self.messages.append(given[-1])
        self.client.connect("127.0.0.1", port)
        self.client.loop_start()
        wait_for(lambda: self.ready)

    def states(self, *, retained=False):
        of_connection = [each for each in self.messages if each.topic.endswith("/connection")]
        return [json.loads(each.payload)["connectionState"] for each in of_connection if each.retain == retained]

    def end(self):
        self.client.disconnect()
        self.client.loop_stop()


@pytest.fixture
def broker(tmp_path):
    broker = Broker(tmp_path)
    yield broker
    broker.end()


def link_of(tmp_path, port, **values):
    from robot_control.fleet.link import Link

    return Link(Settings(port=port, keep_alive=2, **values), Memory(tmp_path / "memory.json"))


def test_online_is_retained_after_every_connection_and_offline_before_the_end(tmp_path, broker):
    listener = Listener(broker.port)
    link = link_of(tmp_path, broker.port)
    link.begin()
    wait_for(lambda: listener.states() == ["ONLINE"])
    assert next(each.qos for each in listener.messages) == 1
    link.publish("factsheet", {})
    late = Listener(broker.port)
    wait_for(lambda: {each.topic.rpartition("/")[2] for each in late.messages} == {"connection", "factsheet"})
    assert late.states(retained=True) == ["ONLINE"]
    late.end()
    listener.end()
    broker.kill()
    wait_for(lambda: not link.up)
    assert link.publish("state", {}) is None
    broker.start()
    again = Listener(broker.port)
    wait_for(lambda: "ONLINE" in again.states() + again.states(retained=True))
    link.end()
    wait_for(lambda: again.states()[-1:] == ["OFFLINE"])
    again.end()


def test_two_clients_of_one_serial_number_notice_each_other_and_one_does_not_notice_itself(tmp_path, broker):
    folders = [tmp_path / "first", tmp_path / "second"]
    for folder in folders:
        folder.mkdir()
    first = link_of(folders[0], broker.port)
    first.begin()
    wait_for(lambda: first.came_up)
    broker.kill()
    wait_for(lambda: not first.up)
    first.came_up = False
    broker.start()
    wait_for(lambda: first.came_up)
    time.sleep(0.5)
    assert first.received.empty()
    second = link_of(folders[1], broker.port)  # not in the millisecond of the first: their wills would be equal
    second.begin()
    links = (first, second)
    for each in links:
        wait_for(lambda each=each: not each.received.empty())
        assert each.received.get()[0] == "connection"
    for each in links:
        each.end()


def noticed(link):
    """Messages on connection that are taken for those of another client."""
    time.sleep(0.5)
    return [link.received.get()[:2] for _ in range(link.received.qsize())]


def test_what_this_robot_said_on_connection_is_not_another_client(tmp_path, broker):
    """From a broker that kept it over its end, from a program before, or sent again as it was not acknowledged."""
    listener = Listener(broker.port)
    link = link_of(tmp_path, broker.port)
    link.begin()
    wait_for(lambda: listener.states() == ["ONLINE"])
    link.end()
    wait_for(lambda: listener.states()[-1] == "OFFLINE")
    topic = "uagv/v2/robot_control/r1/connection"
    again = link_of(tmp_path, broker.port)
    again.begin()
    wait_for(lambda: again.came_up)
    wait_for(lambda: listener.states() == ["ONLINE", "OFFLINE", "ONLINE"])
    said = [each.payload for each in listener.messages if each.topic.endswith("/connection") and not each.retain]
    again.came_up = False
    broker.kill()
    broker.start()
    with_memory = Listener(broker.port)
    for payload in (*said, b""):
        with_memory.client.publish(topic, payload, qos=1, retain=True)
    wait_for(lambda: again.came_up)
    for payload in (*said, b""):
        with_memory.client.publish(topic, payload, qos=1, retain=True)
    assert noticed(again) == []
    other = said[0].replace(b'"headerId":1', b'"headerId":7')
    assert other != said[0]
    with_memory.client.publish(topic, other, qos=1)
    wait_for(lambda: not again.received.empty())
    assert noticed(again) == [("connection", other)]
    again.end()
    listener.end()
    with_memory.end()


PROGRAM = """
import sys, time
from pathlib import Path
from robot_control.fleet.link import Link
from robot_control.fleet.memory import Memory
from robot_control.fleet.settings import Settings
link = Link(Settings(port=int(sys.argv[1]), keep_alive=2), Memory(Path(sys.argv[2])))
link.begin()
time.sleep(60)
"""


def test_a_killed_client_leaves_its_will(tmp_path, broker):
    listener = Listener(broker.port)
    client = subprocess.Popen([sys.executable, "-c", PROGRAM, str(broker.port), str(tmp_path / "memory.json")])
    wait_for(lambda: listener.states() == ["ONLINE"])
    client.kill()
    client.wait()
    wait_for(lambda: listener.states() == ["ONLINE", "CONNECTIONBROKEN"])
    listener.end()


def subscribed(tmp_path, broker):
    """A link, and a sender whose messages on instantActions arrive there."""
    link = link_of(tmp_path, broker.port)
    link.begin()
    wait_for(lambda: link.came_up)
    sender = Listener(broker.port)
    wait_for(lambda: (sender.client.publish(ACTIONS, b"{}"), time.sleep(0.1), link.received.qsize())[2])
    return link, sender


def test_messages_of_the_master_arrive_bounded_and_what_is_dropped_is_counted(tmp_path, broker, monkeypatch):
    from robot_control.fleet import link as module
    from robot_control.fleet.v2.messages import MAX_BYTES

    counted = Boundary(lambda _: None)
    monkeypatch.setattr(module, "boundary", counted)
    link, sender = subscribed(tmp_path, broker)
    sender.client.publish(ACTIONS, b"x" * 10_000_000)
    sizes = []
    wait_for(lambda: (sizes.append(len(link.received.get(timeout=LIMIT)[1])), sizes[-1] > 2)[1])
    assert sizes[-1] == MAX_BYTES + 1
    for _ in range(3 * module.FEW):
        sender.client.publish(ACTIONS, b"x" * (module.SMALL + 1))
    wait_for(lambda: counted.dropped.get("mqtt", 0) == 2 * module.FEW)
    assert link.received.qsize() == module.FEW
    for _ in range(2 * module.WAITING):
        sender.client.publish(ACTIONS, b"{}")
    wait_for(lambda: counted.dropped["mqtt"] > 2 * module.FEW)
    assert link.received.qsize() == module.WAITING
    link.end()
    sender.end()


def test_what_is_no_message_leaves_room_for_those_that_are_one(tmp_path, broker):
    link = link_of(tmp_path, broker.port)
    request = b'{"actions": []}'
    for payload in (*[b"x"] * 10_000, request):
        link._message(None, None, SimpleNamespace(topic=ACTIONS, payload=payload, retain=False))
    waiting = [link.received.get()[1] for _ in range(link.received.qsize())]
    assert waiting[-1] == request
    assert len(waiting) < 100


FLOOD = """
import sys, time
import paho.mqtt.client as mqtt
client = mqtt.Client()
client.connect("127.0.0.1", int(sys.argv[1]))
client.loop_start()
while True:
    for _ in range(100):
        client.publish(sys.argv[2], b"x")
    time.sleep(0.02)
"""


def test_a_flood_of_one_byte_keeps_no_state_request_out(tmp_path, broker):
    """The passes of vda5050.py, with a robot in virtual time, while 5,000 messages come per second."""
    link, sender = subscribed(tmp_path, broker)
    sender.end()
    run, node = Run(), Node.__new__(Node)
    node.__dict__ |= {"link": link, "robot": SimpleNamespace(position=None), "client": run.client, "_saved": None}
    node.__dict__ |= {
        "_memory": Memory(tmp_path / "node.json"),
        "_save_at": 0.0,
        "_reason": "",
    }
    master = Master("127.0.0.1", broker.port, "uagv/v2/robot_control/r1")
    while not link.received.empty():
        link.received.get()
    node.step()
    flood = subprocess.Popen([sys.executable, "-c", FLOOD, str(broker.port), ACTIONS])
    waited, asked, request = [], time.monotonic(), master.act("stateRequest")
    over = asked + 8.0
    try:
        while time.monotonic() < over:
            node.step()
            for topic, message in master.messages(0.02):
                if topic == "state" and request in [each["actionId"] for each in message["actionStates"]]:
                    waited.append(time.monotonic() - asked)
                    asked, request = time.monotonic(), master.act("stateRequest")
    finally:
        flood.kill()
        flood.wait()
        master.end()
        link.end()
    assert len(waited) > 5
    assert max(waited) < 5.0  # on an idle machine 0.1 s


def openssl(folder, *words):
    subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True)


def test_tls_and_a_password_and_what_is_wrong_with_them(tmp_path, broker):
    subject = ("-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost")
    for name in ("ca", "other"):
        pair = ("-keyout", f"{name}.key", "-out", f"{name}.pem")
        openssl(tmp_path, "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", *pair, *subject)
    passwords = tmp_path / "passwords"
    subprocess.run(["mosquitto_passwd", "-b", "-c", str(passwords), "r1", "secret"], check=True, capture_output=True)
    for path in (passwords, tmp_path / "ca.key"):
        path.chmod(0o644)  # mosquitto gives up its rights
    for folder in (tmp_path, *tmp_path.parents[:2]):
        folder.chmod(0o755)
    lines = [f"certfile {tmp_path}/ca.pem", f"keyfile {tmp_path}/ca.key", f"password_file {passwords}"]
    broker.configure("allow_anonymous false", *lines)
    secret = tmp_path / "password"
    secret.write_text("secret\n")
    right = {"host": "localhost", "ca_file": str(tmp_path / "ca.pem"), "user": "r1", "password_file": str(secret)}
    link = link_of(tmp_path, broker.port, **right)
    link.begin()
    wait_for(lambda: link.up)
    link.end()
    wrong = tmp_path / "wrong"
    wrong.write_text("wrong\n")
    for change, words in (
        ({"password_file": str(wrong)}, "not authorised"),
        ({"ca_file": str(tmp_path / "other.pem")}, "certificate verify failed"),
        ({"host": "127.0.0.1"}, "certificate verify failed"),
    ):
        link = link_of(tmp_path, broker.port, **(right | change))
        link.begin()
        wait_for(lambda words=words, link=link: words in link.reason)
        assert not link.came_up
        link.end()


def test_a_broker_that_is_not_there_is_reported(tmp_path, broker):
    broker.kill()
    link = link_of(tmp_path, broker.port)
    link.begin()
    wait_for(lambda: "refused" in link.reason)
    link.end()
