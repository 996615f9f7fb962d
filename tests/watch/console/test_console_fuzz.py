"""Damaged input of pages, requests and files: none surprises the console, and none takes longer than `timed` allows."""

from __future__ import annotations

import asyncio
import contextlib
import io
import json
import os
import time

import pytest
from robot_control.drive.path.waypoints import PathError, read_csv_text
from robot_control.settings.files import SettingsError
from robot_control.watch.console import authority, calls, messages, sessions, settings, users
from served_console import served
from support.mutants import mutants
from support.timed import timed
from support.topics import graph, surprises_of

COUNT = 100_000 if os.environ.get("ROBOT_CONTROL_NIGHTLY") else 2000
POINTS = [[0.0, 0.0], [1.0, 0.5]]
ARGUMENTS = {
    "key": "0" * 16,
    "posture": "stand",
    "gait": "trot",
    "x": 1.0,
    "y": 2.0,
    "yaw": 0.5,
    "parameters": "{max_linear_speed: 0.8}",
    "points": POINTS,
    "speed": 0.3,
    "shape": "square",
    "size": 1.0,
    "text": "x,y,yaw\n0,0,\n1,1,0.5\n",
    "on": True,
    "cycles": 5,
    "component": "gyro",
    "kind": "off",
}
DRIVE = {"type": "drive", "number": 7, "sent": 1.5, "held": True, "linear": 1.0, "angular": 0.5, "lateral": 0.0}
SPEEDS = {"type": "speeds", "linear": 0.5, "angular": 1.0, "lateral": 0.3}
PLAY = {"type": "play", "at": 2.5, "speed": 0.5}
OTHERS = [PLAY, {"type": "take", "force": True}, {"type": "pong", "name": "ab"}, {"type": "hand_over", "to": 1}]
CALLS = [
    {"type": "call", "number": 3, "name": name, "arguments": {field: ARGUMENTS[field] for field in call.fields}}
    for name, call in calls.CALLS.items()
]


class Task:
    """One that is done at once."""

    def add_done_callback(self, forget):
        forget(self)


@pytest.mark.parametrize("message", [DRIVE, SPEEDS, *OTHERS, *CALLS], ids=lambda m: m.get("name", m["type"]))
def test_no_message_of_a_page_surprises_the_console(message, monkeypatch):
    client_module = pytest.importorskip("aiohttp") and __import__(
        "robot_control.watch.console.client", fromlist=["client"]
    )
    from robot_control.watch.console.backend import Backend

    surprises, made = surprises_of(monkeypatch), []
    with graph(monkeypatch):
        backend = Backend(settings.Settings())
        page = backend.authority.join("anna", authority.Role.MAINTAIN)
        session = sessions.Session("key", "anna", page.role, 1e12)
        client = client_module.Client(backend, client_module.Frames(), page, session, sessions.Sessions())
        client._call = lambda number, name, arguments: (name, arguments)
        monkeypatch.setattr(asyncio, "create_task", lambda call: made.append(call) or Task())
        backend.authority.take(page, 0.0)

        def receive(data):
            client._take(data, time.monotonic())
            with contextlib.suppress(authority.RefusedError):
                while made:
                    name, arguments = made.pop()
                    if name != "reset":
                        backend.calls.make(page, name, arguments)
            client._outbox.clear()
            backend.step()

        for mutant in mutants(json.dumps(message).encode(), COUNT, seed=len(str(message))):
            with contextlib.suppress(UnicodeDecodeError):  # aiohttp closes a page that sends it
                timed(receive, mutant.decode())
                assert not surprises, mutant


HEADERS = {"Host": "console", "Origin": "http://console", "Content-Type": "application/json"}


def test_wrong_links_block_no_first_login_of_another_link(monkeypatch, tmp_path):
    known = users.Users(tmp_path / "users.json")
    link = known.add("anna", authority.Role.WATCH, time.time())

    async def answers():
        async with served(monkeypatch, known) as client:
            for body in [*({"link": f"wrong {number}"} for number in range(6)), {"link": link}]:
                data = json.dumps({"password": "long enough", **body})
                async with client.post("/api/login", data=data, headers=HEADERS) as answer:
                    yield answer.status

    async def whole():
        return [each async for each in answers()]

    assert asyncio.run(whole()) == [403] * 6 + [200]


def test_guesses_that_wait_for_their_turn_to_be_hashed_count_as_tries(monkeypatch, tmp_path):
    known = users.Users(tmp_path / "users.json")
    known.add("anna", authority.Role.WATCH, time.time())

    async def status(client, number):
        guess = json.dumps({"name": "anna", "link": "", "password": f"wrong guess {number}"})
        async with client.post("/api/login", data=guess, headers=HEADERS) as answer:
            return answer.status

    async def at_once():
        async with served(monkeypatch, known) as client:
            return await asyncio.gather(*(status(client, number) for number in range(30)))

    assert sorted(asyncio.run(at_once())) == [403] * sessions.TRIES_OF_USER + [429] * (30 - sessions.TRIES_OF_USER)


def test_no_body_of_a_login_surprises_the_server(monkeypatch, tmp_path):
    surprises = surprises_of(monkeypatch)
    known = users.Users(tmp_path / "users.json")
    known.add("anna", authority.Role.WATCH, 0.0)

    async def whole():
        async with served(monkeypatch, known) as client:
            valid = json.dumps({"name": "anna", "link": "", "password": "long enough"}).encode()
            for mutant in mutants(valid, COUNT, seed=3):
                async with client.post("/api/login", data=mutant, headers=HEADERS) as answer:
                    assert answer.status in {400, 403, 413, 429}, (answer.status, mutant, surprises)

    asyncio.run(whole())


@pytest.mark.parametrize(
    ("valid", "read", "refusals"),
    [
        (b"distance: 0.3\nlink_gap: 0.3\n", settings.read_settings, (SettingsError, OSError)),
        (
            json.dumps(
                [{"name": "anna", "role": "watch", "salt": "0f" * 16, "password": "ab", "link_ends": 1.5}]
            ).encode(),
            lambda path: users.Users(path).check("anna", "long enough"),
            (users.UsersError, OSError),
        ),
    ],
    ids=["console.yaml", "console_users.json"],
)
def test_no_damaged_file_of_settings_is_answered_but_by_a_refusal(valid, read, refusals, tmp_path, monkeypatch):
    monkeypatch.setattr(users, "_hash", lambda _, salt: bytes.fromhex(salt).hex())  # scrypt takes 50 ms
    path = tmp_path / "file"
    path.touch(mode=0o600)

    def take(data):
        path.write_bytes(data)
        with contextlib.suppress(*refusals):
            read(path)

    for mutant in mutants(valid, COUNT, seed=5):  # they are read at the start, and take no time of a robot that drives
        take(mutant)


def test_no_damaged_csv_of_a_page_is_answered_but_by_a_refusal():
    def take(text):
        with contextlib.suppress(PathError):
            read_csv_text("the file", io.StringIO(text, newline=""))

    for mutant in mutants(ARGUMENTS["text"].encode(), COUNT, seed=7):
        text = mutant.decode(errors="replace")
        if len(text) <= 60_000:
            timed(take, text)


def test_every_type_of_a_message_and_every_call_is_damaged():
    assert {message["type"] for message in (DRIVE, SPEEDS, *OTHERS, *CALLS)} | {"give_back", "heartbeat"} == set(
        messages.TYPES
    )
