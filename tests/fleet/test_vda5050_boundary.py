"""The boundary of vda5050.py: no message, topic or file ends the program, and each costs little time."""

from __future__ import annotations

import contextlib
import io
import json
import math
import random
import threading
import time
from dataclasses import replace
from types import SimpleNamespace

import pytest
import yaml
from actionlib import CommState
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from nav_msgs.msg import Odometry
from robot_control.fleet import custom
from robot_control.fleet import robot as ros_robot
from robot_control.fleet.client import Client
from robot_control.fleet.main import recalled
from robot_control.fleet.memory import Memory
from robot_control.fleet.settings import CustomAction, Settings, read_settings
from robot_control.fleet.v2.messages import RefusedError, decoded, encoded, schema
from robot_control.fleet.v2.order import Action, order_of
from robot_control.fleet.v2.vehicle import MAX_INSTANT, MAX_NODES, MAX_OVER, Vehicle
from robot_control.msg import FollowPathActionFeedback, FollowPathActionResult, RobotStatus, SafetyStatus
from robot_control.robot import boundary as crossing
from robot_control.robot.pose import turned
from robot_control.settings.files import SettingsError
from sensor_msgs.msg import BatteryState
from support.fleet_attack import mutated, seeds
from support.mutants import mutants
from support.timed import longest, timed
from support.virtual_robot import MACHINE, Run, VirtualRobot, ordered

from bench.fleet.messages import MANUFACTURER, SERIAL, action, header, order

jsonschema = pytest.importorskip("jsonschema", reason="needs Debian's python3-jsonschema: scripts/setup --fleet")
STATE = jsonschema.Draft202012Validator(schema("state"))
COUNT, NIGHTLY_COUNT = 2000, 100_000
PLACES = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]
BOTH = pytest.mark.parametrize("count", [COUNT, pytest.param(NIGHTLY_COUNT, marks=pytest.mark.nightly)])


@pytest.fixture(autouse=True, scope="module")
def said():
    longest[0] = 0.0
    yield
    print(f"the longest call took {1000 * longest[0]:.1f} ms")


def taken(function, *given):
    """The value, or the refusal; in time."""
    try:
        return timed(function, *given)
    except RefusedError as refused:
        return refused


def decode(payload, topic="order"):
    return taken(decoded, payload, topic, MANUFACTURER, SERIAL)


# one message


@pytest.mark.parametrize(
    "payload",
    [
        b'"' + b'\\"' * 61_000,
        b'"' * 130_000,
        b'{"a":' * 50_000,
        b'{"a":[' + b"0," * 130_000 + b"0]}",
        b"[" + b"[]," * 80_000 + b"[]]",
        b'{"' + b"k" * 100_000 + b'":[' + b"0," * 80_000 + b"0]}",
        b'{"nodes":[' + b"{}," * 80_000 + b"{}]}",
        b'{"a":[' + (b"9" * 4300 + b",") * 60 + b"0]}",
        b'{"a":"' + b"\\u0041" * 40_000,
    ],
    ids=lambda payload: str(payload[:12]),
)
def test_a_message_of_any_content_is_decoded_in_linear_time(payload):
    assert isinstance(decode(payload), RefusedError)


def test_the_largest_order_is_decoded_and_checked_in_time():
    actions = {at: [action("horn", f"{at}-{number}") for number in range(4)] for at in range(0, 300, 2)}
    message = decode(encoded(order([(0.5 * number, 0.0, 0.0) for number in range(500)], actions=actions)))
    assert len(taken(order_of, message).nodes) == 500
    controls = [{"x": 0.9 * number, "y": math.sin(number) / 10} for number in range(200)]
    knots = [0] * 11 + [number / 190 for number in range(1, 190)] + [1] * 11
    curve = {"degree": 10, "knotVector": knots, "controlPoints": controls}
    run = Run()
    payload = encoded(order([(0.0, 0.0), (179.1, math.sin(199) / 10)], trajectory=curve))
    taken(run.client.receive, "order", payload, run.now)
    run.step(0.02)
    assert run.state["nodeStates"], run.state["errors"]


def refused(message, words):
    run = ordered(message)
    (error,) = run.state["errors"]
    assert words in error["errorDescription"]
    assert not run.state["nodeStates"]


