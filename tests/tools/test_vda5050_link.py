"""The connection of vda5050.py to a broker on the loopback: quality, will, TLS, password."""

import json
import subprocess
import sys
import time

import pytest
from robot_control.fleet.memory import Memory
from robot_control.fleet.settings import Settings

from bench.fleet.broker import Broker, missing

pytestmark = pytest.mark.skipif(bool(missing()), reason=missing())
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


def test_messages_of_the_master_arrive_bounded(tmp_path, broker):
    from robot_control.fleet.link import WAITING
    from robot_control.fleet.v2.messages import MAX_BYTES

    link = link_of(tmp_path, broker.port)
    link.begin()
    wait_for(lambda: link.came_up)
    sender = Listener(broker.port)
    topic = "uagv/v2/robot_control/r1/order"
    wait_for(lambda: (sender.client.publish(topic, b"{}"), time.sleep(0.1), link.received.qsize())[2])  # subscribed
    sender.client.publish(topic, b"x" * 10_000_000)
    sizes = []
    wait_for(lambda: (sizes.append(len(link.received.get(timeout=LIMIT)[1])), sizes[-1] > 2)[1])
    assert sizes[-1] == MAX_BYTES + 1
    for _ in range(3 * WAITING):
        sender.client.publish(topic, b"{}")
    wait_for(lambda: "one was dropped" in link.reason)
    assert link.received.qsize() == WAITING
    link.end()
    sender.end()


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
