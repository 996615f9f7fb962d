"""Values that any node may set on the parameter server are refused by name, value and remedy, without a traceback."""

import contextlib
from pathlib import Path
from types import SimpleNamespace

import pytest
import rosgraph
import rospy
from robot_control.drive.pad.main import parameters as pad_parameters
from robot_control.robot import running_robot
from robot_control.robot.server_values import ServerValueError, server_text, server_tree
from robot_control.watch.view import state_publisher, wheels

NO_TEXT = ([1, 2], 5, -0.0, float("nan"), True, {"a": [1]})
NO_TREE = ([1, 2], 5, float("nan"), True, "text")


@pytest.fixture
def server(monkeypatch):
    """The values of the server by name, all of which may be set."""
    values = {}
    monkeypatch.setattr(rospy, "get_param", lambda name, default=None: values.get(name, default))
    monkeypatch.setattr(rospy, "resolve_name", lambda name: f"/{name}")
    return values


def test_nothing_and_an_empty_text_are_no_value(server):
    for unset in ({}, {"a": ""}):
        server.update(unset)
        assert server_text("a", "the path of a file") == ""
        assert server_tree("a") == {}


def test_an_empty_text_below_a_name_is_no_parameter(server):
    server["a"] = {"b": "", "c": {"d": "", "e": 0}, "f": False}
    assert server_tree("a") == {"c": {"e": 0}, "f": False}


def test_a_tool_reads_the_parameters_of_a_launch_whose_arguments_were_not_given(server, monkeypatch):
    monkeypatch.setattr(rosgraph, "is_master_online", lambda: True)
    monkeypatch.setattr(running_robot, "begin_node", lambda *_, **__: None)
    server["robot"] = {"bus": "", "clock": "wall", "command_script": "", "urdf": ""}
    server["robot_description"] = "<robot/>"
    with running_robot.running_settings("tool", "controller", "", "") as settings:
        values = dict(settings.values)
        assert values.keys() == {"robot.clock", "robot.urdf"}
        assert Path(values["robot.urdf"]).read_text() == "<robot/>"


@pytest.mark.parametrize("value", NO_TEXT)
def test_a_text_of_another_type_is_refused_with_value_and_remedy(server, value):
    server["a"] = value
    with pytest.raises(ServerValueError) as refusal:
        server_text("a", "the path of a file")
    assert str(refusal.value).startswith(f"/a = {value}: must be a text, the path of a file; ")
    assert "`rosparam delete /a`" in str(refusal.value)


@pytest.mark.parametrize("value", NO_TREE)
def test_a_single_value_is_no_group(server, value):
    server["a"] = value
    with pytest.raises(ServerValueError, match="must be a group of parameters"):
        server_tree("a")


@pytest.mark.parametrize("name", ["controller", "controller/config", "robot", "robot_description"])
@pytest.mark.parametrize("value", [[1, 2], 5])
def test_a_tool_that_drives_the_robot_begins_with_no_such_value(server, monkeypatch, name, value):
    monkeypatch.setattr(rosgraph, "is_master_online", lambda: True)
    monkeypatch.setattr(running_robot, "begin_node", lambda *_, **__: None)
    server[name] = value
    refused = pytest.raises(ServerValueError, match=f"/{name} = ")
    with refused, running_robot.running_settings("tool", "controller", "", ""):
        pytest.fail("it began")


@pytest.mark.parametrize("value", NO_TREE)
def test_the_pad_has_no_such_parameters(server, value):
    server["~"] = value
    with pytest.raises(ServerValueError, match="must be a group of parameters"):
        pad_parameters()


@pytest.mark.parametrize("name", ["robot", "robot_description"])
@pytest.mark.parametrize("value", [[1, 2], 5])
def test_a_robot_that_no_node_reads_is_shown_without_wheels(server, name, value):
    server[name] = value
    assert wheels.running_robot() == ({}, None)


@pytest.mark.parametrize("value", NO_TEXT)
def test_no_transforms_are_published_of_such_a_description(server, monkeypatch, value):
    going_on = SimpleNamespace(going_on=lambda: True)
    monkeypatch.setattr(state_publisher, "ended_by_signals", lambda: contextlib.nullcontext(going_on))
    server["robot_description"] = value
    with pytest.raises(ServerValueError, match="robot_description = "):
        state_publisher.await_description()
