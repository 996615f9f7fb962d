"""Where sim.launch and backend.launch let their nodes listen, and which files their arguments mean."""

import re
from pathlib import Path

import pytest
from roslaunch.config import ROSLaunchConfig
from roslaunch.substitution_args import resolve_args
from roslaunch.xmlloader import XmlLoader

LAUNCH = Path(__file__).parents[2] / "launch"
NODES = ("state_estimator", "diff_drive_controller", "safety_monitor")
VARIABLES = ("ROS_IP", "ROS_HOSTNAME", "ROS_MASTER_URI")


@pytest.fixture(params=["sim.launch", "backend.launch"])
def default(request, monkeypatch):
    """The default of `ip` under these variables."""
    expression = re.search(r'name="ip" default="(.*?)" doc', (LAUNCH / request.param).read_text())[1]

    def resolve(**variables):
        for name in VARIABLES:
            monkeypatch.delenv(name, raising=False)
        for name, value in variables.items():
            monkeypatch.setenv(name, value)
        return resolve_args(expression, context={"arg": {}})

    return resolve


@pytest.mark.parametrize("master", ["http://localhost:11311", "http://127.0.0.1:11400", "http://127.0.1.1:11311"])
def test_a_master_on_this_machine_alone_means_the_loopback(default, master):
    assert default(ROS_MASTER_URI=master) == "127.0.0.1"


def test_an_empty_environment_means_the_loopback(default):
    assert default() == "127.0.0.1"


@pytest.mark.parametrize(
    "variables",
    [{"ROS_IP": "192.0.2.7"}, {"ROS_HOSTNAME": "robot"}, {"ROS_MASTER_URI": "http://robot:11311"}],
)
def test_whoever_speaks_of_a_network_is_left_with_it(default, variables):
    assert default(**variables) == ""


@pytest.mark.parametrize(("launch", "name"), [("backend", "params"), ("backend", "urdf"), ("sim", "out")])
def test_relative_paths_count_from_the_callers_folder(launch, name, monkeypatch):
    expression = re.search(rf'name="{name}_path" value="(.*?)"/>', (LAUNCH / f"{launch}.launch").read_text())[1]
    monkeypatch.setenv("PWD", "/called/here")
    monkeypatch.setenv("HOME", "/home/me")

    def resolve(value):
        return resolve_args(expression, context={"arg": {name: value}})

    assert resolve("rel/file") == "/called/here/rel/file"
    assert resolve("5") == "/called/here/5"
    assert resolve("/abs") == "/abs"
    assert resolve("~/x") == "/home/me/x"
    assert resolve("") == ""


def test_a_word_alone_is_a_shipped_scene(monkeypatch):
    expression = re.search(r'name="scene_path" value="(.*?)"/>', (LAUNCH / "sim.launch").read_text())[1]
    monkeypatch.setenv("PWD", "/called/here")

    def resolve(value):
        return resolve_args(expression, context={"arg": {"scene": value}})

    assert resolve("slope_5deg").endswith("/urdf/scenes/slope_5deg.xml")
    assert resolve("mine.xml") == "/called/here/mine.xml"
    assert resolve("worlds/mine.xml") == "/called/here/worlds/mine.xml"
    assert resolve("/abs/mine.xml") == "/abs/mine.xml"


def programs_of(*arguments):
    """Node name → program that sim.launch starts."""
    config = ROSLaunchConfig()
    XmlLoader(resolve_anon=False).load(str(LAUNCH / "sim.launch"), config, argv=list(arguments), verbose=False)
    return {node.name: node.type for node in config.nodes}


def test_a_simulation_starts_the_programs_of_the_robot():
    started = programs_of()
    assert started["mujoco_plant"] == "mujoco_plant"
    assert {name: started[name] for name in NODES} == {name: name for name in NODES}


def test_for_faults_it_starts_other_programs_under_the_same_names():
    assert programs_of("faults:=true") == {
        "mujoco_plant": "mujoco_plant",
        **{name: f"{name}_with_faults" for name in NODES},
    }


def test_every_argument_that_a_user_may_give_is_set_in_every_launch():
    """What is set under a condition stays in the roscore when the condition is false the next time."""
    for name in ("sim", "backend"):
        text = (LAUNCH / f"{name}.launch").read_text()
        outside = re.sub(r"<node .*?</node>", "", text, flags=re.DOTALL)
        assert not re.search(r"<param (if|unless)=", outside), name
        for node in re.findall(r"<node .*?</node>", text, flags=re.DOTALL):
            assert "<param if=" not in node or 'clear_params="true"' in node, node