def test_numbers_that_are_finite_and_absurd_are_refused_with_their_field():
    refused(order([(0.0, 0.0), (1e155, 0.0)]), "nodes[1].nodePosition.x must be from -1000000.0 to 1000000.0")
    refused(order(PLACES, maxSpeed=1e200), "edges[")
    refused(order(PLACES, maxSpeed=5e-324), "maxSpeed must be at least 0.02")
    wide = order(PLACES)
    wide["nodes"][0]["nodePosition"]["allowedDeviationXY"] = 1e155
    refused(wide, "allowedDeviationXY must be from -1000000.0 to 1000000.0")
    run = Run()
    run.send({**header(), "actions": [action("initPosition", 1, x=1e155, y=0.0, theta=0.0, mapId="hall")]})
    assert run.state["actionStates"][0]["actionStatus"] == "FAILED"


def arc(weights):
    controls = [(0, 0), (1, 0), (1, 1)]
    points = [{"x": x, "y": y, "weight": weight} for (x, y), weight in zip(controls, weights, strict=True)]
    return order([(0.0, 0.0), (1.0, 1.0)], trajectory={
        "degree": 2, "knotVector": [0, 0, 0, 1, 1, 1], "controlPoints": points
    })  # fmt: skip


def test_weights_far_apart_are_refused_and_equal_ones_of_any_size_are_a_curve():
    for weights in ((5e-324, 1, 1), (1, 1e-7, 1), (1e-3, 1, 1e4)):
        refused(arc(weights), "every weight must be above zero, and at least 1e-06 of the largest one")
    run = Run()
    run.send(arc((5e-324, 5e-324, 5e-324)))
    run.until_over()
    assert (run.robot.pose.x, run.robot.pose.y) == pytest.approx((1.0, 1.0), abs=0.02)


def test_each_action_of_a_message_is_taken_for_itself():
    run = ordered(order(PLACES), 2.0)
    state = run.send({**header(), "actions": [action("dance", 1), action("startPause", 2), action("cancelOrder", 3)]})
    assert {each["actionId"]: each["actionStatus"] for each in state["actionStates"]}["1"] == "FAILED"
    assert state["paused"]
    run.step(3.0)
    assert run.robot.motion.linear == 0.0
    assert {each["actionStatus"] for each in run.state["actionStates"]} == {"FAILED", "FINISHED"}
    assert not run.state["nodeStates"]


def test_instant_actions_that_never_end_are_bounded_and_a_pause_is_taken():
    run = Run()
    for number in range(200):
        run.client.receive("instantActions", encoded({**header(), "actions": [action("horn", number)]}), run.now)
    state = run.send({**header(), "actions": [action("startPause", "p")]})
    assert (len(state["actionStates"]), state["paused"]) == (101, True)
    assert "100 instant actions have not ended" in state["errors"][0]["errorDescription"]


def test_a_flood_of_what_concerns_the_order_is_bounded_and_each_of_it_is_taken():
    run = ordered(order(PLACES), 2.0)
    for kind in ("startPause", "cancelOrder"):
        for first in range(0, 960, 32):
            flood = [action(kind, f"{kind} {first + number}") for number in range(32)]
            run.client.receive("instantActions", encoded({**header(), "actions": flood}), run.now)
    assert len(run.client.vehicle.actions) <= 2 * MAX_INSTANT + 2
    assert run.client.vehicle.paused
    assert run.client.vehicle.cancelling
    run.step(3.0)
    assert (run.robot.motion.linear, run.state["nodeStates"]) == (0.0, [])
    assert {each["actionStatus"] for each in run.state["actionStates"]} == {"FAILED", "FINISHED"}


def test_nodes_that_are_still_to_be_traversed_are_bounded():
    run = Run()
    places, count = [(0.5 * number, 0.0) for number in range(500)], 0
    run.send(order(places))
    run.send({**header(), "actions": [action("startPause", 1)]})
    while not (state := run.send(order(places, update=count + 1, first=499 * (count + 1))))["errors"]:
        count += 1
        assert count < 3
    assert (count, len(state["nodeStates"])) == (1, 998)
    assert f"more than {MAX_NODES} nodes are still to be traversed" in state["errors"][0]["errorDescription"]


