"""Topics without a master: what a program subscribes to gets the bytes of a test, deserialized as rospy does it."""

from __future__ import annotations

import contextlib
import io
from collections import defaultdict
from collections.abc import Callable, Iterator
from types import SimpleNamespace

import genpy
import pytest
import rospy
from robot_control.robot import boundary as boundary_module
from robot_control.robot import robot_kind
from robot_control.robot.boundary import Boundary


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
        return {topic: getattr(rows[0][0], "kind", rows[0][0]) for topic, rows in self._subscribed.items() if rows}

    def send(self, topic: str, message: genpy.Message, sender: str = "/node") -> None:
        """A healthy message of this node."""
        self.send_bytes(topic, wire(message), sender)

    def send_bytes(self, topic: str, data: bytes, sender: str = "/node") -> None:
        """Whatever a publisher of the right type sends."""
        for kind, callback in list(self._subscribed[topic]):
            message = kind().deserialize(data)
            message._connection_header = {"callerid": sender, "type": kind._type}
            callback(message)


class Sink:
    """A publisher that serializes as rospy does."""

    resolved_name = "/topic"
    impl = SimpleNamespace(connections=[], get_stats=lambda: (None, None, []))

    def __init__(self, *_: object, **__: object) -> None:
        pass

    def get_num_connections(self) -> int:
        return 0

    def publish(self, message: genpy.Message) -> None:
        message.serialize(io.BytesIO())

    def unregister(self) -> None:
        pass


class Service:
    """A service that takes every request that can be serialized."""

    def __init__(self, _: str, kind: type) -> None:
        self._kind = kind

    def __call__(self, *fields: object) -> object:
        self._kind._request_class(*fields).serialize(io.BytesIO())
        return SimpleNamespace(success=True, message="")


@contextlib.contextmanager
def graph(monkeypatch: pytest.MonkeyPatch) -> Iterator[Topics]:
    """A graph without a master and without threads."""
    rospy.rostime.set_rostime_initialized(True)
    monkeypatch.setattr(rospy, "Publisher", Sink)
    monkeypatch.setattr(rospy, "ServiceProxy", Service)
    monkeypatch.setattr(rospy, "on_shutdown", lambda _: None)
    monkeypatch.setattr(rospy, "get_param", lambda _, default=None: default)
    monkeypatch.setattr("threading.Thread", lambda **_: SimpleNamespace(start=lambda: None))
    robot_kind.forget()
    yield Topics(monkeypatch)
    robot_kind.forget()
    rospy.rostime.set_rostime_initialized(False)


def surprises_of(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A list in which appears what the boundary of this process did not foresee."""
    found: list[str] = []
    fresh = Boundary(lambda said: found.append(said) if "Error: " in said else None)
    for name, value in vars(fresh).items():
        monkeypatch.setattr(boundary_module.boundary, name, value)
    return found
