"""The server of the console without a robot."""

import pytest
from robot_control.watch.console.settings import Settings
from support.topics import graph


def served(monkeypatch, known):
    """A client of a server with these users."""
    pytest.importorskip("aiohttp")
    from aiohttp.test_utils import TestClient, TestServer
    from robot_control.settings.addresses import Origins
    from robot_control.watch.console.backend import Backend
    from robot_control.watch.console.server import Server

    with graph(monkeypatch):
        backend = Backend(Settings())
    monkeypatch.undo()
    origins = Origins(frozenset({"http://console"}))
    return TestClient(TestServer(Server(backend, origins, known, known.path.parent, port=1, read_only=False).app))
