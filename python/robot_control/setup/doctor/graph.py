"""Checks of the ROS graph, by the master's own interface; it needs no rospy."""

import functools
import shlex
import socket
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robot_control.robot.timed_proxy import NO_ANSWER, timed_proxy
from robot_control.setup.doctor.finding import Check, Finding, fault, note, ok, unseen, warning
from robot_control.setup.doctor.programs import NODES, SET_AT_LAUNCH
from robot_control.setup.doctor.remote_master import address, remote_host
from robot_control.setup.doctor.system import System

TIMEOUT = 0.5
"""s for an answer of the master or of a node"""
BLOCKS = ("robot", *sorted(NODES))
"""Parameters of the nodes, which outlive them in the master"""
THREADS = 16
"""Nodes that are asked at a time"""


@dataclass(frozen=True)
class Graph:
    """The nodes, topics and parameters that the master lists."""

    published: dict[str, list[str]]
    """Topic → nodes"""
    nodes: dict[str, str]
    """Node → address"""
    parameters: dict[str, Any]


def _call(address_: str, method: str, *arguments: object) -> Any:  # noqa: ANN401 (of the method)
    """The third part of an answer; None if there is none."""
    try:
        code, _, value = getattr(timed_proxy(address_, TIMEOUT), method)(*arguments)
    except (*NO_ANSWER, TypeError):
        return None
    return value if code == 1 else None


@functools.cache
def graph(system: System) -> Graph | None:
    """The graph of ROS_MASTER_URI; None without an answer. A recorded machine has none unless it names a master."""
    found = address(system)
    if found is None or (not system.live and "ROS_MASTER_URI" not in system.environment):
        return None
    master = f"http://{found[0]}:{found[1]}"
    state: Sequence[Any] | None = _call(master, "getSystemState", "/doctor")
    try:
        published = {str(topic): [str(node) for node in nodes] for topic, nodes in (state or [])[0]}
        names = {str(name) for part in state or [] for _, nodes in part for name in nodes}
    except (IndexError, TypeError, ValueError):  # no answer, or not that of a master
        return None
    with ThreadPoolExecutor(max_workers=THREADS) as pool:
        addresses = pool.map(lambda name: _call(master, "lookupNode", "/doctor", name), sorted(names))
        nodes = dict(zip(sorted(names), addresses, strict=True))
    tree = _call(master, "getParam", "/doctor", "/")
    return Graph(
        published, {name: str(uri or "") for name, uri in nodes.items()}, tree if isinstance(tree, dict) else {}
    )


def _of_graph(examine: Callable[[Graph], Finding]) -> Callable[[System], Finding]:
    """A check that claims nothing without a master."""

    def of_system(system: System) -> Finding:
        known = graph(system)
        return unseen("no answer of a master") if known is None else examine(known)

    return of_system


def master(system: System) -> Finding:
    """The answer of the master; a machine on which no robot was started has none."""
    found, known = address(system), graph(system)
    if known is not None:
        return ok(f"answers, {len(known.nodes)} nodes")
    if found is None or (not system.live and "ROS_MASTER_URI" not in system.environment):
        return unseen("no ROS_MASTER_URI that could be asked")
    value = f"no answer of http://{found[0]}:{found[1]}"
    try:
        with socket.create_connection(found, timeout=TIMEOUT):
            listening = True
    except OSError:
        listening = False
    if listening:
        remedy = "end what listens there: ss -tlnp, or restart roscore"
        return fault(f"{value}, although something listens there", remedy)
    if remote_host(system):
        return fault(value, f"start roscore on {found[0]}, or correct ROS_MASTER_URI; a firewall may block it")
    return note(value, "start the robot, which also starts a master", "roslaunch robot_control sim.launch")


def _answers(node: str, uri: str) -> bool:
    return bool(uri) and _call(uri, "getPid", node) is not None


def dead_nodes(known: Graph) -> Finding:
    """Nodes that the master still lists and that do not answer, with what they publish."""
    with ThreadPoolExecutor(max_workers=THREADS) as pool:
        alive = dict(zip(known.nodes, pool.map(_answers, known.nodes, known.nodes.values()), strict=True))
    dead = sorted(name for name, answers in alive.items() if not answers)
    if not dead:
        return ok("every node answers")
    topics = sorted(topic for topic, by in known.published.items() if set(by) & set(dead))
    value = f"{', '.join(dead[:4])}" + (f", publisher of {', '.join(topics[:3])}" if topics else "")
    return warning(value, "remove them from the master", "rosnode cleanup")


