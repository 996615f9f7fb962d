"""Costs of slam, localization and navigate beside the loop, on the wall clock."""

from __future__ import annotations

import multiprocessing
import os
import signal
import statistics
import subprocess
import tempfile
import time
import xmlrpc.client
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import rosgraph
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from robot_control._navigation import write_map

from bench.console.process import free_port, wait_for
from bench.navigation.goals import scene_of
from bench.realtime.chain import CHAIN
from bench.realtime.loops import FREE_WHEELS, loop_for
from bench.rows import bounded

Say = Callable[[str], None]
BLOCKS, SECONDS = 5, 10.0
"""pairs of a block with and one without the nodes, which are stopped by SIGSTOP in between; s of each"""
GOALS = ((2.0, 0.0), (0.3, 0.0))
"""m; the robot drives between them"""
BOUNDS = {"slam": 15.0, "localization": 10.0, "navigate": 10.0}
"""% of a core"""
GROWTH = 2.0
"""MB"""


class System:
    """navigation.launch in `room`; with a map localization runs, else slam."""

    def __init__(self, folder: Path, *, with_map: bool) -> None:
        port = free_port()
        os.environ |= {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_LOG_DIR": str(folder)}
        command = ["roslaunch", "-p", str(port), "robot_control", "navigation.launch", "scene:=room"]
        if with_map:
            write_map(str(folder / "room.yaml"), scene_of("room")[1])
            command.append(f"map:={folder}/room.yaml")
        with (folder / "output").open("w") as output:
            self._process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT)
        self.names = ("localization" if with_map else "slam", "navigate")
        wait_for("the nodes", lambda: all(map(self._pid, self.names)))
        self.pids = {name: self._pid(name) for name in self.names}

    @staticmethod
    def _pid(name: str) -> int:
        try:
            uri = rosgraph.Master("/bench").lookupNode(f"/{name}")
            answer: Any = xmlrpc.client.ServerProxy(uri).getPid("/bench")
            return int(answer[2])
        except (OSError, rosgraph.MasterException):
            return 0

    def stop(self, kind: signal.Signals) -> None:
        """SIGSTOP or SIGCONT to the nodes."""
        for pid in self.pids.values():
            os.kill(pid, kind)

    def used(self, name: str) -> tuple[float, float]:
        """s of processor time, and MB."""
        fields = Path(f"/proc/{self.pids[name]}/stat").read_text().rpartition(")")[2].split()
        pages = int(Path(f"/proc/{self.pids[name]}/statm").read_text().split()[1])
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), pages * os.sysconf("SC_PAGE_SIZE") / 1e6

    def end(self) -> None:
        """Ends all of it."""
        self.stop(signal.SIGCONT)
        self._process.terminate()
        self._process.wait()


def rows_of(blocks: int, programs: Path, say: Say) -> list[dict[str, Any]]:
    """`blocks`: pairs of blocks of each of the two set-ups; 180 take an hour."""
    rows: list[dict[str, Any]] = []
    ratios: list[float] = []
    for with_map in (False, True):
        say(f"cost: {'localization' if with_map else 'slam'} and navigate, {blocks} blocks")
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as own:  # rospy has one master in a process
            found, of_one = own.submit(_of_one, with_map, blocks, programs).result()
        rows += found
        ratios += of_one
    return [*rows, bounded("chain, p99, to that without the nodes", statistics.median(ratios), "median", 1.1)]


def _of_one(with_map: bool, blocks: int, programs: Path) -> tuple[list[dict[str, Any]], list[float]]:  # noqa: FBT001
    ratios: list[float] = []
    with tempfile.TemporaryDirectory(prefix="navigation-bench-") as folder:
        system = System(Path(folder), with_map=with_map)
        try:
            rospy.init_node("navigation_bench", anonymous=True, disable_signals=True)
            goals = _Goals()
            shares: dict[str, list[float]] = {name: [] for name in system.names}
            goals.drive()
            first = {name: system.used(name)[1] for name in system.names}
            for _ in range(blocks):
                goals.drive()
                before, began = {name: system.used(name)[0] for name in system.names}, time.monotonic()
                with_nodes = _worst_percent(programs)
                for name, seconds in before.items():
                    shares[name].append(100 * (system.used(name)[0] - seconds) / (time.monotonic() - began))
                system.stop(signal.SIGSTOP)
                ratios.append(with_nodes / _worst_percent(programs))
                system.stop(signal.SIGCONT)
            grown = {name: system.used(name)[1] - first[name] for name in system.names}
        finally:
            system.end()
    rows = [
        bounded(f"{name}, beside {system.names[0]}", statistics.median(shares[name]), "% of a core", BOUNDS[name])
        for name in system.names
    ]
    rows += [
        bounded(f"{name}: growth in {2 * blocks * SECONDS:.0f} s", grown[name], "MB", GROWTH) for name in system.names
    ]
    return rows, ratios


class _Goals:
    """The robot's goals, which alternate."""

    def __init__(self) -> None:
        self._publisher = rospy.Publisher("move_base_simple/goal", PoseStamped, queue_size=1)
        rospy.wait_for_message("map", OccupancyGrid, 30)
        wait_for("navigate", lambda: self._publisher.get_num_connections() > 0)
        self._count = 0

    def drive(self) -> None:
        """Sends the next one."""
        goal = PoseStamped()
        goal.header.frame_id, goal.header.stamp = "map", rospy.Time.now()
        goal.pose.position.x, goal.pose.position.y = GOALS[self._count % 2]
        goal.pose.orientation.w = 1.0
        self._count += 1
        self._publisher.publish(goal)


def _worst_percent(programs: Path) -> float:
    rows = loop_for(SECONDS, programs, FREE_WHEELS)
    begin, end = CHAIN
    return float(np.nanpercentile(rows[end] - rows[begin], 99)) / 1000
