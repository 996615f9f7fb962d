"""Messages of the client of VDA 5050 by the standard's schemas, both ways; its settings and its file."""

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
import yaml
from robot_control.fleet.machine import size_of
from robot_control.fleet.memory import BLOCK, Memory
from robot_control.fleet.settings import Settings, read_settings
from robot_control.fleet.v2.messages import Error, RefusedError, decoded, is_time, schema, time_text
from robot_control.fleet.v2.state import factsheet, visualization
from robot_control.installed_files import share_file
from robot_control.settings.files import SettingsError
from robot_control.setup.description import describe
from support.virtual_robot import MACHINE, Run, ordered

from bench.fleet.messages import MANUFACTURER, SERIAL, action, header, order, unknown_names

jsonschema = pytest.importorskip("jsonschema", reason="needs Debian's python3-jsonschema: scripts/setup --fleet")
PLACES = [(0.0, 0.0), (1.0, 0.0), (1.5, 0.0), (1.5, 1.0, 0.0)]


def valid(topic, message):
    """Asserts that the schema allows it and knows every name in it."""
    whole = {**header(), **message}
    jsonschema.Draft202012Validator(schema(topic)).validate(whole)
    assert unknown_names(whole, schema(topic)) == []
    json.dumps(whole, allow_nan=False)


def test_every_message_of_an_order_with_all_that_can_happen_is_valid():
    run = ordered(order(PLACES, 2, actions={2: [action("horn", 1, "SOFT", volume=3)], 5: [action("horn", 2)]}), 3.0)
    run.send({**header(), "actions": [action("startPause", 3, "HARD"), action("factsheetRequest", 4)]})
    run.step(1.0)
    run.robot.given = replace(
        run.robot.given,
        errors=(Error("tilt", "it tilts", (("actor", "operator"),), "put it upright", fatal=True),),
        held_by="a person",
        battery_charge=50.0,
        battery_voltage=24.0,
        deviation=0.01,
    )
    run.step(1.0)
    run.send({**header(), "actions": [action("stopPause", 5, "HARD"), action("dance", 6), action("logReport", 7)]})
    run.step(3.0)
    run.robot.ended += [("1", "FINISHED", "it sounded"), ("7", "FINISHED", "stop.1.bag")]
    run.step(1.0)
    run.send(order(PLACES[1:], update=1, first=1))
    run.send(order(PLACES, name="other"))
    run.until_over()
    run.send({**header(), "actions": [action("cancelOrder", 8, "HARD")]})
    assert len(run.states) > 15
    for topic, message in run.sent:
        valid(topic, message)
    valid("visualization", visualization(run.client.robot.facts()))
    valid("factsheet", factsheet(MACHINE))
    for state in ("ONLINE", "OFFLINE", "CONNECTIONBROKEN"):
        valid("connection", {"connectionState": state})
    seen = {each["actionStatus"] for state in run.states for each in state["actionStates"]}
    assert seen == {"WAITING", "RUNNING", "FINISHED", "FAILED"}


def test_the_height_of_a_robot_on_legs_is_that_with_stretched_legs():
    length, width, height = size_of(describe(share_file("urdf/quadbot.urdf"), {"robot": {}}))
    assert (length, width) == pytest.approx((0.62, 0.37), abs=0.01)
    assert height == pytest.approx(0.062 + 0.426 + 0.02, abs=0.005)  # thighs that are folded, legs, a foot


def test_a_name_that_the_schema_does_not_know_is_found():
    state = {**header(), **Run().state, "distanceSinceLastnode": 1.0}
    jsonschema.Draft202012Validator(schema("state")).validate(state)
    assert unknown_names(state, schema("state")) == [".distanceSinceLastnode"]


def test_times_are_utc_with_a_fraction():
    assert time_text(1.239) == "1970-01-01T00:00:01.23Z"
    assert is_time(time_text(1e9))
    for wrong in (
        "2026-01-31T12:00:00",
        "2026-01-31 12:00:00Z",
        "2026-13-01T00:00:00.00Z",
        "now",
        "2026-02-30T00:00:00Z",
    ):
        assert not is_time(wrong)


def refusal(payload, topic="order"):
    with pytest.raises(RefusedError) as error:
        decoded(payload if isinstance(payload, bytes) else json.dumps(payload).encode(), topic, MANUFACTURER, SERIAL)
    assert error.value.error.kind == "validationError"
    return dict(error.value.error.references)["parameter"]


def test_a_violation_names_the_path_of_the_field():
    assert decoded(json.dumps(order(PLACES)).encode(), "order", MANUFACTURER, SERIAL)["orderId"] == "o1"
    wrong = order(PLACES)
    wrong["edges"][1]["actions"] = [action("horn", 1, "MAYBE")]
    assert refusal(wrong) == "edges[1].actions[0].blockingType"
    wrong["nodes"][2]["nodePosition"]["x"] = "here"
    assert refusal(wrong) == "nodes[2].nodePosition.x"
    assert refusal({**order(PLACES), "serialNumber": "r2"}) == "serialNumber"
    assert refusal({**order(PLACES), "version": "3.0.0"}) == "version"
    assert refusal({**order(PLACES), "timestamp": "yesterday"}) == "timestamp"
    assert refusal({**order(PLACES), "orderUpdateId": 2**32}) == "orderUpdateId"
    assert refusal({**header(), "actions": [{"actionId": "1"}]}, "instantActions") == "actions[0]"


