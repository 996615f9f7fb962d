"""A user's terminal: runs the commands of the documentation in order, and ends those that do not end by themselves.

A private ROS master on the loopback. Programs are ended by process id only.
"""

import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client
from contextlib import suppress
from pathlib import Path

LIMIT = 60.0
"""s, of a command that ends by itself; measured below 8 on an idle machine."""
START = 30.0
"""s, until a server is ready; measured below 4."""
WATCH = 2.0
"""s, for which an observer is watched."""

NODES = {"mujoco_plant", "state_estimator", "diff_drive_controller", "safety_monitor"}
COMPANIONS = {"send_cmd.py", "follow_path.py", "console.py", "device_simulator"}
"""They run beside a launch until the page ends."""
CONTROLLERS = {"/diff_drive_controller/set_parameter_map", "/set_posture"}
"""services of the controller, by kind of the robot"""


class FailedError(AssertionError):
    """A command of the documentation did not do what a reader expects; the message holds its output."""


class Program:
    """A program in a process group of its own, its output in a file, which no child that outlives it can block."""

    def __init__(self, command, folder, environment, arguments=None):
        """`arguments`: what is executed; left out: the command, by a shell that it replaces."""
        self.command = command
        self.output = folder / f"output_{time.monotonic_ns()}"
        with self.output.open("wb") as file:
            self.process = subprocess.Popen(
                ["env", "--default-signal=INT", *(arguments or ["bash", "-c", f"exec {command}"])],
                cwd=folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    @property
    def running(self):
        return self.process.poll() is None

    def text(self):
        return self.output.read_text(errors="replace")

    def end(self):
        """Sends SIGINT to the program; its group is killed if it still runs after 15 s."""
        if self.running:
            self.process.send_signal(signal.SIGINT)
            with suppress(subprocess.TimeoutExpired):
                self.process.wait(15)
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()


def until(condition, what, program=None, limit=START):
    deadline = time.monotonic() + limit
    while not condition():
        if program is not None and not program.running:
            raise FailedError(f"{program.command}: ended while starting\n{program.text()}")
        if time.monotonic() > deadline:
            raise FailedError(f"{what}: not within {limit:.0f} s\n{program.text() if program else ''}")
        time.sleep(0.05)


def never_ends(command):
    """The kind of a command that does not end by itself: a launch, a node, a companion or an observer; else ""."""
    words = shlex.split(command)
    if words[0] == "roslaunch":
        if "fleet.launch" in words:
            return "companion"
        return "" if any(word.startswith("cycles:=") for word in words) else "launch"
    if words[:2] == ["rosrun", "robot_control"]:
        if words[2] in NODES:
            return "node"
        if words[2] in COMPANIONS:
            return "companion"
        return "observer" if words[2] == "why.py" and "--once" not in words else ""
    endless = words[0] == "rostopic" and words[1] in ("echo", "hz", "pub") and not {"-1", "-n"} & set(words)
    return "observer" if endless else ""


class Terminal:
    """`folder`: working folder of the commands, which holds what they write."""

    def __init__(self, folder: Path):
        self.folder = folder
        port = free_port()
        uri = f"http://127.0.0.1:{port}"
        self.environment = dict(os.environ, ROS_MASTER_URI=uri, ROS_IP="127.0.0.1", PWD=str(folder))
        self.environment |= {"ROS_HOME": str(folder / ".ros"), "MPLBACKEND": "Agg"}
        for name in ("ROS_HOSTNAME", "ROS_NAMESPACE"):
            self.environment.pop(name, None)
        self.master = xmlrpc.client.ServerProxy(uri)
        self.core = Program(f"roscore -p {port}", folder, self.environment)
        self.launch = None
        self.others = []
        until(self._master_answers, "roscore", self.core)

    def _master_answers(self):
        with suppress(OSError, xmlrpc.client.Error):
            return self.master.getPid("/terminal")[0] == 1
        return False

    def registered(self):
        """Names of nodes and services."""
        _, _, (publishers, subscribers, services) = self.master.getSystemState("/terminal")
        nodes = {node for kind in (publishers, subscribers, services) for _, who in kind for node in who}
        return nodes | {name for name, _ in services}

    def run(self, command, *, refused=False):
        kind = never_ends(command)
        if refused:
            self._expect_refusal(command)
        elif kind == "launch":
            self._start_launch(command)
        elif kind in ("node", "companion"):
            self._start(command, kind)
        elif kind == "observer":
            self._observe(command)
        else:
            self._run_to_its_end(command)

    def _start_launch(self, command):
        """A launch that already runs with the same arguments goes on."""
        if self.launch is not None and self.launch.running and self.launch.command == command:
            return
        self.end_programs()
        self.launch = Program(command, self.folder, self.environment)
        needed = {"/e_stop_reset", "/set_odometry"}
        if "robot.launch" not in command:
            needed.add("/mujoco_plant/inject_fault")
        if "telemetry:=true" in command:
            needed.add("/telemetry/record")
        until(lambda: self.registered() >= needed and self.registered() & CONTROLLERS, command, self.launch)

    def _start(self, command, kind):
        if kind == "node" and self.launch is not None:
            self.end_programs()
        program = Program(command, self.folder, self.environment)
        self.others.append(program)
        name = "/" + shlex.split(command)[2].removesuffix(".py").replace("fleet.launch", "vda5050")
        until(lambda: any(node.startswith(name) for node in self.registered()), command, program)

    def _observe(self, command):
        program = Program(command, self.folder, self.environment)
        try:
            time.sleep(WATCH)
            if not program.running or "Traceback" in program.text():
                raise FailedError(f"{command}: ended\n{program.text()}")
        finally:
            program.end()

    def _run_to_its_end(self, command):
        if "cycles:=" in command:
            self.end_programs()
        self.judge(command, ["bash", "-ec", command])

    def _expect_refusal(self, command):
        program, output = self._ended(command, ["bash", "-ec", command])
        if program.process.returncode <= 0 or "refused" not in output or "Traceback" in output:
            raise FailedError(f"{command}\nnot refused, exit code {program.process.returncode}\n{output}")

    def run_python(self, text):
        self.judge(text, [sys.executable, "-c", text])

    def judge(self, what, arguments):
        """The command must end by itself within LIMIT, with exit code 0 and without an error message."""
        program, output = self._ended(what, arguments)
        code = program.process.returncode
        if code != 0 or re.search(r"Traceback|^usage: |ERROR: ", without_cut_thread(output), re.MULTILINE):
            raise FailedError(f"{what}\nexit code {code}\n{output}")

    def _ended(self, what, arguments):
        """The program after its end, and its output."""
        program = Program(what, self.folder, self.environment, arguments)
        with suppress(subprocess.TimeoutExpired):
            program.process.wait(LIMIT)
        late = program.running
        program.end()
        if late:
            raise FailedError(f"{what}\nnot ended after {LIMIT:.0f} s\n{program.text()}")
        return program, program.text()

    def end_programs(self):
        """The launch first: a robot whose drives end before it keeps that stop for its next start."""
        for program in [self.launch, *reversed(self.others)]:
            if program is not None:
                program.end()
        self.launch = None
        self.others = []

    def close(self):
        self.end_programs()
        self.core.end()


def without_cut_thread(output):
    """The output without a thread's exception that the end of its interpreter cut off before the cause was printed.

    roslaunch ends while its own threads wait for the master; what they print then says nothing of the command.
    """
    return re.sub(
        r"^Exception in thread .*\nTraceback .*\n(  File .*\n(    .*\n?)*)*\Z", "", output, flags=re.MULTILINE
    )


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]
