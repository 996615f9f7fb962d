"""Topics without a master: what a program subscribes to gets the bytes of a test, deserialized as rospy does it."""

from __future__ import annotations

import io
from collections import defaultdict
from collections.abc import Callable
from types import SimpleNamespace

import genpy
import pytest
import rospy


def wire(message: genpy.Message) -> bytes:
    """The message as it crosses a connection."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


class Topics:
    """All subscriptions of a test, by name of the topic."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self._subscribed: dict[str, list[tuple[type, Callable[..., None]]]] = defaultdict(list)
        monkeypatch.setattr(rospy, "Subscriber", self._subscribe)

    def _subscribe(self, topic: str, kind: type, callback: Callable[..., None], *_: object, **__: object) -> object:
        one = kind, callback
        self._subscribed[topic].append(one)
        return SimpleNamespace(unregister=lambda: self._subscribed[topic].remove(one))

    def __contains__(self, topic: str) -> bool:
        return bool(self._subscribed[topic])

    @property
    def types(self) -> dict[str, type]:
        """Topic → type of its messages."""
        return {topic: rows[0][0].kind for topic, rows in self._subscribed.items() if rows}

    def send(self, topic: str, message: genpy.Message, sender: str = "/node") -> None:
        """A healthy message of this node."""
        self.send_bytes(topic, wire(message), sender)

    def send_bytes(self, topic: str, data: bytes, sender: str = "/node") -> None:
        """Whatever a publisher of the right type sends."""
        for kind, callback in list(self._subscribed[topic]):
            message = kind().deserialize(data)
            message._connection_header = {"callerid": sender, "type": kind._type}
            callback(message)