def test_finished_actions_of_an_order_without_end_are_bounded():
    vehicle, taken = Vehicle(), (lambda _: True, lambda _: None)
    vehicle.receive(order_of(order([(0.0, 0.0)])), *taken)
    for count in range(1, 50):
        actions = {2 * count: [action("horn", f"{count} {number}") for number in range(32)]}
        places = [(count - 1.0, 0.0), (count, 0.0)]
        assert vehicle.receive(order_of(order(places, update=count, first=count - 1, actions=actions)), *taken)
        vehicle.traverse()
        for begun in vehicle.started():
            begun.end("FINISHED")
        assert not vehicle.executing
    assert len(vehicle.actions) == MAX_OVER + 32


def test_an_empty_message_on_connection_is_no_other_client():
    for payload in (b"", b"x", b"{}", b'{"connectionState": "HERE"}'):
        run = Run()
        run.client.receive("connection", payload, run.now, retained=True)
        run.step(0.1)
        assert "connectionError" not in [error["errorType"] for error in run.state["errors"]]


# what nothing foresaw


class Surprising(VirtualRobot):
    """Raises once, in the method of this name."""

    where = ""

    def __getattribute__(self, name):
        if name == object.__getattribute__(self, "where"):
            self.where = ""
            raise ZeroDivisionError("division by zero")
        return super().__getattribute__(name)


@pytest.mark.parametrize("where", ["facts", "drive", "results", "progress"])
def test_what_nothing_foresaw_stops_the_motion_drops_the_order_and_names_it(where):
    robot = Surprising()
    run = Run(robot)
    run.send(order(PLACES, 2))
    run.step(2.0)
    assert robot.motion.linear > 0.2
    robot.where = where
    run.send(order(PLACES[1:], update=1, first=1))
    run.step(3.0)
    assert robot.where == ""
    assert robot.motion.linear == 0.0
    assert not run.state["nodeStates"]
    (error,) = run.state["errors"]
    assert (error["errorType"], "ZeroDivisionError: division by zero" in error["errorDescription"]) == (
        "internalError", True
    )  # fmt: skip
    x = robot.pose.x
    assert not run.send(order([(x, 0.0), (x + 0.5, 0.0)], name="o2"))["errors"]
    run.until_over()
    assert robot.pose.x == pytest.approx(x + 0.5, abs=0.02)


def test_a_surprise_of_another_thread_while_an_order_is_taken_drops_that_order():
    run = Run()
    drop = run.client._boundary.crossing("odom")

    def keep(_):
        thread = threading.Thread(target=surprise)
        thread.start()
        thread.join()
        return ""

    def surprise():
        with drop:
            raise ZeroDivisionError("division by zero")

    run.client._keep = keep
    state = run.send(order(PLACES))
    run.step(1.0)
    assert (run.robot.goals, run.state["nodeStates"], state["nodeStates"]) == (0, [], [])
    assert run.state["errors"][0]["errorType"] == "internalError"


@pytest.mark.parametrize("at", ["pause", "resume"])
def test_a_pause_at_the_robot_while_an_order_is_taken_counts(at):
    run = Run()
    run.client.vehicle.paused = at == "resume"
    run.client._keep = lambda _: getattr(run.client, at)() or ""
    run.send(order(PLACES))
    assert run.state["paused"] == (at == "pause")


def test_a_path_held_at_the_robot_that_is_not_answered_holds_nothing_up():
    run = ordered(order(PLACES), 2.0)
    run.robot.given = replace(run.robot.given, held_by="paused at the robot")
    run.step(0.1)
    run.robot.begin = run.robot.begun.append  # its answer comes late
    state = run.send({**header(), "actions": [action("stopPause", "s")]})
    assert [each["actionStatus"] for each in state["actionStates"]] == ["RUNNING"]
    assert [each.kind for each in run.robot.begun] == ["stopPause"]
    run.robot.ended.append(("s", "FAILED", "path_vel is masked"))
    run.step(0.1)
    assert [each["actionStatus"] for each in run.state["actionStates"]] == ["FAILED"]
    assert run.state["paused"]


def test_services_that_never_answer_cost_few_threads(monkeypatch):
    monkeypatch.setattr(custom.rospy, "wait_for_service", lambda *_: time.sleep(0.5))
    monkeypatch.setattr(custom.rospy, "ServiceProxy", lambda *_: lambda: SimpleNamespace(success=True, message=""))
    monkeypatch.setattr(custom.subprocess, "Popen", lambda *_, **__: SimpleNamespace(communicate=lambda _: None))
    before, actions = threading.active_count(), custom.Actions({"stopPause": CustomAction(service="resume")})
    for number in range(200):
        actions.begin(Action({}, str(number), "stopPause", "NONE"))
    assert threading.active_count() - before == custom.MAX_CALLS
    assert len(actions.results()) == 200 - custom.MAX_CALLS