def test_version_2_0_0_is_taken_too():
    assert decoded(json.dumps({**order(PLACES), "version": "2.0.0"}).encode(), "order", MANUFACTURER, SERIAL)
    old = {**header(), "instantActions": [action("startPause", 1)]}
    assert decoded(json.dumps(old).encode(), "instantActions", MANUFACTURER, SERIAL)["actions"]


# settings and file


def settings(tmp_path, **values):
    path = tmp_path / "fleet.yaml"
    path.write_text(yaml.safe_dump(values))
    return read_settings(path)


def test_the_shipped_settings_are_the_defaults():
    assert read_settings(Path(share_file("config/fleet.yaml"))) == Settings()


def test_the_file_of_the_client_lies_in_the_home_of_its_user(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    assert Settings(serial_number="amr-07").memory == tmp_path / ".ros/robot_control/fleet/robot_control-amr-07.json"
    assert Settings(memory_file="/var/lib/robot/fleet.json").memory == Path("/var/lib/robot/fleet.json")


def test_every_wrong_value_is_named_in_one_message(tmp_path):
    with pytest.raises(SettingsError) as error:
        settings(
            tmp_path,
            hots="broker",
            port=0,
            keep_alive=7.5,
            version="3.0.0",
            serial_number="a/b",
            speed=math.inf,
            insecure="yes",
            actions={
                "horn": {"topic": "horn", "service": "horn"},
                "lift": {"topic": "lift", "scopes": ["ABOVE"]},
                "wait": 3,
            },
        )
    for words in (
        "hots: is unknown; known are interface, ",
        "port = 0: must be a whole number from 1 to 65535",
        "keep_alive = 7.5: must be a whole number from 5 to 600",
        "version = 3.0.0: must be 2.1.0 or 2.0.0",
        "serial_number = a/b: must be a text of letters, digits and _ . : -",
        "speed = inf: must be a number from 0.02 to 10",
        "insecure = yes: must be true or false",
        "actions.horn: must have either service or topic",
        "actions.lift.scopes = a value of the kind list: must be a list, each INSTANT, NODE or EDGE",
        "actions.wait: must hold keys with values",
    ):
        assert words in str(error.value)


def test_rules_across_values_are_named_too(tmp_path):
    secret = tmp_path / "password"
    secret.write_text("x\n")
    files = {"password_file": str(secret), "ca_file": str(tmp_path / "none.pem"), "key_file": str(secret)}
    with pytest.raises(SettingsError) as error:
        settings(tmp_path, localization=True, **files)
    for words in ("needs map", "chmod 600", "none.pem: file not found", "needs certificate_file"):
        assert words in str(error.value)


def test_beyond_the_loopback_it_needs_tls_or_a_word(tmp_path):
    with pytest.raises(SettingsError, match="beyond the loopback it needs ca_file"):
        settings(tmp_path, host="broker.example")
    assert settings(tmp_path, host="broker.example", insecure=True).insecure
    assert settings(tmp_path, host="::1").host == "::1"


def test_custom_actions_are_known_with_their_scopes(tmp_path):
    given = settings(tmp_path, actions={"lift": {"service": "lift/up", "scopes": ["NODE"], "timeout": 3}})
    assert given.kinds["lift"].scopes == ("NODE",)
    assert "cancelOrder" in given.kinds
    with pytest.raises(SettingsError, match="is an action of the standard"):
        settings(tmp_path, actions={"cancelOrder": {"topic": "x"}})


def test_header_ids_grow_over_restarts_with_one_write_per_thousand(tmp_path):
    path = tmp_path / "fleet" / "r1.json"
    memory = Memory(path)
    assert [memory.header_id("state") for _ in range(3)] == [0, 1, 2]
    assert memory.header_id("connection") == 0
    written = path.stat().st_mtime_ns
    assert [memory.header_id("state") for _ in range(BLOCK - 3)][-1] == BLOCK - 1
    assert path.stat().st_mtime_ns == written
    assert Memory(path).header_id("state") == BLOCK


def test_what_was_saved_outlives_and_another_file_is_moved_aside(tmp_path):
    path = tmp_path / "r1.json"
    run = ordered(order(PLACES))
    Memory(path).save(vehicle=run.client.vehicle.dump())
    again = Memory(path)
    assert again["vehicle"]["ids"][0] == "o1"
    assert (again["position"], again.problem) == (None, "")
    path.write_text("[]")
    other = Memory(path)
    assert (other["vehicle"], "is " + str(tmp_path / "r1.json.damaged") in other.problem) == (None, True)
    assert (tmp_path / "r1.json.damaged").read_text() == "[]"
