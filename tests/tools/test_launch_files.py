"""Where sim.launch and backend.launch let their nodes listen, by the environment of whoever starts them."""

import re
from pathlib import Path

import pytest
from roslaunch.substitution_args import resolve_args

LAUNCH = Path(__file__).parents[2] / "launch"
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
