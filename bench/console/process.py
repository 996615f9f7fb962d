"""console.py as a process, with a home of its own."""

from __future__ import annotations

import http.cookiejar
import os
import re
import signal
import socket
import subprocess
import tempfile
import time
import urllib.request
from collections.abc import Callable, Mapping
from pathlib import Path

import roslib.packages

LIMIT = 30.0
"""s for what takes a second on an idle machine"""


def wait_for(what: str, condition: Callable[[], object], limit: float = LIMIT) -> None:
    """Polls until the condition holds; AssertionError names `what`."""
    end = time.monotonic() + limit
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"not within {limit:g} s: {what}")
        time.sleep(0.02)


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    """A port of the loopback that is free now, by default of TCP."""
    with socket.socket(type=kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def program(name: str) -> str:
    """The path of a program of the package."""
    found = roslib.packages.find_node("robot_control", name)
    if not found:
        raise AssertionError(f"robot_control has no program {name}")
    return str(found[0])


class Console:
    """The program. `proxied`: a port of a proxy through which its pages come; `users`: name → role."""

    def __init__(self, *arguments: str, proxied: int = 0, users: Mapping[str, str] | None = None) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="console-home-")
        self.home = Path(self._folder.name)
        self.port = free_port()
        self._environment = {**os.environ, "ROS_HOME": str(self.home), "PYTHONUNBUFFERED": "1"}
        self._arguments = [*arguments, *(["--origin", f"http://127.0.0.1:{proxied}"] if proxied else [])]
        self.links = {name: self._add(name, role) for name, role in (users or {}).items()}
        self.start()

    def _add(self, name: str, role: str) -> str:
        command = [program("console_users.py"), "add", name, "--role", role]
        done = subprocess.run(command, capture_output=True, text=True, check=True, env=self._environment)
        return done.stdout.strip().rpartition("#")[2]

    def start(self) -> None:
        """Starts the program, again after its end, and waits for its address."""
        command = [program("console.py"), "--port", str(self.port), *self._arguments]
        output = self.home / "output"
        with output.open("w") as file:
            self.process = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, env=self._environment)
        wait_for("the address", lambda: "open http" in output.read_text() or self.process.poll() is not None)
        found = re.search(r"open (\S+)", output.read_text())
        if not found:
            raise AssertionError(output.read_text())
        self.address = found[1]
        self.origin = self.address.split("/?")[0].rstrip("/")

    @property
    def output(self) -> str:
        """Its printed lines."""
        return (self.home / "output").read_text()

    @property
    def journal(self) -> str:
        """Who did what."""
        return (self.home / "robot_control" / "console.log").read_text()

    def through(self, port: int) -> str:
        """The address through a proxy."""
        return self.address.replace(f":{self.port}", f":{port}")

    def log_in(self) -> tuple[urllib.request.OpenerDirector, str]:
        """A client that has logged in with the token, and its cookie."""
        cookies = http.cookiejar.CookieJar()
        opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor(cookies))
        opener.open(self.address, timeout=10).read()
        return opener, "; ".join(f"{each.name}={each.value}" for each in cookies)

    def revive(self) -> None:
        """Ends a SIGSTOP, and starts the program again if it has ended."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
        else:
            self.start()

    def kill(self) -> None:
        """SIGKILL."""
        self.process.kill()
        self.process.wait()

    def end(self) -> None:
        """SIGINT, then SIGKILL."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                self.kill()
        self._folder.cleanup()


def cost_of(pid: int) -> tuple[float, int]:
    """s of processor time of a process, and bytes in memory."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    used = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return used, pages * os.sysconf("SC_PAGE_SIZE")
