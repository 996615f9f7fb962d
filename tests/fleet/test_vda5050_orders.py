"""The order rules of VDA 5050, chapters 6.6 to 6.12; docs/fleet.md has a table of rules and of these cases."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from robot_control.fleet.v2.capability import Capabilities
from robot_control.fleet.v2.curve import CurveError, points_of
from robot_control.fleet.v2.messages import RefusedError
from robot_control.fleet.v2.order import order_of
from robot_control.robot.pose import Pose
from support.virtual_robot import Run, VirtualRobot, ordered

from bench.fleet import sequences
from bench.fleet.messages import action, header, order

pytest.importorskip("jsonschema", reason="needs Debian's python3-jsonschema: scripts/setup --fleet")

ROOT = Path(__file__).parents[2]
LINE = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)]


def instant(*actions):
    return {**header(), "actions": list(actions)}


def kinds(state):
    return [error["errorType"] for error in state["errors"]]


def statuses(state):
    return {each["actionId"]: each["actionStatus"] for each in state["actionStates"]}


def nodes(state):
    return [(each["nodeId"], each["released"]) for each in state["nodeStates"]]


def end_of(run):
    """The place of the robot when its order is completed; it compares within 2 cm."""
    run.until_over()
    return pytest.approx((run.robot.pose.x, run.robot.pose.y), abs=0.02)


def malformed(**changes):
    with pytest.raises(RefusedError) as error:
        order_of({**order(LINE), **changes})
    assert error.value.error.kind == "validationError"
    return dict(error.value.error.references)["parameter"]


def changed(elements, number, **fields):
    return [{**each, **fields} if at == number else each for at, each in enumerate(elements)]


# 6.6.1, 6.6.2: structure, base and horizon


def test_a_valid_order_has_one_edge_less_than_nodes():
    assert malformed(edges=order(LINE)["edges"][:2]) == "edges"
    assert malformed(nodes=[], edges=[]) == "edges"
    assert order_of(order(LINE[:1])).edges == ()


def test_sequence_ids_run_over_nodes_and_edges():
    assert malformed(nodes=changed(order(LINE)["nodes"], 1, sequenceId=3)) == "nodes[1].sequenceId"
    assert malformed(edges=changed(order(LINE)["edges"], 1, sequenceId=5)) == "edges[1].sequenceId"
    assert malformed(nodes=changed(order(LINE)["nodes"], 0, sequenceId=1)) == "nodes[0].sequenceId"


def test_edges_lead_from_node_to_node():
    assert malformed(edges=changed(order(LINE)["edges"], 2, endNodeId="n1")) == "edges[2]"


def test_nothing_released_follows_what_is_not():
    assert malformed(nodes=changed(order(LINE, 2)["nodes"], 3, released=True), edges=order(LINE, 2)["edges"])
    assert malformed(edges=changed(order(LINE)["edges"], 0, released=False)) == "sequenceId 2"
    assert malformed(nodes=changed(order(LINE)["nodes"], 0, released=False)) == "nodes[0].released"


def test_an_edge_is_released_only_with_both_its_nodes():
    given = order(LINE, 3)
    assert malformed(nodes=given["nodes"], edges=changed(given["edges"], 2, released=True)) == "sequenceId 5"


def test_every_action_has_an_id_of_its_own():
    assert malformed(nodes=order(LINE, actions={0: [action("horn", 1)], 4: [action("horn", 1)]})["nodes"]) == "actionId"


def test_the_robot_stops_at_the_decision_point_and_shows_its_horizon():
    run = Run()
    assert nodes(run.send(order(LINE, 2))) == [("n1", True), ("n2", False), ("n3", False)]
    run.step(8.0)
    assert nodes(run.state) == [("n2", False), ("n3", False)]
    assert run.robot.pose.x == pytest.approx(1.0, abs=0.02)
    assert run.robot.motion.linear == 0.0
    assert run.state["lastNodeId"] == "n1"
    assert run.state["newBaseRequest"]


def test_the_first_node_is_one_on_which_the_robot_stands():
    run = Run(VirtualRobot(0.2, 0.0))
    state = run.send(order(LINE))
    assert kinds(state) == ["orderError"]
    assert not state["nodeStates"]
    wide = order(LINE)
    wide["nodes"][0]["nodePosition"]["allowedDeviationXY"] = 0.3
    assert nodes(run.send(wide))[0] == ("n1", True)


# 6.6.2: figure 8


def test_another_order_is_refused_while_one_is_executed():
    run = ordered(order(LINE))
    state = run.send(order(LINE, name="o2"))
    assert (state["orderId"], kinds(state)) == ("o1", ["orderError"])
    references = {each["referenceKey"]: each["referenceValue"] for each in state["errors"][0]["errorReferences"]}
    assert references["orderId"] == "o2"
    assert references["errorName"] == "OTHER_ORDER_ACTIVE"


def test_a_horizon_counts_as_executing():
    run = ordered(order(LINE, 1), 1.0)
    assert kinds(run.send(order(LINE, name="o2"))) == ["orderError"]


def test_another_order_is_taken_after_the_last_one():
    run = ordered(order(LINE[:2], actions={2: [action("horn", 1, "SOFT")]}), 6.0)
    assert kinds(run.send(order(LINE[1:], name="o2", first=0))) == ["orderError"]  # its action runs
    run.robot.ended.append(("1", "FINISHED", "ok"))
    run.step(0.1)
    state = run.send(order(LINE[1:], name="o2"))
    assert (state["orderId"], kinds(state), state["actionStates"]) == ("o2", [], [])


def test_an_update_with_a_lower_id_is_refused_and_the_order_goes_on():
    run = ordered(order(LINE, 2, update=5))
    state = run.send(order(LINE[1:], update=4, first=1))
    assert (state["orderUpdateId"], kinds(state)) == (5, ["orderUpdateError"])
    run.step(6.0)
    assert run.state["lastNodeId"] == "n1"


def test_the_same_update_is_ignored():
    run = ordered(order(LINE), 1.0)
    before = len(run.states)
    state = run.send(order(LINE))
    assert kinds(state) == []
    assert len(run.states) == before
    assert run.robot.goals == 1


def test_an_update_is_stitched_to_the_last_released_node_not_to_the_last_one():
    run = ordered(order(LINE, 2))
    assert kinds(run.send(order(LINE[3:], update=1, first=3))) == ["orderUpdateError"]
    state = run.send(order(LINE[1:3], update=1, first=1))
    assert kinds(state) == []
    assert nodes(state) == [("n1", True), ("n2", True)]


def test_the_decision_point_is_node_and_sequence():
    run = ordered(order(LINE, 2))
    other = order(LINE[1:], update=1, first=1)
    other["nodes"][0]["nodeId"] = other["edges"][0]["startNodeId"] = "n9"
    assert kinds(run.send(other)) == ["orderUpdateError"]


def test_a_horizon_can_be_changed_and_removed():
    run = ordered(order(LINE, 2, actions={4: [action("horn", 1)]}))
    assert statuses(run.state) == {"1": "WAITING"}
    state = run.send(order([(1.0, 0.0), (1.0, 1.0)], 1, update=1, first=1, actions={4: [action("horn", 2)]}))
    assert nodes(state) == [("n1", True), ("n2", False)]
    assert statuses(state) == {"2": "WAITING"}
    state = run.send(order(LINE[1:2], update=2, first=1))
    assert nodes(state) == [("n1", True)]
    assert statuses(state) == {}


def test_the_stitching_node_keeps_its_content():
    run = ordered(order(LINE, 2, actions={2: [action("horn", 1, "HARD")]}))
    run.send(order(LINE[1:], update=1, first=1, actions={2: [action("horn", 2)]}))
    assert statuses(run.state) == {"1": "WAITING"}
    run.step(7.0)
    assert [each.id for each in run.robot.begun] == ["1"]


def test_a_completed_order_is_continued_at_its_last_node():
    run = ordered(order(LINE[:2]))
    run.until_over()
    assert kinds(run.send(order(LINE[2:], update=1, first=2))) == ["orderUpdateError"]
    state = run.send(order(LINE[1:], update=2, first=1))
    assert kinds(state) == []
    assert nodes(state) == [("n2", True), ("n3", True)]
    assert end_of(run) == (3.0, 0.0)


def test_a_node_that_was_reached_is_not_measured_again():
    run = ordered(order(LINE[:2]))
    run.until_over()
    run.robot.pose = Pose(0.947, 0.0, 0.0)  # localization corrects the place
    run.step(0.1)
    assert kinds(run.send(order(LINE[1:], update=1, first=1))) == []
    assert end_of(run) == (3.0, 0.0)


def test_a_robot_stands_on_the_node_that_it_reached_last_until_it_drives():
    run = ordered(order(LINE[:2]))
    run.until_over()
    run.robot.pose = Pose(0.947, 0.0, 0.0)  # localization corrects the place
    run.step(0.1)
    elsewhere = order([(1.2, 0.0), *LINE[2:]], name="o2", first=1)
    assert kinds(run.send(elsewhere)) == ["orderError"]
    assert kinds(run.send(order(LINE[1:], name="o2", first=1))) == []
    assert end_of(run) == (3.0, 0.0)


@pytest.mark.parametrize("drop", ["cancelOrder", "MANUAL", "initPosition"])
def test_a_dropped_order_is_continued_only_on_its_last_node(drop):
    run = ordered(order(LINE[:1]))
    if drop == "cancelOrder":
        run.send(order(LINE, update=1))
        run.step(1.5)
        run.send(instant(action("cancelOrder", "c")))
        run.step(3.0)
    elif drop == "MANUAL":
        run.robot.given = replace(run.robot.given, mode="MANUAL")
        run.step(0.1)
        run.robot.given = replace(run.robot.given, mode="AUTOMATIC")
    else:
        place = {"x": 0.5, "y": 0.0, "theta": 0.0, "mapId": "hall", "lastNodeId": "n0"}
        run.send(instant(action("initPosition", "i", **place)))
    run.robot.pose = Pose(0.5, 0.0, 0.0)
    run.step(0.1)
    assert kinds(run.send(order(LINE, update=2))) == ["orderUpdateError"]
    run.robot.pose = Pose(0.0, 0.0, 0.0)
    run.step(0.1)
    assert kinds(run.send(order(LINE, update=2))) == []
    assert end_of(run) == (3.0, 0.0)


def test_a_loop_passes_one_node_twice():
    run = Run()
    loop = order([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.0)])
    for number, name in ((3, "n0"), (4, "n1")):
        loop["nodes"][number]["nodeId"] = name
    for number, (a, b) in enumerate([("n0", "n1"), ("n1", "n2"), ("n2", "n0"), ("n0", "n1")]):
        loop["edges"][number].update(startNodeId=a, endNodeId=b)
    run.send(loop)
    run.until_over()
    reached = [state["lastNodeSequenceId"] for state in run.states]
    assert sorted(set(reached)) == [0, 2, 4, 6, 8]
    assert reached == sorted(reached)


def test_an_error_is_reported_until_an_order_is_accepted():
    run = ordered(order(LINE, name=""), 31.0)
    assert kinds(run.state) == ["validationError"]
    assert kinds(run.send(order(LINE))) == []


# 6.6.3: cancelOrder


def test_cancel_order_stops_between_nodes_and_keeps_the_ids():
    run = ordered(order(LINE, actions={0: [action("horn", 1)], 4: [action("horn", 2)]}), 2.0)
    state = run.send(instant(action("cancelOrder", "c", "HARD")))
    assert statuses(state) == {"1": "FAILED", "2": "FAILED", "c": "RUNNING"}
    assert state["nodeStates"]
    run.step(3.0)
    assert statuses(run.state)["c"] == "FINISHED"
    assert run.robot.motion.linear == 0.0
    assert not run.state["nodeStates"]
    assert not run.state["edgeStates"]
    assert (run.state["orderId"], run.state["lastNodeId"]) == ("o1", "n0")
    assert 0.3 < run.robot.pose.x < 1.5


def test_cancel_order_waits_for_an_action_that_cannot_be_interrupted(monkeypatch):
    run = Run()
    monkeypatch.setattr(run.robot, "end", lambda _: False)
    run.send(order(LINE, actions={0: [action("horn", 1, "HARD")]}))
    run.step(1.0)
    run.send(instant(action("cancelOrder", "c")))
    run.step(1.0)
    assert statuses(run.state) == {"1": "RUNNING", "c": "RUNNING"}
    run.robot.ended.append(("1", "FINISHED", "done"))
    run.step(0.1)
    assert statuses(run.state) == {"1": "FINISHED", "c": "FINISHED"}
    assert not run.state["nodeStates"]


def test_cancel_order_without_an_order_fails_with_its_id():
    run = Run()
    state = run.send(instant(action("cancelOrder", "c")))
    assert statuses(state) == {"c": "FAILED"}
    assert kinds(state) == ["noOrderToCancel"]
    assert state["errors"][0]["errorReferences"][0] == {"referenceKey": "actionId", "referenceValue": "c"}


def cancelled():
    run = ordered(order(LINE), 1.5)
    run.send(instant(action("cancelOrder", "c")))
    run.step(3.0)
    assert not run.client.vehicle.executing
    return run


def test_after_a_cancel_an_order_begins_at_a_temporary_node():
    run = cancelled()
    x = run.robot.pose.x
    assert kinds(run.send(order([(x, 0.0), (x, 1.0)], name="o2"))) == []
    assert end_of(run) == (x, 1.0)


def test_after_a_cancel_an_order_begins_at_the_last_node_with_a_wide_deviation():
    run = cancelled()
    wide = order(LINE, name="o2")
    wide["nodes"][0]["nodePosition"]["allowedDeviationXY"] = 2.0
    assert kinds(run.send(wide)) == []
    goal = run.robot.pose.x
    assert end_of(run) == (3.0, 0.0)
    assert min(run.speeds[-100:]) >= 0
    assert goal < 3.0


# 6.6.4, 6.6.5, 6.7: what cannot be done


def field_refused(run, message, name, kind="orderError"):
    state = run.send(message)
    assert kinds(state) == [kind]
    assert not state["nodeStates"]
    references = {each["referenceKey"]: each["referenceValue"] for each in state["errors"][0]["errorReferences"]}
    assert name in references.values() or name in references, references


@pytest.mark.parametrize(
    ("fields", "name"),
    [
        ({"corridor": {"leftWidth": 1.0, "rightWidth": 1.0}}, "corridor"),
        ({"direction": "left"}, "direction"),
        ({"orientation": 1.0}, "orientation"),
        ({"orientation": 1.0, "orientationType": "GLOBAL"}, "orientation"),
        ({"orientationType": "SIDEWAYS"}, "orientationType"),
        ({"maxSpeed": 0.0}, "maxSpeed"),
        ({"maxRotationSpeed": -1.0}, "maxRotationSpeed"),
        ({"maxHeight": 0.1}, "maxHeight"),
        ({"minHeight": 0.5}, "minHeight"),
        (
            {"trajectory": {"degree": 1, "knotVector": [0, 0, 1, 1], "controlPoints": [{"x": 0, "y": 9}] * 2}},
            "trajectory",
        ),
        ({"trajectory": {"degree": 2, "knotVector": [0, 1], "controlPoints": [{"x": 0, "y": 0}] * 3}}, "trajectory"),
    ],
)
def test_a_field_that_cannot_be_followed_is_refused_with_its_name(fields, name):
    field_refused(Run(), order(LINE, **fields), name)


def test_unknown_actions_other_maps_zones_and_missing_places_are_refused():
    field_refused(Run(), order(LINE, actions={2: [action("dance", 7)]}), "7")
    field_refused(Run(), order(LINE, actions={2: [action("cancelOrder", 7)]}), "7")
    field_refused(Run(), {**order(LINE), "zoneSetId": "z"}, "zoneSetId")
    other = order(LINE)
    other["nodes"][2]["nodePosition"]["mapId"] = "cellar"
    field_refused(Run(), other, "cellar")
    del other["nodes"][2]["nodePosition"]
    field_refused(Run(), other, "n2")


def test_no_order_is_taken_before_the_position_is_initialized():
    robot = VirtualRobot()
    robot.given = replace(robot.given, map_id="")
    run = Run(robot)
    state = run.send(order(LINE))
    assert kinds(state) == ["orderError"]
    assert not state["agvPosition"]["positionInitialized"]
    given = {"x": 5.0, "y": 0.0, "theta": 0.0, "mapId": "hall", "lastNodeId": "n7"}
    state = run.send(instant(action("initPosition", 1, **given)))
    assert statuses(state) == {"1": "FINISHED"}
    assert state["lastNodeId"] == "n7"
    assert (state["agvPosition"]["x"], state["agvPosition"]["mapId"]) == (5.0, "hall")
    assert run.send(order([(5.0, 0.0), (6.0, 0.0)]))["nodeStates"]
    run.send(instant(action("initPosition", 2, **given), action("initPosition", 3)))
    run.until_over()
    assert statuses(run.state) == {"2": "FAILED", "3": "FAILED"}
    assert run.robot.pose.x == pytest.approx(6.0, abs=0.02)


# 6.6.6: the way


def test_max_speed_holds_on_its_edge():
    run = Run()
    message = order(LINE)
    message["edges"][1]["maxSpeed"] = 0.2
    run.send(message)
    slow = []
    while run.client.vehicle.executing:
        run.step(0.02)
        if 1.0 < run.robot.pose.x < 2.0:
            slow.append(run.robot.motion.linear)
    assert 0.18 < max(slow) < 0.22


@pytest.mark.parametrize(("fields", "sign"), [({"orientation": math.pi}, -1), ({"orientation": 0.0}, 1)])
@pytest.mark.parametrize("kind", ["TANGENTIAL", "GLOBAL"])
def test_an_edge_is_driven_forwards_or_backwards(fields, sign, kind):
    run = Run(VirtualRobot(yaw=0.0 if sign > 0 else math.pi))
    run.send(order(LINE[:2], orientationType=kind, **fields))
    assert end_of(run) == (1.0, 0.0)
    assert (max(run.speeds), min(run.speeds)) == pytest.approx((0.5, 0.0) if sign > 0 else (0.0, -0.5), abs=0.02)


def test_the_robot_takes_the_orientation_of_a_node_and_drives_on():
    run = Run()
    message = order([(0.0, 0.0), (1.0, 0.0, math.pi / 2), (2.0, 0.0)])
    run.send(message)
    turned = []
    while run.client.vehicle.executing:
        run.step(0.02)
        turned.append(run.robot.pose.yaw)
    assert max(turned) == pytest.approx(math.pi / 2, abs=0.03)
    assert run.robot.pose.x == pytest.approx(2.0, abs=0.02)


def test_an_edge_without_length_turns_the_robot_on_the_spot():
    run = Run()
    state = run.send(order([(0.0, 0.0, 0.0), (0.0, 0.0, math.pi / 2), (0.0, 0.0), (0.0, 1.0)]))
    assert (kinds(state), state["lastNodeId"]) == ([], "n0")
    while run.state["lastNodeId"] == "n0":
        run.step(0.02)
    assert run.robot.pose.yaw == pytest.approx(math.pi / 2, abs=0.02)
    assert (run.robot.pose.x, run.robot.pose.y) == (0.0, 0.0)
    assert end_of(run) == (0.0, 1.0)
    field_refused(Run(), order([(0.0, 0.0)] * 2, orientation=1.0, orientationType="GLOBAL"), "orientation")


@pytest.mark.parametrize("places", [[], [(1.0, 0.0)]])
def test_the_robot_takes_the_orientation_of_the_first_node_before_it_counts_as_reached(places):
    run = Run()
    state = run.send(order([(0.0, 0.0, math.pi / 2), *places], actions={0: [action("horn", 1, "HARD")]}))
    assert (kinds(state), nodes(state)[0], statuses(state)) == ([], ("n0", True), {"1": "WAITING"})
    assert kinds(run.send(order([(0.0, 0.0)], name="o2"))) == ["orderError"]
    while run.state["lastNodeId"] == "":
        run.step(0.02)
    assert run.robot.pose.yaw == pytest.approx(math.pi / 2, abs=0.02)
    assert statuses(run.state) == {"1": "RUNNING"}
    run.robot.ended.append(("1", "FINISHED", ""))
    run.until_over()
    assert (run.robot.pose.x, run.robot.pose.y) == pytest.approx((*places, (0.0, 0.0))[0], abs=0.02)


def test_an_orientation_within_its_deviation_needs_no_turn():
    run = Run(VirtualRobot(yaw=0.3))
    message = order([(0.0, 0.0, 0.0)])
    message["nodes"][0]["nodePosition"]["allowedDeviationTheta"] = 0.4
    assert run.send(message)["lastNodeId"] == "n0"
    assert run.robot.goals == 0


@pytest.mark.parametrize("after", ["startPause", "cancelOrder", "restart"])
def test_a_turn_on_the_first_node_is_paused_cancelled_and_kept_as_any_way(after):
    run = ordered(order([(0.0, 0.0, math.pi / 2), (1.0, 0.0)]), 0.5)
    if after == "restart":
        run.restart()
    else:
        run.send(instant(action(after, "a")))
    run.step(2.0)
    assert run.robot.motion.angular == 0.0
    assert run.state["lastNodeId"] == ""
    if after == "cancelOrder":
        assert (statuses(run.state)["a"], nodes(run.state)) == ("FINISHED", [])
        return
    assert nodes(run.state)[0] == ("n0", True)
    run.send(instant(action("stopPause", "s")))
    run.until_over()
    assert (run.state["lastNodeId"], kinds(run.state)) == ("n1", [])


def test_a_straight_edge_of_any_length_follows_a_curve():
    arc = {
        "degree": 2,
        "knotVector": [0, 0, 0, 1, 1, 1],
        "controlPoints": [{"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 1, "y": 1}],
    }
    for length in (1.0, 2.0, 7.3):
        run = Run()
        message = order([(0.0, 0.0), (1.0, 1.0), (1.0, 1.0 + length)])
        message["edges"][0]["trajectory"] = arc
        assert kinds(run.send(message)) == []
        run.until_over()
        assert kinds(run.state) == []
        assert (run.robot.pose.x, run.robot.pose.y) == pytest.approx((1.0, 1.0 + length), abs=0.02)
    for angle in np.arange(0.0, 1.6, 0.016):  # rounding may make a piece of whole metres longer than they are
        run = Run()
        message = order([(0.0, 0.0), (1.0, 1.0), (1.0 + 5 * math.sin(angle), 1.0 + 5 * math.cos(angle))])
        message["edges"][0]["trajectory"] = arc
        run.send(message)
        run.step(0.1)
        assert kinds(run.state) == [], angle


def test_a_trajectory_is_a_nurbs():
    """A quarter of a circle of 1 m, as in The NURBS Book, 7.3."""
    arc = {
        "degree": 2,
        "knotVector": [0, 0, 0, 1, 1, 1],
        "controlPoints": [{"x": 0, "y": 0}, {"x": 1, "y": 0, "weight": math.sqrt(0.5)}, {"x": 1, "y": 1}],
    }
    assert [math.hypot(x, y - 1) for x, y in points_of(arc)] == pytest.approx([1.0] * len(points_of(arc)))
    run = ordered(order([(0.0, 0.0), (1.0, 1.0)], trajectory=arc))
    assert end_of(run) == (1.0, 1.0)
    cubic = {
        "degree": 1,
        "knotVector": [0, 0, 0.5, 1, 1],
        "controlPoints": [{"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 1, "y": 2}],
    }
    assert points_of(cubic) == [(0, 0), (1, 0), (1, 2)]
    for wrong in ({"degree": 3}, {"knotVector": [0, 0, 0, 1, 1]}, {"knotVector": [0, 0, 0, 1, 0.5, 1]}):
        with pytest.raises(CurveError):
            points_of({**arc, **wrong})


def test_trajectories_that_take_seconds_to_plan_are_refused():
    far = {"degree": 2, "knotVector": [0, 0, 0, 1, 1, 1], "controlPoints": [{"x": x, "y": 0} for x in (0, 75, 150)]}
    back = {**far, "controlPoints": far["controlPoints"][::-1]}
    message = order([(0.0, 0.0), (150.0, 0.0)] * 10)
    for number, edge in enumerate(message["edges"]):
        edge["trajectory"] = back if number % 2 else far
    field_refused(Run(), message, "trajectory")


def test_a_corner_of_a_trajectory_needs_rotation_to_be_allowed():
    corner = {
        "degree": 1,
        "knotVector": [0, 0, 0.5, 1, 1],
        "controlPoints": [{"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 1, "y": 1}],
    }
    places = [(0.0, 0.0), (1.0, 1.0)]
    field_refused(Run(), order(places, trajectory=corner, rotationAllowed=False), "rotationAllowed")
    assert Run().send(order(places, trajectory=corner))["nodeStates"]


# an obstacle before the collision guard


def blocked_run(seconds, **settings):
    """A run whose guard holds the robot on the first edge for so many seconds."""
    run = Run(**settings)
    run.send(order(LINE))
    run.step(1.0)
    run.robot.given = replace(run.robot.given, blocked_by="the laser sees an obstacle 0.03 m from the robot")
    run.step(seconds)
    return run


def test_an_order_that_meets_an_obstacle_waits_reports_it_and_goes_on():
    run = blocked_run(3.0)
    assert run.state["driving"] is False
    assert run.state["paused"] is False
    (error,) = run.state["errors"]
    assert (error["errorType"], error["errorLevel"]) == ("pathBlocked", "WARNING")
    references = {each["referenceKey"]: each["referenceValue"] for each in error["errorReferences"]}
    assert references == {"orderId": "o1", "edgeId": "e0", "nodeId": "n1"}
    assert "remove the obstacle" in error["errorHint"]
    run.robot.given = replace(run.robot.given, blocked_by="")
    run.step(0.5)
    assert run.state["driving"] is True
    assert run.state["errors"] == []
    assert end_of(run) == (3.0, 0.0)
    assert run.robot.goals == 1


def test_one_message_reports_an_obstacle_whatever_its_distance_becomes():
    run = blocked_run(3.0)
    sent = len(run.states)
    for number in range(20):
        run.robot.given = replace(run.robot.given, blocked_by=f"an obstacle {number} mm from the robot")
        run.step(0.1)
    assert len(run.states) == sent


def test_an_order_fails_that_an_obstacle_holds_for_blocked_timeout_and_goes_on_after_stop_pause():
    run = blocked_run(12.0, blocked_timeout=10.0)
    assert run.state["paused"] is True
    assert kinds(run.state) == ["drivingError"]
    run.robot.given = replace(run.robot.given, blocked_by="")
    run.step(5.0)
    assert run.state["driving"] is False
    run.send(instant(action("stopPause", 7)))
    assert end_of(run) == (3.0, 0.0)


# 6.8, 6.9: instant actions


def test_a_pause_stands_and_the_order_goes_on_after_it():
    run = ordered(order(LINE), 2.0)
    state = run.send(instant(action("startPause", "p", "HARD")))
    assert state["paused"]
    assert statuses(state) == {"p": "RUNNING"}
    run.step(3.0)
    assert statuses(run.state) == {"p": "FINISHED"}
    assert run.robot.motion.linear == 0.0
    assert run.state["nodeStates"]
    assert not run.send(instant(action("stopPause", "s")))["paused"]
    assert end_of(run) == (3.0, 0.0)


def test_an_instant_action_that_comes_twice_runs_once():
    run = Run()
    for _ in range(2):
        run.send(instant(action("horn", 1)))
    run.step(0.1)
    assert [each.id for each in run.robot.begun] == ["1"]


def test_state_and_factsheet_are_sent_on_request():
    run = Run()
    before = len(run.sent)
    run.send(instant(action("stateRequest", 1), action("factsheetRequest", 2)))
    assert [topic for topic, _ in run.sent[before:]] == ["factsheet", "state"]
    assert statuses(run.state) == {"1": "FINISHED", "2": "FINISHED"}


def test_an_unknown_instant_action_fails_with_an_error():
    run = Run()
    state = run.send(instant(action("dance", 1), action("horn", 2)))
    assert statuses(state)["1"] == "FAILED"
    assert kinds(state) == ["orderError"]


# 6.10: the state


def test_a_state_is_sent_every_30_s_and_on_events_alone():
    run = Run()
    run.step(1.0)
    before = len(run.states)
    run.step(60.0)
    assert len(run.states) - before == 2


def test_a_node_is_reached_within_its_deviation_with_its_edge():
    run = Run()
    message = order(LINE)
    message["nodes"][1]["nodePosition"]["allowedDeviationXY"] = 0.4
    run.send(message)
    while run.state["lastNodeId"] == "n0":
        run.step(0.02)
    assert run.robot.pose.x == pytest.approx(0.6, abs=0.05)
    assert [each["edgeId"] for each in run.state["edgeStates"]] == ["e1", "e2"]


def test_no_stop_at_a_node_where_the_base_goes_on():
    run = ordered(order(LINE, 2, maxSpeed=0.4), 1.5)
    run.send(order(LINE[1:], update=1, first=1, maxSpeed=0.4))
    passing = []
    while run.robot.pose.x < 2.5:
        run.step(0.02)
        if run.robot.pose.x > 0.8:
            passing.append(run.robot.motion.linear)
    assert min(passing) >= 0.9 * 0.4


def test_a_new_base_is_requested_before_the_robot_brakes():
    run = ordered(order([(0.0, 0.0), (3.0, 0.0), (4.0, 0.0)], 2))
    while not run.state["newBaseRequest"]:
        run.step(0.02)
    assert run.robot.pose.x == pytest.approx(3.0 - 0.5**2 / 0.6 - 1.0, abs=0.15)
    assert run.robot.motion.linear == pytest.approx(0.5, abs=0.01)


def test_a_person_who_drives_clears_the_order():
    run = ordered(order(LINE, actions={4: [action("horn", 1)]}), 1.0)
    run.robot.given = replace(run.robot.given, mode="MANUAL")
    run.step(3.0)
    assert run.state["operatingMode"] == "MANUAL"
    assert not run.state["nodeStates"]
    assert statuses(run.state) == {"1": "FAILED"}
    assert run.robot.motion.linear == 0.0
    assert kinds(run.send(order(LINE, name="o2"))) == ["orderError"]


def test_after_a_stop_nothing_moves_by_itself():
    run = ordered(order(LINE), 2.0)
    run.robot.given = replace(run.robot.given, may_drive=False, stopped=True)
    run.step(3.0)
    assert run.state["safetyState"]["eStop"] == "MANUAL"
    assert run.state["paused"]
    assert run.state["nodeStates"]
    assert statuses(run.send(instant(action("stopPause", 1))))["1"] == "FAILED"
    run.robot.given = replace(run.robot.given, may_drive=True, stopped=False)
    run.step(5.0)
    assert run.state["paused"]
    assert run.robot.motion.linear == 0.0
    run.send(instant(action("stopPause", 2)))
    assert end_of(run) == (3.0, 0.0)
    assert kinds(run.state) == []


def test_a_gap_of_the_messages_pauses_no_order_and_a_stop_that_was_not_seen_does():
    run = ordered(order(LINE, 2), 6.0)
    run.robot.given = replace(run.robot.given, silent=True)
    run.step(1.0)
    run.send(order(LINE[1:], update=1, first=1))
    run.step(1.0)
    assert run.robot.pose.x == pytest.approx(1.0, abs=0.02)
    run.robot.given = replace(run.robot.given, silent=False)
    run.step(1.0)
    assert not run.state["paused"]
    assert run.robot.motion.linear > 0.1
    run.robot.given = replace(run.robot.given, permit=(0, 1))
    run.step(0.1)
    assert run.state["paused"]


def test_after_a_restart_the_order_stands_paused():
    run = ordered(order(LINE, actions={6: [action("horn", 1)]}), 2.0)
    run.restart()
    run.step(3.0)
    assert run.state["paused"]
    assert nodes(run.state)[-1] == ("n3", True)
    assert run.robot.motion.linear == 0.0
    assert statuses(run.state) == {"1": "WAITING"}
    run.send(instant(action("stopPause", 2)))
    while not run.robot.begun and run.now < 60.0:
        run.step(0.1)
    run.step(1.0)
    assert run.robot.pose.x == pytest.approx(3.0, abs=0.02)


def test_what_waited_while_the_client_stood_still_moves_nothing():
    run = Run()
    run.now += 5.0
    state = run.send(order(LINE))
    assert kinds(state) == ["orderError"]
    assert run.robot.goals == 0
    run.step(1.0)
    assert run.send(order(LINE))["nodeStates"]


# 6.11, 6.12: actions of nodes and edges


def test_none_drives_on_soft_and_hard_stop():
    for blocking, stands in (("NONE", False), ("SOFT", True), ("HARD", True)):
        run = Run()
        run.send(order(LINE, actions={2: [action("horn", 1, blocking)]}))
        run.step(8.0)
        assert statuses(run.state) == {"1": "RUNNING"}
        assert (run.state["lastNodeId"] == "n1") == stands, blocking
        run.robot.ended.append(("1", "FINISHED", "well"))
        run.until_over()
        assert run.state["actionStates"][0]["resultDescription"] == "well"


def test_hard_runs_alone_and_in_its_sequence():
    run = Run()
    given = [action("horn", 1, "SOFT"), action("horn", 2, "NONE"), action("horn", 3, "HARD"), action("horn", 4, "NONE")]
    run.send(order(LINE, actions={0: given}))
    seen = []
    for ended in ("1", "2", "3", "4"):
        run.step(0.1)
        seen.append([name for name, status in statuses(run.state).items() if status == "RUNNING"])
        assert run.state["lastNodeId"] == "n0"
        run.robot.ended.append((ended, "FINISHED", ""))
    assert seen == [["1", "2"], ["2"], ["3"], ["4"]]


def test_an_action_of_an_edge_ends_with_it():
    run = ordered(order(LINE, actions={1: [action("horn", 1)], 3: [action("horn", 2)]}), 1.0)
    assert statuses(run.state) == {"1": "RUNNING", "2": "WAITING"}
    run.step(2.5)
    assert run.state["lastNodeId"] == "n1"
    assert statuses(run.state) == {"1": "FINISHED", "2": "RUNNING"}


def test_an_edge_of_the_horizon_is_entered_when_it_is_released():
    run = ordered(order(LINE, 1, actions={1: [action("horn", 1)]}), 1.0)
    assert statuses(run.state) == {"1": "WAITING"}
    run.send(order(LINE, update=1, actions={1: [action("horn", 2)]}))
    run.step(0.1)
    assert statuses(run.state) == {"2": "RUNNING"}


def test_random_sequences_agree_with_the_model():
    failed, seen, why = sequences.run(0, 1000)
    assert not failed, why
    assert min(seen[name] for name in ("new taken", "update taken", "update refused", "update ignored", "node")) > 100
    assert min(seen[name] for name in ("new refused", "cancel", "cancel refused", "action")) > 100


def test_the_capabilities_without_a_map_refuse_everything():
    with pytest.raises(RefusedError, match="not initialized"):
        Capabilities().refuse(order_of(order(LINE)))


def test_the_table_of_the_page_names_every_case():
    table = set(re.findall(r"`(test_\w+)`", (ROOT / "docs/fleet.md").read_text()))
    own = {name for name in globals() if name.startswith("test_")} - {"test_the_table_of_the_page_names_every_case"}
    assert own <= table, f"not in the table: {sorted(own - table)}"
