"""A simulated robot with a master of its own, whose motion is observed."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import tempfile
import time
from collections import deque
from collections.abc import Iterator
from pathlib import Path

import rospy
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from robot_control.installed_files import share_file

from bench.console.process import free_port, wait_for

LAUNCH = ("sim.launch", "telemetry:=true", "black_box:=false")


class Robot:
    """sim.launch with a log of every cycle."""

    def __init__(self, *, command_sources: bool = False) -> None:
        """`command_sources`: the shipped list says who may command."""
        self._folder = tempfile.TemporaryDirectory(prefix="console-bench-")
        port = free_port()
        os.environ |= {
            "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
            "ROS_IP": "127.0.0.1",
            "ROS_LOG_DIR": self._folder.name,
        }
        own = Path(self._folder.name, "own.yaml")
        sources = share_file("config/command_sources.yaml")
        listed = f"diff_drive_controller: {{command_sources: {sources}}}\n" if command_sources else ""
        own.write_text("telemetry: {record: always}\n" + listed)
        command = [
            "roslaunch",
            "-p",
            str(port),
            "robot_control",
            *LAUNCH,
            f"out:={self._folder.name}",
            f"params:={own}",
        ]
        with Path(self._folder.name, "output").open("w") as output:
            self._process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
        self.moves: deque[tuple[float, float, float]] = deque(maxlen=6000)  # s monotonic, m, m/s: true
        self._way, self._x, self._y = 0.0, 0.0, 0.0
        wait_for(
            "the master", lambda: subprocess.run(["rosnode", "list"], capture_output=True, check=False).returncode == 0
        )
        rospy.init_node("console_bench", anonymous=True, disable_signals=True)
        rospy.Subscriber("ground_truth/odom", Odometry, self._receive, tcp_nodelay=True)
        wait_for("the robot", lambda: len(self.moves) > 10)

    def _receive(self, message: Odometry) -> None:
        at, twist = message.pose.pose.position, message.twist.twist
        self._way += ((at.x - self._x) ** 2 + (at.y - self._y) ** 2) ** 0.5 if self.moves else 0.0
        self._x, self._y = at.x, at.y
        self.moves.append((time.monotonic(), self._way, twist.linear.x))

    @property
    def speed(self) -> float:
        """m/s"""
        return self.moves[-1][2]

    @contextlib.contextmanager
    def on_a_circle(self) -> Iterator[None]:
        """It drives a circle of a metre."""
        twist = Twist(linear=Vector3(0.3, 0, 0), angular=Vector3(0, 0, 0.3))
        requests = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        timer = rospy.Timer(rospy.Duration(0.05), lambda _: requests.publish(twist))
        try:
            wait_for("motion", lambda: self.speed > 0.2)
            yield
        finally:
            timer.shutdown()
            requests.unregister()

    def await_rest(self) -> None:
        """Waits until it stands for half a second."""
        wait_for("rest", lambda: all(abs(each[2]) < 0.01 for each in list(self.moves)[-25:]))

    def at(self, when: float) -> tuple[float, float]:
        """Way [m] and speed [m/s] at a time, s monotonic."""
        return min(((abs(t - when), way, speed) for t, way, speed in list(self.moves)), default=(0.0, 0.0, 0.0))[1:]

    def end(self) -> Path:
        """Ends it; the log, until `remove`."""
        self._process.send_signal(signal.SIGINT)
        self._process.wait(60)
        return next(Path(self._folder.name).rglob("run.bag"))

    def remove(self) -> None:
        """Removes the log."""
        self._folder.cleanup()
