"""The connection to the broker (6.2, 6.14): what is sent with which quality, and what was received.

Another client of the same serial number shows itself on `connection`. The robot's own messages come back there, too.
Paho sends again those that were not acknowledged, and a broker that was restored sends old retained ones. The file
therefore holds the digests of the last OWN of them. An empty message only ends a retained one.
"""

import math
import queue
import ssl
import sys
import time
from collections import deque
from typing import Any

import paho.mqtt.client as mqtt

from robot_control.files.kept_file import digest_of
from robot_control.fleet.memory import Memory
from robot_control.fleet.settings import Settings
from robot_control.fleet.v2.messages import INBOUND, MAX_BYTES, Message, headed
from robot_control.robot.boundary import UnfitError, boundary

RETRY = (1, 30)
"""s between two tries to connect: the first, and the longest after doubling"""
WAITING = 1000
"""messages that may wait; further ones are dropped. So many are taken in 0.1 s"""
FEW, SMALL = 50, 1 << 13
"""messages that may wait where the next one has more than so many bytes or is no object: they keep no other one out"""
OWN = 200
"""messages on `connection`; a robot that loses the broker each 30 s sends so many in 100 minutes"""
BROKER_CHECK = 5.0
"""s between two looks of mosquitto for silent clients; by so much its will may come later than 1.5 keep-alives"""
END = 2.0
"""s for the last message"""
RETAINED = ("connection", "factsheet")


class Link:
    """One connection, which is made again by itself. `received` and `came_up` are read by the thread that drives."""

    def __init__(self, settings: Settings, memory: Memory) -> None:
        self._settings, self._memory = settings, memory
        self.received: queue.SimpleQueue[tuple[str, bytes, bool]] = queue.SimpleQueue()
        self.up = False
        self.came_up = False  # a connection was made; the reader sets it back
        self.reason = ""  # why there is none
        self._connections = 0
        self._own: deque[str] = deque(memory["connection"] or (), OWN)
        name = f"{settings.manufacturer}-{settings.serial_number}"
        self._client = mqtt.Client(client_id=name, clean_session=True)
        self._client.on_connect, self._client.on_disconnect = self._connected, self._disconnected
        self._client.on_message, self._client.on_connect_fail = self._message, self._failed
        self._client.reconnect_delay_set(*RETRY)
        if settings.user:
            self._client.username_pw_set(settings.user, settings.password)
        if settings.ca_file:
            certificate = (settings.certificate_file or None, settings.key_file or None)
            self._client.tls_set(settings.ca_file, *certificate, tls_version=ssl.PROTOCOL_TLS_CLIENT)
        broken = self._bytes("connection", {"connectionState": "CONNECTIONBROKEN"})
        self._client.will_set(self._topic("connection"), broken, qos=1, retain=True)

    def begin(self) -> None:
        """Connects, now or as soon as the broker answers."""
        keep_alive = max(1, math.floor(self._settings.keep_alive - BROKER_CHECK / 1.5))
        self._client.connect_async(self._settings.host, self._settings.port, keep_alive)
        self._client.loop_start()

    def publish(self, topic: str, message: Message) -> mqtt.MQTTMessageInfo | None:
        """Sends it with a header, if there is a connection: what is old by then helps no master."""
        if not self.up:
            return None
        quality, payload = int(topic == "connection"), self._bytes(topic, message)
        return self._client.publish(self._topic(topic), payload, qos=quality, retain=topic in RETAINED)

    def end(self) -> None:
        """OFFLINE, then the orderly end."""
        last = self.publish("connection", {"connectionState": "OFFLINE"})
        end = time.monotonic() + END
        while last is not None and not last.rc and not last.is_published() and time.monotonic() < end:
            time.sleep(0.01)
        self._client.disconnect()
        self._client.loop_stop()

    def _topic(self, name: str) -> str:
        return f"{self._settings.topic}/{name}"

    def _bytes(self, topic: str, message: Message) -> bytes:
        given, number = self._settings, self._memory.header_id(topic)
        payload = headed(number, given.version, given.manufacturer, given.serial_number, message)
        if topic == "connection":
            self._own.append(digest_of(payload))
            self._memory.save(connection=list(self._own))
        return payload

    def _connected(self, client: mqtt.Client, _data: Any, _flags: Any, code: int) -> None:
        self.reason = mqtt.connack_string(code) if code else ""
        if code:
            return
        self._connections += 1
        client.subscribe([(self._topic(name), 0) for name in (*INBOUND, "connection")])
        self.up = True
        self.publish("connection", {"connectionState": "ONLINE"})
        self.came_up = True

    def _failed(self, _client: mqtt.Client, _data: Any) -> None:
        self.reason = str(sys.exception() or "it does not answer")  # paho calls this where it handles the exception

    def _disconnected(self, _client: mqtt.Client, _data: Any, code: int) -> None:
        self.up = False
        self.reason = self.reason or (mqtt.error_string(code) if code else "")

    def _message(self, _client: mqtt.Client, _data: Any, message: mqtt.MQTTMessage) -> None:
        with boundary.crossing("mqtt"):  # an exception would end paho's thread
            topic = message.topic.rpartition("/")[2]
            payload = message.payload[: MAX_BYTES + 1]  # one byte more than is taken
            if topic == "connection":
                before = message.retain and self._connections == 1  # of this robot's program before
                if before or not payload or digest_of(payload) in self._own:
                    return
            plain = len(payload) <= SMALL and payload.lstrip()[:1] == b"{"
            if self.received.qsize() >= (WAITING if plain else FEW):
                raise UnfitError(f"{topic}: {self.received.qsize()} messages wait")
            self.received.put((topic, payload, bool(message.retain)))
