"""The programs of a robot contain no simulation, by their symbols and by the libraries they load."""

import re
import subprocess
from pathlib import Path

import pytest
import roslib.packages

SRC = Path(__file__).parents[2] / "src"
ROBOT = ("state_estimator", "diff_drive_controller", "safety_monitor", "telemetry")
NODE_FAULTS = {"NodeFaults", "distort"}


def simulated_names():
    """Classes of src/drivers/mujoco and src/simulation/faults, and the functions that distort frames."""
    headers = "\n".join(
        path.read_text() for folder in ("drivers/mujoco", "simulation/faults") for path in (SRC / folder).rglob("*.h")
    )
    return {"distort", *re.findall(r"^class (\w+)", headers, re.MULTILINE)}


def program(name):
    found = roslib.packages.find_node("robot_control", name)
    assert found, f"no program {name}"
    return found[0]


def simulated_symbols(name):
    """The names of `simulated_names` that occur in the symbols of the program."""
    listed = subprocess.run(["nm", "-C", program(name)], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"\w+", listed)) & simulated_names()


def libraries(name):
    return subprocess.run(["readelf", "-d", program(name)], check=True, capture_output=True, text=True).stdout


def built(name):
    return bool(roslib.packages.find_node("robot_control", name))


NODES = [path.stem for path in sorted((SRC / "main").glob("*.cpp")) if "run_node(" in path.read_text()]


@pytest.mark.parametrize("name", filter(built, NODES))
def test_every_node_checks_its_connections(name):
    """roscpp calls these functions by name, so that those of the program replace its own (src/ros/network)."""
    exported = subprocess.run(["nm", "-D", "--defined-only", program(name)], check=True, capture_output=True, text=True)
    for function in ("ros10Connection4read", "ros6Header5parse", "XmlRpc12XmlRpcSocket6nbRead", " T accept", " T bind"):
        assert function in exported.stdout, function


@pytest.mark.parametrize("name", ROBOT)
def test_a_program_of_the_robot_holds_nothing_simulated(name):
    assert simulated_symbols(name) == set()
    assert "libmujoco" not in libraries(name)


def test_no_program_holds_the_faults_of_nodes():
    assert simulated_names() >= NODE_FAULTS
    assert not simulated_symbols("mujoco_plant") & NODE_FAULTS


def test_the_simulator_holds_its_machine():
    assert simulated_symbols("mujoco_plant") >= {"MujocoPlant", "SensorFaults", "MotorFaults"}
    assert "libmujoco" in libraries("mujoco_plant")
