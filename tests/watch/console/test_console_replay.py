"""A recording in the console: it plays as fast as it says, and nothing can be commanded."""

from __future__ import annotations

import asyncio
import json
import math
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import rosbag
import rospy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import OccupancyGrid
from robot_control import ClosedLoop
from robot_control.data.footfalls import FEET
from robot_control.data.report.drive import mass_of
from robot_control.data.run_log import LogError, read_run
from robot_control.watch.console.navigation import NoGridError
from robot_control.watch.console.replay.playback import Playback
from robot_control.watch.console.replay.rows import held
from robot_control.watch.console.settings import Settings
from tf2_msgs.msg import TFMessage

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
    read_whole(found["replay"])
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


def read_whole(replay):
    """The recording, once its rows are there."""
    end = time.monotonic() + 30.0
    while "read" in replay.slow()["replay"]["loading"]:
        assert time.monotonic() < end
        time.sleep(0.05)
    return replay


def test_the_feet_of_a_recording_bear_the_weight_of_the_robot(tmp_path):
    from robot_control.watch.console.replay.replay import Replay

    urdf = str(Path(__file__).parents[3] / "urdf" / "quadbot.urdf")
    loop = ClosedLoop(urdf=urdf)
    loop.log_into(tmp_path)
    loop.run(0.5)
    loop.set_posture("standing")
    loop.run(3.5)
    loop.end_log()
    replay = read_whole(Replay(tmp_path / "run.bag", Settings()))
    replay.play(0.3, 0.0)
    assert replay.fast()["legs"]["posture"] == "lying"
    replay.play(3.9, 0.0)
    legs = replay.fast()["legs"]
    assert legs["posture"] == "standing"
    assert [(foot["name"], foot["bears"]) for foot in legs["feet"]] == [(name, True) for name in FEET]
    assert legs["slope"] == pytest.approx([0.0, 0.0], abs=0.02)
    assert not any(foot["met_riser"] or foot["reaching"] for foot in legs["feet"])
    assert sum(foot["load"] for foot in legs["feet"]) == pytest.approx(9.81 * mass_of(Path(urdf).read_text()), rel=0.1)


def grid(side):
    message = OccupancyGrid()
    message.header.frame_id = "map"
    message.info.resolution, message.info.width, message.info.height = 0.05, side, 2
    message.info.origin.orientation.w = 1.0
    message.data = [0] * (2 * side)
    return message


def test_a_map_that_was_recorded_beside_the_log_is_shown_from_its_time_on(bag, tmp_path):
    from robot_control.watch.console.replay.replay import Replay

    copy = tmp_path / "run.bag"
    copy.write_bytes(bag.read_bytes())
    begin = read_run(copy, ["time"]).ros_time[0]
    at_map, in_odom = TransformStamped(), (1.0, 2.0, math.pi / 2)
    at_map.header.frame_id, at_map.child_frame_id = "map", "odom"
    at_map.transform.translation.x, at_map.transform.translation.y = -2.0, 1.0
    at_map.transform.rotation.w, at_map.transform.rotation.z = math.sqrt(0.5), -math.sqrt(0.5)
    with rosbag.Bag(str(tmp_path / "robot_control_2026-01-01-00-00-00.bag"), "w") as beside:
        for after, topic, message in (
            (1.0, "/map", grid(3)),
            (2.0, "/tf", TFMessage([at_map])),
            (3.0, "/map", grid(4)),
            (4.0, "/scan", grid(5)),
        ):
            beside.write(topic, message, rospy.Time.from_sec(begin + after))
    (tmp_path / "robot_control_2026-01-01-00-01-00.bag").write_bytes(b"#ROSBAG V2.0\n")
    replay = read_whole(Replay(copy, Settings()))
    shown = []
    for at in (0.5, 1.5, 2.5, 3.5):
        replay.play(at, 0.0)
        shown.append(replay.slow()["navigation"])
    assert shown[0] == {"grids": {}}
    assert [each["grids"]["map"] for each in shown[1:]] == [1, 1, 2]
    assert shown[1]["map"] == [0.0, 0.0, 0.0]
    assert shown[2]["map"] == pytest.approx(in_odom, abs=1e-5)
    assert replay.grid("map")["columns"] == 4
    replay.play(1.5, 0.0)
    assert replay.grid("map")["columns"] == 3
    replay.play(0.5, 0.0)
    with pytest.raises(NoGridError):
        replay.grid("map")


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


def test_an_event_of_a_foot_that_lasted_one_cycle_is_held_for_the_page():
    bits = np.array([0.0, math.nan, 4.0, 0.0, 1.0, 0.0, 0.0])
    assert held(bits, 2).tolist() == [0, 0, 4, 4, 5, 1, 1]