def simulated_time(known: Graph) -> Finding:
    """A /use_sim_time left over from a lockstep launch stops every clock of ROS."""
    simulated = known.parameters.get("use_sim_time", False)
    lockstep = _block(known, "robot").get("clock") == "lockstep"
    if simulated and not known.published.get("/clock"):
        value = "/use_sim_time is true, and no node publishes /clock: the simulated time is stopped"
        remedy = "remove it, unless a simulation in lockstep is about to start"
        return fault(value, remedy, "rosparam set /use_sim_time false", "rosparam delete /robot/clock")
    if lockstep and not simulated:
        return fault("/robot/clock is lockstep without /use_sim_time", "remove it", "rosparam delete /robot/clock")
    return ok("simulated" if simulated else "wall clock")


def _block(known: Graph, name: str) -> dict[str, Any]:
    value = known.parameters.get(name)
    return value if isinstance(value, dict) else {}


def left_over(known: Graph) -> Finding:
    """Parameters of a robot that no longer runs; the next start reads them."""
    if {name.rsplit("/", 1)[-1] for name in known.nodes} & NODES:
        return ok("the robot runs; its nodes log the overrides in force")
    left = [
        f"/{name}/{key}"
        for name in BLOCKS
        for key in _block(known, name)
        if not any(f"{each}/".startswith((f"{key}/", f"{name}/{key}/")) for each in SET_AT_LAUNCH)
    ]
    if not left:
        return ok("none")
    shown = ", ".join(left[:4]) + (f" and {len(left) - 4} more" if len(left) > 4 else "")
    remedy = "remove what you did not set for the next start"
    return warning(shown, remedy, *(f"rosparam delete {shlex.quote(name)}" for name in left))


def senders(known: Graph) -> Finding:
    """More than one publisher of cmd_vel, of any robot."""
    many = {topic: by for topic, by in known.published.items() if topic.endswith("/cmd_vel") and len(set(by)) > 1}
    if not many:
        return ok("at most one per robot")
    topic, by = next(iter(many.items()))
    return warning(f"{topic}: {', '.join(sorted(by))}", "end all but one, or give them priorities (docs/driving.md)")


def _robots(system: System) -> Counter[tuple[str, str, str]]:
    """Program, namespace and master of each process of a node; own processes alone show their environment."""
    found: Counter[tuple[str, str, str]] = Counter()
    for number, arguments in system.processes():
        name = Path(arguments[0]).name
        if name not in NODES:
            continue
        lines = (system.text(f"proc/{number}/environ") or "").split("\0")
        values = dict(line.split("=", 1) for line in lines if "=" in line)
        if not values:
            continue
        space = values.get("ROS_NAMESPACE", "")
        for argument in arguments:
            space = argument.removeprefix("__ns:=") if argument.startswith("__ns:=") else space
        found[name, space.strip("/"), values.get("ROS_MASTER_URI", "http://localhost:11311").rstrip("/")] += 1
    return found


def duplicates(system: System) -> Finding:
    """Two processes of one node at one master and namespace; the second one waits or refuses."""
    robots = _robots(system)
    twice = [f"{name} of /{space} at {uri}" for (name, space, uri), count in robots.items() if count > 1]
    if twice:
        return warning(f"twice: {', '.join(sorted(twice))}", "end one of them, or give it a namespace: __ns:=robot2")
    return ok(f"{len(robots)} nodes, each once" if robots else "no node of a robot runs here")


def other_master(system: System) -> Finding:
    """Nodes of a robot on this machine that registered with another master than that of this terminal."""
    found = address(system)
    masters = sorted({uri for _, _, uri in _robots(system)})
    if found is None or not masters:
        return ok("no node of a robot runs here")
    ports = {uri.rsplit(":", 1)[-1] for uri in masters}
    if str(found[1]) not in ports:
        value = f"the robot runs at {', '.join(masters)}, this terminal uses port {found[1]}"
        command = f"export ROS_MASTER_URI={shlex.quote(masters[0])}"
        return warning(value, "use the robot's master in this terminal", command)
    return ok(", ".join(masters))


CHECKS = (
    Check("master", "without it nodes do not find each other", master),
    Check("dead_nodes", "a subscriber waits for a publisher that is gone", _of_graph(dead_nodes)),
    Check("simulated_time", "with simulated time and no clock nothing moves", _of_graph(simulated_time)),
    Check(
        "left_over_parameters", "parameters on the master outlive the nodes and override the file", _of_graph(left_over)
    ),
    Check("command_senders", "two senders make the robot jerk between two motions", _of_graph(senders)),
    Check("duplicate_nodes", "a channel has one writer, so the second node does not start", duplicates),
    Check("other_master", "programs of this terminal do not reach the robot", other_master),
)
