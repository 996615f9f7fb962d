"""A simulated robot, its programs of the fleet behind a broker and a cable that can be cut, and a master."""

from __future__ import annotations

import contextlib
import math
import signal
import subprocess
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import rospy
import yaml  # type: ignore[import-untyped]
from nav_msgs.msg import Odometry
from robot_control.fleet.master import Master
from robot_control.robot.pose import Pose, pose_of

from bench.console.process import cost_of, program
from bench.console.proxy import Proxy
from bench.console.robot import Robot
from bench.fleet.broker import Broker
from bench.fleet.messages import order

KEEP_ALIVE = 6
"""s"""
AGAIN = 2.0
"""s until an order is sent again"""
LIMIT = 60.0
"""s; what takes longer does not happen"""
TOPIC = "uagv/v2/robot_control/r1"


class System:
    """All of it."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="fleet-bench-")
        self.robot = Robot(command_sources=True)
        self.broker = Broker(Path(self._folder.name))
        self.cable = Proxy()
        self.cable.target = self.broker.port
        self._config = Path(self._folder.name, "fleet.yaml")
        memory = f"{self._folder.name}/memory.json"
        self._config.write_text(
            yaml.safe_dump({"port": self.cable.port, "keep_alive": KEEP_ALIVE, "memory_file": memory})
        )
        self._poses: deque[tuple[float, Pose, float]] = deque(maxlen=10_000)
        self._lock = threading.Lock()
        rospy.Subscriber("odom", Odometry, self._receive, tcp_nodelay=True)
        self._programs: dict[str, subprocess.Popen[bytes]] = {}
        for name in ("follow_path.py", "vda5050.py"):
            self.begin(name)
        self.master = Master("127.0.0.1", self.broker.port, TOPIC)
        self.origin = Pose(0.0, 0.0, 0.0)
        self.count = int(time.time())

    def _receive(self, message: Odometry) -> None:
        with self._lock:
            self._poses.append((time.monotonic(), pose_of(message), message.twist.twist.linear.x))

    def poses(self, since: float) -> list[tuple[float, Pose, float]]:
        """s monotonic, in odom, m/s."""
        with self._lock:
            return [each for each in self._poses if each[0] > since]

    def begin(self, name: str) -> None:
        """Starts a program."""
        options = ["--config", str(self._config)] if name == "vda5050.py" else []
        with Path(self._folder.name, f"{name}.log").open("a") as output:
            self._programs[name] = subprocess.Popen([program(name), *options], stdout=output, stderr=output)

    def kill(self, name: str) -> None:
        """SIGKILL."""
        self._programs[name].kill()
        self._programs[name].wait()

    def repair(self) -> None:
        """Ends every loss."""
        if self.cable.stalled:
            self.cable.cut()
            self.cable.stalled = False
        self.broker.stall(go_on=True)
        if not self.broker.running:
            self.broker.start()
        if self._programs["vda5050.py"].poll() is not None:
            self.begin("vda5050.py")
        for name in self._programs:
            self.pause(name, go_on=True)

    def pause(self, name: str, *, go_on: bool = False) -> None:
        """SIGSTOP or SIGCONT."""
        self._programs[name].send_signal(signal.SIGCONT if go_on else signal.SIGSTOP)

    def cost(self, name: str) -> tuple[float, int]:
        """s of processor time, and bytes."""
        return cost_of(self._programs[name].pid)

    @property
    def state(self) -> dict[str, Any]:
        """The last one."""
        return self.master.last.get("state", {})

    @property
    def connection(self) -> str:
        """The last one."""
        return str(self.master.last.get("connection", {}).get("connectionState", ""))

    @property
    def here(self) -> tuple[float, float, float]:
        """x, y, yaw on the map, by odometry since `place`."""
        pose = self._poses[-1][1]
        return (*pose.seen_from(self.origin), math.remainder(pose.yaw - self.origin.yaw, math.tau))

    def listen(self, what: str, condition: Callable[[], object], limit: float = LIMIT) -> None:
        """Takes messages until the condition holds; AssertionError names `what`."""
        end = time.monotonic() + limit
        while not condition():
            if time.monotonic() > end:
                log = [Path(self._folder.name, f"{name}.log").read_text()[-500:] for name in self._programs]
                raise AssertionError(f"not within {limit:g} s: {what}; {self.connection} {self.state} {log}")
            for _ in self.master.messages(0.02):
                pass

    def act(self, kind: str, **parameters: object) -> None:
        """An instant action until it has ended; a stopPause is repeated until it is taken."""
        action = self.master.act(kind, **parameters)
        end = time.monotonic() + LIMIT
        while self.status(action) not in ("FINISHED", "FAILED"):
            with contextlib.suppress(AssertionError):
                self.listen(kind, lambda: self.status(action) in ("FINISHED", "FAILED"), AGAIN)
                break
            if time.monotonic() > end:
                raise AssertionError(f"{kind} did not end: {self.state}")
            self.master.act(kind, action, **parameters)
        if self.status(action) == "FAILED" and kind == "stopPause":
            self.act(kind)

    def status(self, action_id: str) -> str:
        """actionStatus; empty if it is not known."""
        known = {each["actionId"]: each["actionStatus"] for each in self.state.get("actionStates", [])}
        return str(known.get(action_id, ""))

    def place(self) -> None:
        """No order, no pause, and the robot is at the origin of the map."""
        self.listen("ONLINE", lambda: self.connection == "ONLINE" and self.state)
        self.act("cancelOrder")
        self.act("stopPause")
        self.robot.await_rest()
        self.act("initPosition", x=0.0, y=0.0, theta=0.0, mapId="hall")
        placed = time.monotonic()
        self.listen("odometry", lambda: self.poses(placed))
        self.origin = self._poses[-1][1]

    def send(self, places: Sequence[tuple[float, ...]], released: int | None = None, **options: Any) -> float:
        """Sends an order, or an update, until the robot has it; s, monotonic, of the first time. One that is sent
        without a connection is lost, and one that comes twice is ignored.
        """
        if not options.get("update"):
            self.count += 1
        message = order(places, released, name=f"o{self.count}", **options)
        content = {key: message[key] for key in ("orderId", "orderUpdateId", "nodes", "edges")}
        sent = time.monotonic()
        while True:
            self.master.send("order", content)
            with contextlib.suppress(AssertionError):
                self.listen("the order", lambda: self._has(content), AGAIN)
                return sent
            if time.monotonic() - sent > LIMIT:
                raise AssertionError(f"order {message['orderId']} was not taken: {self.state}")

    def _has(self, content: dict[str, Any]) -> bool:
        return all(self.state.get(key) == content[key] for key in ("orderId", "orderUpdateId"))

    def await_end(self) -> None:
        """Until the order of the last `send` is completed and the robot stands."""
        name = f"o{self.count}"
        self.listen("the end", lambda: self.state["orderId"] == name and not self.state["nodeStates"])
        self.robot.await_rest()

    def end(self) -> None:
        """Ends all."""
        self.master.end()
        for process in self._programs.values():
            process.send_signal(signal.SIGCONT)
            process.send_signal(signal.SIGINT)
            process.wait(20)
        self.cable.end()
        self.broker.end()
        self.robot.end()
        self.robot.remove()
        self._folder.cleanup()