# the file


def test_an_order_that_cannot_be_saved_is_refused_and_a_pause_is_taken(monkeypatch, tmp_path):
    run, memory = Run(), Memory(tmp_path / "memory.json")
    run.client = Client(
        run.robot, run.settings, MACHINE, Vehicle(), keep=lambda vehicle: memory.save(vehicle=vehicle.dump())
    )
    run.send(order(PLACES, 2))
    run.step(1.0)
    full = OSError(28, "No space left on device")

    def write(*_):
        raise full

    monkeypatch.setattr("robot_control.files.kept_file.write_durably", write)
    state = run.send(order(PLACES[1:], update=1, first=1))
    assert "cannot be kept over a restart: No space left on device" in state["errors"][0]["errorDescription"]
    assert (state["orderUpdateId"], len(state["nodeStates"])) == (0, 2)
    assert run.send({**header(), "actions": [action("startPause", 1)]})["paused"]
    assert [memory.header_id("state") for _ in range(3)] == [0, 1, 2]
    monkeypatch.undo()
    memory.header_id("order")
    held = Memory(tmp_path / "memory.json")["vehicle"]
    assert (held["ids"][1], len(held["nodes"])) == (0, 2)


def test_a_file_that_cannot_be_used_is_moved_aside_and_the_master_is_told(tmp_path):
    path = tmp_path / "memory.json"
    for damage in (lambda data: data[:-7], lambda _: b"[]", lambda data: data.replace(b"o1", b"o2")):
        run, memory = Run(), Memory(path)
        run.send(order(PLACES))
        memory.save(vehicle=run.client.vehicle.dump())
        assert recalled(Memory(path))[0].order_id == "o1"
        path.write_bytes(damage(path.read_bytes()))
        run.client = Client(run.robot, run.settings, MACHINE, recalled(Memory(path))[0])
        run.step(0.1)
        assert (run.state["orderId"], run.state["errors"][0]["errorType"]) == ("", "fileError")
        assert path.with_name("memory.json.damaged").exists()
    memory = Memory(path)
    memory.save(vehicle={"ids": []})
    assert recalled(Memory(path))[0].refusals


# fuzzes


def seed_payloads():
    """Messages of each topic, with everything in them that the robot understands."""
    curve = arc((1, 0.7, 1))
    turn = order([(0.0, 0.0, 1.0), (0.0, 0.0, 2.0), (1.0, 0.0)])
    for message in (*seeds(), curve, turn):
        yield "order" if "nodes" in message else "instantActions", json.dumps(message).encode()
    yield "connection", json.dumps({**header(), "connectionState": "ONLINE"}).encode()


def fed(run, topic, payload):
    """One message, and the pass after it."""
    taken(run.client.receive, topic, payload, run.now)
    taken(run.client.step, run.now)
    run.step(0.02)
    encoded(run.state)


@BOTH
def test_no_message_of_a_master_ends_the_client_or_holds_it_up(count):
    run = Run()
    payloads = list(seed_payloads())
    streams = [(topic, mutants(payload, count, seed)) for seed, (topic, payload) in enumerate(payloads)]
    for number in range(count):
        for topic, payload in [mutated(number), *((topic, next(stream)) for topic, stream in streams)]:
            fed(run, topic, payload)
            if run.client.vehicle.executing:
                run.step(1.0)
                encoded(run.state)
            if run.client.vehicle.order_id or len(run.states) > 1000:
                assert run.client._boundary.dropped == {}, (topic, payload)
                run = Run()
            elif topic == "connection":
                run.client._duplicate_until = -math.inf


