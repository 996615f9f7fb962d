"""A tool that drives a running robot first needs its parameters, the other senders, and whether all nodes run."""

import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import rosgraph
import rospy

from robot_control.installed_files import share_file
from robot_control.robot.robot_kind import refuse_running_legs, running_kind
from robot_control.robot.ros_master import Master, senders_of
from robot_control.robot.ros_node import begin_node
from robot_control.robot.server_values import server_description, server_text, server_tree
from robot_control.robot.topic_sender import Signals
from robot_control.settings.block import Settings
from robot_control.settings.parameter_layers import DEFAULTS, leaves

TIMEOUT = 5.0
"""s to receive a report of every node; each reports once per second"""

State = Sequence[Sequence[tuple[str, Sequence[str]]]]


class RefusedError(RuntimeError):
    """The drive cannot begin, or had to end; the message names the reason."""


@contextmanager
def running_settings(tool: str, node: str, without_master: str, in_simulated_time: str) -> Iterator[Settings]:
    """Becomes the ROS node `tool` and yields the parameters of the running `node` as it reads them: file, server,
    robot_description. `without_master` and `in_simulated_time` name the alternative if there is no master, or no wall
    clock.

    Raises:
        RefusedError: there is no robot that could be driven.
        WheelsOnlyError: it stands on legs.
        ServerValueError: the server holds one of them in another type.
    """
    if not rosgraph.is_master_online():
        what = f"no ROS master at {rosgraph.get_master_uri()}"
        raise RefusedError(f"{what}: start the robot (roslaunch robot_control sim.launch), {without_master}")
    begin_node(tool, anonymous=True)
    refuse_running_legs(f"{tool}.py")
    if rospy.get_param("/use_sim_time", default=False):
        raise RefusedError(
            "the robot runs in simulated time, where a wall-clock second is many: use clock wall, " + in_simulated_time
        )
    path = server_text(f"{node}/config", "the path of a YAML file") or share_file(DEFAULTS)
    own = {key: value for key, value in server_tree(node).items() if key not in ("config", "urdf")}
    values = [*leaves({"robot": server_tree("robot")}), *leaves({node: own})]
    described = server_description()
    with tempfile.TemporaryDirectory(prefix=f"{tool}-") as folder:
        if described and "robot.urdf" not in dict(values):
            (Path(folder) / "robot.urdf").write_text(described)
            values.append(("robot.urdf", str(Path(folder) / "robot.urdf")))
        yield Settings(path, tuple(values))


def await_all(condition: Callable[[], bool], signals: Signals) -> None:
    """Waits until the condition holds, at most TIMEOUT."""
    end = time.monotonic() + TIMEOUT
    while not condition() and time.monotonic() < end and signals.going_on():
        time.sleep(0.02)


def master_state() -> State:
    """The master's lists of publishers, subscribers and services.

    Raises:
        RefusedError: it does not answer.
    """
    state: State | None = Master(rospy.get_name()).state()
    if state is None:
        raise RefusedError("the ROS master does not answer. The robot was not driven")
    return state


def other_senders(state: State) -> tuple[str, ...]:
    """Other nodes that may send commands."""
    return senders_of(state[0], map(rospy.resolve_name, running_kind().request_topics), rospy.get_name())
