"""A recording in the console: it plays as fast as it says, and nothing can be commanded."""

from __future__ import annotations

import asyncio
import json
import threading
import time

import pytest
from robot_control import ClosedLoop
from robot_control.data.run_log import LogError
from robot_control.watch.console.replay.playback import Playback
from robot_control.watch.console.settings import Settings

pytest.importorskip("aiohttp")

OPENS = 3.0
"""s; the header and the index are all that is read"""
POSTS = ("/api/e_stop", "/api/login", "/api/logout")
DRIVE = {"type": "drive", "number": 1, "sent": 1.0, "held": True, "linear": 1.0, "angular": 0.0, "lateral": 0.0}
COMMANDS = [
    DRIVE,
    {"type": "take", "force": True},
    {"type": "heartbeat", "on": True},
    {"type": "speeds", "linear": 1.0, "angular": 1.0, "lateral": 0.0},
    {"type": "give_back"},
    {"type": "hand_over", "to": 1},
    {"type": "call", "number": 1, "name": "pause", "arguments": {"on": True}},
    {"type": "call", "number": 2, "name": "reset_asked", "arguments": {}},
]


def test_a_recording_plays_at_its_speed_and_stands_at_its_end():
    playback = Playback(10.0)
    playback.play(2.0, 0.5, now=100.0)
    assert playback.at(104.0) == pytest.approx(4.0)
    playback.play(playback.at(104.0), 10.0, now=104.0)
    assert playback.at(104.3) == pytest.approx(7.0)
    assert playback.at(200.0) == 10.0
    playback.play(1.0, 0.0, now=200.0)
    assert playback.at(300.0) == 1.0


def driven(folder, seconds):
    """The log of a robot that drives, and is stopped for its last second."""
    loop = ClosedLoop()
    loop.log_into(folder)
    loop.run(seconds - 1.0, (0.5, 0.0))
    loop.e_stop()
    loop.run(1.0, (0.0, 0.0))
    loop.end_log()
    return folder / "run.bag"


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    """The log is five seconds long."""
    return driven(tmp_path_factory.mktemp("replay"), 5.0)


@pytest.fixture(scope="module")
def served(bag):
    """The console with that log: its address and its recording."""
    from aiohttp import web
    from robot_control.settings.addresses import origins_of
    from robot_control.watch.console.replay.replay import Replay
    from robot_control.watch.console.server import Server

    from bench.console.process import free_port

    port, there, found = free_port(), threading.Event(), {}

    async def work():
        replay = Replay(bag, Settings())
        origins = origins_of("127.0.0.1", port, [], tls=False, further=[])
        server = Server(replay, origins, None, bag.parent, port=port, read_only=False)
        runner = web.AppRunner(server.app, handle_signals=False)
        await runner.setup()
        await web.TCPSite(runner, "127.0.0.1", port).start()
        found.update(replay=replay, origin=f"http://127.0.0.1:{port}", token=server.sessions.token)
        there.set()
        while True:
            server.frames.make(replay)
            await asyncio.sleep(0.05)

    threading.Thread(target=lambda: asyncio.run(work()), daemon=True).start()
    assert there.wait(20.0)
    end = time.monotonic() + 30.0
    while "read" in found["replay"].slow()["replay"]["loading"]:
        assert time.monotonic() < end
        time.sleep(0.05)
    return found


def test_it_opens_before_its_rows_are_read(bag):
    from robot_control.watch.console.replay.replay import Replay

    began = time.monotonic()
    replay = Replay(bag, Settings())
    assert time.monotonic() - began < OPENS
    assert replay.slow()["replay"]["length"] > 3.0
    assert "<robot" in replay.description()


def test_its_values_are_those_of_the_log(served):
    replay = served["replay"]
    replay.play(3.0, 0.0)
    values, state = replay.fast(), replay.slow()
    assert values["measured"][0] == pytest.approx(0.5, abs=0.05)
    assert len(values["pose"]) == 6
    assert set(values["joints"]) == {"left_wheel_joint", "right_wheel_joint"}
    assert state["verdict"] == "moving"
    assert state["replay"]["at"] == 3.0


def test_a_stop_is_a_mark_with_its_cause_and_can_be_looked_at(served):
    replay = served["replay"]
    (mark,) = replay.slow()["replay"]["marks"]
    assert mark["at"] == pytest.approx(4.0, abs=0.1)
    replay.play(mark["at"] + 0.5, 0.0)
    state = replay.slow()
    assert state["verdict"] == "stopped"
    assert state["safety"]["causes"][0]["sentence"] == mark["sentence"]


@pytest.mark.nightly
def test_ten_minutes_open_within_three_seconds(tmp_path):
    test_it_opens_before_its_rows_are_read(driven(tmp_path, 600.0))


def test_what_is_no_log_is_refused(tmp_path):
    from robot_control.watch.console.replay.replay import Replay

    path = tmp_path / "run.bag"
    path.write_bytes(b"#ROSBAG V2.0\n")
    with pytest.raises(LogError):
        Replay(path, Settings())


async def asked(served, messages):
    """The answers of the server to a page that sends these messages, and the status of each POST."""
    from aiohttp import ClientSession, CookieJar

    origin, heard = served["origin"], []
    async with ClientSession(cookie_jar=CookieJar(unsafe=True)) as session:
        await (await session.get(f"{origin}/?token={served['token']}")).read()
        posts = [(await session.post(origin + path, json={}, headers={"Origin": origin})).status for path in POSTS]
        async with session.ws_connect(f"{origin}/ws", headers={"Origin": origin}) as page:
            for message in messages:
                await page.send_json(message)
            end = time.monotonic() + 1.5
            while time.monotonic() < end:
                heard.append(json.loads(await page.receive_str(timeout=2.0)))
    return posts, heard


def test_every_post_and_every_command_is_refused(served):
    posts, heard = asyncio.run(asked(served, COMMANDS))
    assert posts == [403] * len(POSTS)
    refusals = [each for each in heard if each["type"] == "said"]
    assert len(refusals) == len(COMMANDS)
    assert all("nothing can be commanded" in each["text"] for each in refusals)
    assert not [each for each in heard if each["type"] == "answer"]
    authority = [each for each in heard if each["type"] == "authority"][-1]
    assert authority["commander"] is None
    assert authority["role"] == "watch"


def test_a_page_plays_it_within_two_per_cent(served):
    _, heard = asyncio.run(asked(served, [{"type": "play", "at": 0.5, "speed": 1.0}]))
    assert served["replay"].slow()["replay"]["speed"] == 1.0
    places = [each["replay"]["at"] for each in heard if each["type"] == "slow"]
    assert places[-1] > 1.0
    began, at = time.monotonic(), served["replay"].slow()["replay"]["at"]
    time.sleep(1.0)
    assert served["replay"].slow()["replay"]["at"] - at == pytest.approx(time.monotonic() - began, rel=0.02)


def test_a_page_of_a_robot_does_not_play():
    from robot_control.watch.console.authority import RefusedError
    from robot_control.watch.console.backend import Backend

    with pytest.raises(RefusedError):
        Backend.play(object.__new__(Backend), 0.0, 1.0)