def random_order(seed):
    """A straight, a curve, a turn on the spot or nothing from each node to the next; thetas, speeds and deviations."""
    draw = random.Random(seed)
    places, edges = [(0.0, 0.0)], []
    for _ in range(draw.randint(1, 5)):
        (x, y), length = places[-1][:2], draw.choice((0.0, 0.01, 0.5, 1.5, 5.0))
        angle = draw.uniform(-math.pi, math.pi)
        place = (x + length * math.cos(angle), y + length * math.sin(angle))
        edges.append({"maxSpeed": draw.uniform(0.1, 1.0)} if draw.random() < 0.3 else {})
        if length >= 0.5 and draw.random() < 0.5:
            middle = (x + length * math.cos(angle + 0.5), y + length * math.sin(angle + 0.5))
            controls = [{"x": x, "y": y} for x, y in ((x, y), middle, place)]
            edges[-1]["trajectory"] = {"degree": 2, "knotVector": [0, 0, 0, 1, 1, 1], "controlPoints": controls}
        places.append((*place, draw.uniform(-math.pi, math.pi)) if draw.random() < 0.4 else place)
    if draw.random() < 0.3:
        places[0] = (0.0, 0.0, draw.uniform(-math.pi, math.pi))
    message = order(places)
    for edge, fields in zip(message["edges"], edges, strict=True):
        edge.update(fields)
    for node in message["nodes"]:
        if draw.random() < 0.2:
            node["nodePosition"] |= {"allowedDeviationXY": 0.1, "allowedDeviationTheta": 0.3}
    return message


