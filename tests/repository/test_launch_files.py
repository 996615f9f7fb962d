"""The launch files set the addresses of their nodes and pass the files of their arguments."""

import re
from pathlib import Path

import pytest
from roslaunch.config import ROSLaunchConfig
from roslaunch.xmlloader import XmlLoader

LAUNCH = Path(__file__).parents[2] / "launch"
NODES = ("state_estimator", "diff_drive_controller", "safety_monitor")
VARIABLES = ("ROS_IP", "ROS_HOSTNAME", "ROS_MASTER_URI")


@pytest.fixture(params=["sim.launch", "robot.launch"])
def default(request, monkeypatch):
    """The address that a launch file gives its nodes under these variables; "" where it leaves the environment's."""

    def resolve(**variables):
        for name in VARIABLES:
            monkeypatch.delenv(name, raising=False)
        for name, value in variables.items():
            monkeypatch.setenv(name, value)
        return dict(config_of(request.param).nodes[0].env_args).get("ROS_IP", "")

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


def test_no_expression_is_long():
    for path in LAUNCH.glob("*.launch"):
        for expression in re.findall(r'"(\$\(eval .*?\))"', path.read_text()):
            assert len(expression) <= 80, f"{path.name}: {expression}"


@pytest.mark.parametrize("launch", ["sim.launch", "robot.launch", "console.launch"])
def test_paths_are_passed_as_given_with_the_callers_folder(launch, monkeypatch):
    monkeypatch.setenv("PWD", "/called/here")
    monkeypatch.delenv("HOME", raising=False)
    monkeypatch.delenv("ROS_HOME", raising=False)
    given = [] if launch == "console.launch" else ["params:=5", "urdf:=~/mine.urdf"]
    config = config_of(launch, *given)
    for node in config.nodes:
        assert dict(node.env_args)["ROBOT_CONTROL_CALLER_FOLDER"] == "/called/here", node.name
    if given:
        assert config.params["/state_estimator/config"].value == "5"
        assert config.params["/robot/urdf"].value == "~/mine.urdf"
        assert config.params["/telemetry/directory"].value == "~/.ros/robot_control"


def test_a_single_word_is_an_included_scene_or_robot():
    def scene(value):
        return config_of("sim.launch", f"scene:={value}").params["/mujoco_plant/scene"].value

    assert scene("slope_5deg").endswith("/urdf/scenes/slope_5deg.xml")
    assert scene("mine.xml") == "mine.xml"
    assert scene("worlds/mine") == "worlds/mine"
    included = config_of("sim.launch", "robot:=quadbot").params["/robot/urdf"].value
    assert included.endswith("/urdf/quadbot.urdf")
    assert config_of("sim.launch", "robot:=quadbot", "urdf:=my.urdf").params["/robot/urdf"].value == "my.urdf"


def config_of(launch, *arguments):
    """The configuration that roslaunch derives."""
    config = ROSLaunchConfig()
    XmlLoader(resolve_anon=False).load(str(LAUNCH / launch), config, argv=list(arguments), verbose=False)
    return config


def test_the_nodes_report_no_override_that_a_launch_file_sets():
    setup = (LAUNCH.parent / "src/ros/startup/setup.cpp").read_text()
    unsaid = set(re.findall(r"[\w.]+", re.search(r"kSetByLaunch =(.*?);", setup, re.DOTALL)[1]))
    set_here: set[str] = set()
    for arguments in (
        ["robot.launch"],
        ["sim.launch", "black_box:=false", "telemetry:=true"],
        ["navigation.launch", "map:=x", "map_frame:=odom"],
    ):
        set_here |= {name[1:].partition("/")[2].replace("/", ".") for name in config_of(*arguments).params}
    assert set_here - {"", "config"} == unsaid


def test_navigation_simulates_the_robot_of_its_arguments_with_a_laser():
    params = config_of("navigation.launch", "scene:=room", "robot:=quadbot", "zones:=my_zones.yaml").params
    assert params["/robot/urdf"].value.endswith("/urdf/quadbot.urdf")
    assert params["/robot/simulated_laser"].value is True
    assert params["/navigate/zones"].value == "my_zones.yaml"
    given = config_of("navigation.launch", "scene:=room", "urdf:=my.urdf", "kind:=legs", "seed:=7").params
    assert (given["/robot/urdf"].value, given["/robot/kind"].value) == ("my.urdf", "legs")
    assert given["/mujoco_plant/seed"].value == 7
    assert config_of("robot.launch").params["/robot/simulated_laser"].value == ""
    assert config_of("sim.launch", "laser_rate:=0").params["/robot/simulated_laser"].value == ""


def test_navigation_without_a_map_starts_neither_slam_nor_localization():
    def nodes(*arguments):
        return {node.type for node in config_of("navigation.launch", *arguments).nodes}

    assert {"slam", "navigate"} <= nodes()
    assert nodes("map_frame:=odom") == nodes() - {"slam"}
    assert config_of("navigation.launch", "map_frame:=odom").params["/navigate/map_frame"].value == "odom"
    assert "/navigate/map_frame" not in config_of("navigation.launch").params


