"""Costs of slam, localization and navigate beside the loop, on the wall clock.

One loop runs in each block. In it the nodes are stopped (SIGSTOP) and continued every few seconds: the load of the
machine is then the same with and without them. On a busy machine two loops one after the other differ by 1.5 ×.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import statistics
import subprocess
import tempfile
import time
import xmlrpc.client
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import rosgraph
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from robot_control._navigation import write_map

from bench.console.process import cost_of, free_port, wait_for
from bench.navigation.goals import scene_of
from bench.realtime.chain import CHAIN
from bench.realtime.loops import FREE_WHEELS, Loop
from bench.rows import Row, Say, bounded

BLOCKS, WINDOWS = 5, 5
"""loops; windows of each with the nodes, and as many without them"""
SECONDS, SETTLING = 1.6, 0.4
"""s of a window; s before it, in which the nodes take what came meanwhile"""
GOALS = ((2.0, 0.0), (0.3, 0.0))
"""m; the robot drives between them"""
BOUNDS = {"slam": 15.0, "localization": 10.0, "navigate": 10.0}
"""% of a core"""
GROWTH = 2.0
"""MB from the first block to the last one, of the least in each: a plan takes some MB and gives them back"""
SEEN = 10
"""goals before the first block, until the map is whole"""


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
        used, size = cost_of(self.pids[name])
        return used, size / 1e6

    def end(self) -> None:
        """Ends all of it."""
        self.stop(signal.SIGCONT)
        self._process.terminate()
        self._process.wait()


def rows_of(blocks: int, programs: Path, say: Say) -> list[Row]:
    """`blocks`: those of each of the two set-ups; 150 take an hour."""
    rows: list[Row] = []
    ratios: list[float] = []
    for with_map in (False, True):
        say(f"cost: {'localization' if with_map else 'slam'} and navigate, {blocks} blocks")
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as own:  # rospy has one master in a process
            found, of_one = own.submit(_of_one, with_map, blocks, programs).result()
        rows += found
        ratios += of_one
    return [*rows, bounded("chain, p99, to that without the nodes", statistics.median(ratios), "median", 1.1)]


def _of_one(with_map: bool, blocks: int, programs: Path) -> tuple[list[Row], list[float]]:  # noqa: FBT001
    with tempfile.TemporaryDirectory(prefix="navigation-bench-") as folder:
        system = System(Path(folder), with_map=with_map)
        try:
            rospy.init_node("navigation_bench", anonymous=True, disable_signals=True)
            goals = _Goals()
            shares: dict[str, list[float]] = {name: [] for name in system.names}
            memory: dict[str, list[float]] = {name: [] for name in system.names}
            for _ in range(SEEN):
                goals.drive()
                time.sleep(SETTLING + SECONDS)
            began = time.monotonic()
            ratios = [_block(system, goals, shares, memory, programs) for _ in range(blocks)]
            lasted = time.monotonic() - began
            grown = {name: min(used[-WINDOWS:]) - min(used[:WINDOWS]) for name, used in memory.items()}
        finally:
            system.end()
    rows = [
        bounded(f"{name}, beside {system.names[0]}", statistics.median(shares[name]), "% of a core", BOUNDS[name])
        for name in system.names
    ]
    rows += [bounded(f"{name}: growth in {lasted:.0f} s", grown[name], "MB", GROWTH) for name in system.names]
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


def _block(
    system: System, goals: _Goals, shares: dict[str, list[float]], memory: dict[str, list[float]], programs: Path
) -> float:
    """The p99 of the chain with the nodes to that without them; adds their shares of a core and their MB."""
    loop = Loop(programs, f"navigation-{os.getpid()}", driver=FREE_WHEELS)
    windows: dict[signal.Signals, list[tuple[int, int]]] = {signal.SIGCONT: [], signal.SIGSTOP: []}
    try:
        loop.await_start()
        for _ in range(WINDOWS):
            for kind, spans in windows.items():
                system.stop(kind)
                if kind is signal.SIGCONT:
                    goals.drive()
                time.sleep(SETTLING)
                before, begin = {name: system.used(name)[0] for name in shares}, time.monotonic_ns()
                time.sleep(SECONDS)
                spans.append((begin, time.monotonic_ns()))
                if kind is signal.SIGCONT:
                    for name, seconds in before.items():
                        used, megabytes = system.used(name)
                        shares[name].append(100 * (used - seconds) / SECONDS)
                        memory[name].append(megabytes)
        rows = loop.end()
    finally:
        system.stop(signal.SIGCONT)
        loop.close()
    begin_of, end_of = CHAIN
    times, stamps = rows[end_of] - rows[begin_of], rows["stamp_ns"]
    worst = [
        np.nanpercentile(times[np.logical_or.reduce([(stamps > a) & (stamps < b) for a, b in spans])], 99)
        for spans in windows.values()
    ]
    return float(worst[0] / worst[1])