@BOTH
def test_what_is_accepted_is_driven_to_its_end(count):
    for seed in range(count // 50):
        run, message = Run(), random_order(seed)
        assert not run.send(message)["errors"], seed
        run.until_over(200.0)
        assert (run.client._boundary.dropped, run.state["errors"]) == ({}, []), seed
        place = message["nodes"][-1]["nodePosition"]
        off = math.dist((place["x"], place["y"]), (run.robot.pose.x, run.robot.pose.y))
        assert off < max(0.06, place.get("allowedDeviationXY", 0.0)), seed
        turn = abs(turned(place.get("theta", run.robot.pose.yaw) - run.robot.pose.yaw))
        assert turn <= max(0.06, place.get("allowedDeviationTheta", 0.0)), seed


@BOTH
def test_no_settings_file_ends_the_program_but_with_its_problem(count, tmp_path):
    values = {"serial_number": "r1", "keep_alive": 15, "host": "127.0.0.1", "speed": 0.5, "insecure": False}
    values["actions"] = {"horn": {"topic": "horn", "seconds": 2.0, "scopes": ["NODE"]}}
    valid = yaml.safe_dump(values).encode()
    path = tmp_path / "fleet.yaml"
    for payload in mutants(valid, count, seed=1):
        path.write_bytes(payload)
        with contextlib.suppress(SettingsError, OSError):
            assert isinstance(taken(read_settings, path), Settings)


@BOTH
def test_no_damage_of_its_file_ends_the_program(count, tmp_path):
    path, run = tmp_path / "memory.json", Run()
    run.send(order(PLACES, 2, actions={2: [action("horn", 1, "HARD")]}))
    Memory(path).save(vehicle=run.client.vehicle.dump(), position=[["hall", 1.0, 2.0, 0.5], 7])
    valid = path.read_bytes()
    for payload in mutants(valid, count, seed=1):
        path.write_bytes(payload)
        vehicle, _ = taken(lambda: recalled(Memory(path)))
        assert (vehicle.order_id == "o1") == (payload == valid)


class Wire:
    """Subscriptions without a master: `feed` is a message of a topic as it comes."""

    def __init__(self):
        self.arrive = {}

    def subscriber(self, topic, kind, receive, **_):
        self.arrive[topic] = kind, receive

    def feed(self, topic, data):
        kind, receive = self.arrive[topic]
        receive(kind().deserialize(data))


class Goals:
    """An action client whose goals are driven for ever."""

    def __init__(self, *_):
        self.feedback = None

    def wait_for_server(self, _):
        return True

    def send_goal(self, _goal, transition_cb, feedback_cb):
        self.feedback = feedback_cb
        return SimpleNamespace(cancel=lambda: None, get_comm_state=lambda: 0)


def wire_of(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


@pytest.fixture
def wire(monkeypatch):
    wire = Wire()
    monkeypatch.setattr(crossing.rospy, "Subscriber", wire.subscriber)
    monkeypatch.setattr(crossing, "boundary", crossing.Boundary(lambda _: None))
    monkeypatch.setattr(ros_robot.actionlib, "ActionClient", Goals)
    monkeypatch.setattr(ros_robot.time, "sleep", lambda _: None)
    monkeypatch.setattr(ros_robot, "LATE", math.inf)
    return wire


def valid_topics():
    odometry = Odometry(child_frame_id="base_link")
    odometry.header.frame_id, odometry.pose.pose.orientation.w = "odom", 1.0
    safety = SafetyStatus(state_name="DRIVE", speed_limit=math.inf, run=7, causes=["tilt"], sentences=["it tilts"])
    safety.remedies, safety.actors, safety.details = ["lift it"], ["operator"], ["0.5 rad"]
    return {
        "odom": odometry,
        "safety_status": safety,
        "robot_status": RobotStatus(mode="automatic", odometry_confidence=math.nan),
        "battery_state": BatteryState(percentage=0.5, voltage=24.0, temperature=math.nan),
    }


def client_on(wire, **settings):
    robot = ros_robot.RosRobot(Settings(visualization_rate=0.0, **settings), None)
    for topic, message in valid_topics().items():
        wire.feed(topic, wire_of(message))
    robot.map_odom = ["hall", 0.0, 0.0, 0.0]
    client = Client(robot, Settings(), MACHINE, Vehicle(), boundary=crossing.boundary)
    client.step(0.0)
    client.receive("order", encoded(order(PLACES)), 0.0)
    client.step(0.02)
    assert robot.progress.status == "driving"
    return robot, client


@pytest.mark.parametrize("number", [math.nan, math.inf, 1e300])
def test_odometry_that_is_no_place_is_dropped_and_the_client_goes_on(wire, number):
    _, client = client_on(wire)
    wrong = Odometry()
    wrong.pose.pose.position.x = number
    wire.feed("odom", wire_of(wrong))
    (state,) = [message for topic, message in client.step(31.0) if topic == "state"]
    encoded(state)
    assert (state["agvPosition"]["x"], crossing.boundary.dropped) == (0.0, {"odom": 1})
    assert client.vehicle.nodes


@BOTH
@pytest.mark.parametrize("topic", [*valid_topics(), "feedback"])
def test_no_message_of_a_topic_ends_the_client_or_holds_it_up(wire, topic, count):
    robot, client = client_on(wire)
    feedback = FollowPathActionFeedback()
    feedback.feedback.distance, feedback.feedback.state = 0.5, "driving"
    message = {**valid_topics(), "feedback": feedback}[topic]
    kind, _ = wire.arrive["follow_path/feedback"]
    for number, payload in enumerate(mutants(wire_of(message), count, seed=1)):
        if topic == "feedback":
            robot._client.feedback(None, taken(kind().deserialize, payload).feedback)
        else:
            taken(wire.feed, topic, payload)
        for name, out in taken(client.step, 0.02 * number):
            encoded(out)
            if name == "state":
                assert next(STATE.iter_errors({**header(), **out}), None) is None
    assert set(crossing.boundary.dropped) <= {topic, FollowPathActionFeedback._type}
    assert "a pass" not in crossing.boundary.dropped


@BOTH
@pytest.mark.parametrize("topic", ["status", "result"])
def test_no_message_of_the_action_raises_in_the_thread_that_reads_it(wire, topic, count):
    client_on(wire)
    kind, _ = wire.arrive[f"follow_path/{topic}"]
    status = GoalStatus(GoalID(id="1"), GoalStatus.ACTIVE, "driving")
    message = FollowPathActionResult(status=status) if topic == "result" else GoalStatusArray(status_list=[status])
    for payload in mutants(wire_of(message), count, seed=1):
        taken(kind().deserialize, payload)
    assert set(crossing.boundary.dropped) == {kind._type}


def test_a_goal_whose_status_is_lost_is_cancelled_for_it_may_go_on(wire, monkeypatch):
    robot, client = client_on(wire)
    monkeypatch.setattr(ros_robot.rospy.Time, "now", ros_robot.rospy.Time)
    robot._client.cancel_goals_at_and_before_time = lambda _: robot.__dict__.update(cancelled=True)
    lost = SimpleNamespace(get_goal_status=lambda: GoalStatus.LOST, get_result=lambda: None)
    lost.get_comm_state = lambda: CommState.DONE
    robot._transition(robot._goal, lost)
    assert robot.cancelled
    client.step(0.04)
    assert client.vehicle.paused