def test_an_address_is_taken_as_given():
    for launch in ("sim.launch", "robot.launch"):
        assert dict(config_of(launch, "ip:=192.0.2.7").nodes[0].env_args)["ROS_IP"] == "192.0.2.7"


def test_a_real_machine_is_commanded_by_the_driver_and_keeps_its_latch():
    real, simulated = config_of("robot.launch", "drives:=x"), config_of("sim.launch")
    assert real.params["/robot/driver"].value == "can"
    assert simulated.params["/robot/driver"].value == ""
    assert real.params["/safety_monitor/latch_file"].value
    assert not simulated.params["/safety_monitor/latch_file"].value
    assert (real.params["/robot/wait_for_nodes"].value, simulated.params["/robot/wait_for_nodes"].value) == ("", True)
    assert "driver" in {node.name for node in real.nodes}
    assert len(config_of("robot.launch", "program:=none").nodes) == len(real.nodes) - 1


def programs_of(*arguments):
    """Node name → program that sim.launch starts."""
    return {node.name: node.type for node in config_of("sim.launch", *arguments).nodes}


@pytest.mark.parametrize("launch", ["sim.launch", "robot.launch", "view.launch", "console.launch"])
def test_the_argument_ns_moves_every_node_and_parameter_and_changes_nothing_else(launch):
    here, moved_config = config_of(launch), config_of(launch, "ns:=robot2")
    assert [(node.namespace, node.name, node.type) for node in moved_config.nodes] == [
        ("/robot2/", node.name, node.type) for node in here.nodes
    ]
    moved = {"/robot2" + name if name != "/use_sim_time" else name for name in here.params}
    assert set(moved_config.params) == moved
    values = {name.removeprefix("/robot2"): param.value for name, param in moved_config.params.items()}
    assert values == {name: param.value for name, param in here.params.items()}


def test_arguments_reach_the_nodes_in_a_namespace_too():
    config = config_of("sim.launch", "ns:=robot2", "seed:=7", "telemetry:=true", "respawn:=true")
    assert config.params["/robot2/mujoco_plant/seed"].value == 7
    assert "telemetry" in {node.name for node in config.nodes}


def telemetry_of(launch, *arguments):
    """The parameters of the node; None if it is not started."""
    config = config_of(launch, *arguments)
    if "telemetry" not in {node.name for node in config.nodes}:
        return None
    own = "/telemetry/"
    return {name.removeprefix(own): param.value for name, param in config.params.items() if name.startswith(own)}


@pytest.mark.parametrize("launch", ["sim.launch", "robot.launch"])
def test_on_the_wall_clock_a_black_box_is_written_and_nothing_else(launch):
    values = telemetry_of(launch)
    assert values["record"] == "request"
    assert "black_box" not in values, "its size is that of the YAML file"
    assert telemetry_of(launch, "black_box:=false") is None
    assert telemetry_of(launch, "clock:=lockstep") is None


@pytest.mark.parametrize("launch", ["sim.launch", "robot.launch"])
def test_with_telemetry_the_yaml_file_says_what_is_written(launch):
    assert not telemetry_of(launch, "telemetry:=true").keys() & {"record", "black_box"}
    assert telemetry_of(launch, "telemetry:=true", "black_box:=false")["black_box"] == 0


def test_the_end_of_telemetry_ends_a_simulation_that_shall_be_logged_and_nothing_else():
    def required(launch, *arguments):
        return {node.name: node.required for node in config_of(launch, *arguments).nodes}["telemetry"]

    assert required("sim.launch", "telemetry:=true")
    assert not required("sim.launch")
    assert not required("robot.launch", "telemetry:=true")


def test_respawn_starts_again_all_but_what_ends_the_launch():
    nodes = config_of("sim.launch", "telemetry:=true", "respawn:=true").nodes
    assert {node.name for node in nodes if not node.respawn} == {"mujoco_plant", "telemetry"}
    assert {node.name for node in config_of("sim.launch").nodes if node.respawn} == {"robot_status"}


def test_the_transforms_inside_the_robot_can_be_left_to_another_node():
    assert "robot_state_publisher" in programs_of()
    assert "robot_state_publisher" not in programs_of("robot_state_publisher:=false")


def test_a_simulation_starts_the_programs_of_the_robot():
    started = programs_of()
    assert started["mujoco_plant"] == "mujoco_plant"
    nodes = {"controller" if name.endswith("_controller") else name for name in NODES}  # it becomes that of the kind
    assert {name: started[name] for name in nodes} == {name: name for name in nodes}


def test_every_argument_that_a_user_may_give_is_set_in_every_launch():
    """A parameter that is set under a condition stays in the roscore when the condition is false the next time."""
    for name in ("sim", "robot"):
        text = (LAUNCH / f"{name}.launch").read_text()
        outside = re.sub(r"<node .*?</node>", "", text, flags=re.DOTALL)
        assert not re.search(r"<param (if|unless)=", outside), name
        for node in re.findall(r"<node .*?</node>", text, flags=re.DOTALL):
            assert "<param if=" not in node or 'clear_params="true"' in node, node
