"""A hostile master: what it sends is refused, and the robot stands."""

import json

import pytest
from robot_control.fleet.client import DUPLICATE_SILENCE
from support.fleet_attack import mutated
from support.virtual_robot import Run, ordered

from bench.fleet.messages import action, header, order

pytest.importorskip("jsonschema", reason="needs Debian's python3-jsonschema: scripts/setup --fleet")
PLACES = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]
COUNT = 2000
NIGHTLY_COUNT = 100_000


def refused(payload, topic="order", words="", **options):
    run = Run()
    run.client.receive(
        topic, payload if isinstance(payload, bytes) else json.dumps(payload).encode(), run.now, **options
    )
    run.step(0.5)
    assert [error["errorType"] for error in run.state["errors"]] == ["validationError"]
    assert words in run.state["errors"][0]["errorDescription"]
    assert len(json.dumps(run.state["errors"])) < 2000
    assert run.robot.goals == 0
    assert not run.state["nodeStates"]


@pytest.mark.parametrize(
    ("payload", "words"),
    [
        (b"x" * 10_000_000, "bytes, more than"),
        (b"[" * 10_000 + b"]" * 10_000, "levels deep"),
        (b'{"a":' * 10_000, "levels deep"),
        (b'{"headerId": NaN}', "not JSON"),
        (b'{"headerId": 1e999}', "must be finite"),
        (b'{"headerId": 1, "headerId": 2}', "a name twice"),
        (b"\xff", "not JSON in UTF-8"),
        (b"", "not JSON"),
        (b"[]", "must be an object"),
        (b'{"headerId": ' + b"9" * 5000 + b"}", "JSON"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_what_is_no_message_is_refused(payload, words):
    refused(payload, words=words)


def test_too_many_nodes_are_refused():
    nodes = [{"nodeId": "n", "sequenceId": 2 * n, "released": True, "actions": []} for n in range(501)]
    refused({**order(PLACES), "nodes": nodes}, words="nodes has 501 entries, more than 500")
    refused({**order(PLACES), "nodes": nodes * 200}, words="bytes, more than")


@pytest.mark.parametrize("name", ["a/b", "+", "#", "$SYS", "a\nb", "a\x00b", "\u202e", "x" * 129])
def test_ids_that_could_structure_a_topic_or_a_line_are_refused(name):
    refused({**order(PLACES), "orderId": name}, words="orderId")
    wrong = order(PLACES)
    wrong["nodes"][1]["nodeId"] = name
    refused(wrong, words="nodes[1].nodeId")


def test_a_long_text_of_a_master_makes_no_long_state():
    run = Run()
    long = "x" * 100_000
    given = {"x": 0.0, "y": 0.0, "theta": 0.0}
    run.send({**header(), "actions": [action(long, 1), action("initPosition", 2, **given, mapId=long)]})
    run.send({**header(), "actions": [action("initPosition", 3, **given, mapId="m", lastNodeId=long)]})
    run.send({**order(PLACES), "zoneSetId": long})
    assert len(json.dumps(run.state)) < 5000


def test_another_serial_number_is_refused():
    refused({**order(PLACES), "serialNumber": "r2"}, words="another robot")


def test_a_retained_message_is_refused_for_its_age_is_not_known():
    refused(order(PLACES), words="retained", retained=True)
    refused({**header(), "actions": [action("stopPause", 1)]}, "instantActions", words="retained", retained=True)


def test_a_second_client_of_the_serial_number_makes_the_robot_stand_until_a_person_or_the_master_resumes():
    run = ordered(order(PLACES), 2.0)
    assert run.robot.motion.linear > 0.2
    run.client.receive("connection", b'{"connectionState": "ONLINE"}', run.now)
    run.step(3.0)
    assert run.state["paused"]
    assert run.robot.motion.linear == 0.0
    (error,) = run.state["errors"]
    assert (error["errorType"], error["errorLevel"]) == ("connectionError", "FATAL")
    goals = run.robot.goals
    state = run.send({**header(), "actions": [action("stopPause", 1)]})
    assert "another client" in state["errors"][0]["errorDescription"]
    run.send(order(PLACES, 3, name="another"))
    assert run.client.resume() == "another client uses this serial number"
    run.step(DUPLICATE_SILENCE)
    assert not [each for each in run.state["errors"] if each["errorType"] == "connectionError"]
    assert run.state["paused"]
    assert run.robot.goals == goals
    run.send({**header(), "actions": [action("stopPause", 2)]})
    run.step(20.0)
    assert not run.state["nodeStates"]


def test_a_flood_of_instant_actions_and_errors_keeps_the_state_small():
    run = Run()
    for number in range(500):
        run.client.receive(
            "instantActions", json.dumps({**header(), "actions": [action("stateRequest", number)]}).encode(), run.now
        )
        run.client.receive("order", b"{%d" % number, run.now)
    run.step(0.1)
    assert len(run.state["actionStates"]) <= 100
    assert len(run.state["errors"]) <= 20


def attack(first, count):
    """The robot moves only where a message is a valid order; the state stays valid JSON."""
    moved = 0
    run = Run()
    for seed in range(first, first + count):
        topic, payload = mutated(seed)
        run.client.receive(topic, payload, run.now)
        run.step(0.02)
        json.dumps(run.state, allow_nan=False)
        if run.client.vehicle.nodes or run.client.vehicle.order_id:
            moved += 1
            order_id = run.client.vehicle.order_id
            assert order_id == json.loads(payload)["orderId"], seed
            run = Run()
    return moved


def test_mutated_messages_are_refused_or_valid():
    assert attack(0, COUNT) < COUNT / 3


@pytest.mark.nightly
def test_more_mutated_messages_are_refused_or_valid():
    assert attack(COUNT, NIGHTLY_COUNT) < NIGHTLY_COUNT / 3
