"""The nodes of sim.launch listen on the loopback, unless set otherwise."""

import os
import signal
import socket
import subprocess
import tempfile
import time
import unittest
from pathlib import Path
from urllib.parse import urlparse

from system.system_support import LIMIT, LOOP, repository, wait_for

LOOPBACK, EVERYWHERE = "127.0.0.1", "0.0.0.0"
LISTEN = "0A"
"""State of a socket in /proc/net/tcp (proc(5); include/net/tcp_states.h of Linux)."""


def children(pid: int) -> dict[str, int]:
    """Programs that a process started, by name."""
    found = {}
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            fields = dict(line.split(":\t", 1) for line in status.read_text().splitlines() if ":\t" in line)
            command = status.with_name("cmdline").read_text()
        except OSError:  # It has ended meanwhile.
            continue
        if fields.get("PPid") == str(pid):
            found[Path(command.split("\0")[0]).name] = int(fields["Pid"])
    return found


def listening_at(pid: int) -> set[str]:
    """IPv4 addresses on which a process listens; none while it opens and closes files."""
    try:
        sockets = {str(link.readlink()) for link in Path(f"/proc/{pid}/fd").iterdir()}
        lines = Path(f"/proc/{pid}/net/tcp").read_text().splitlines()[1:]
    except OSError:
        return set()
    rows = [line.split() for line in lines]
    return {
        ".".join(str(byte) for byte in reversed(bytes.fromhex(row[1].partition(":")[0])))
        for row in rows
        if row[3] == LISTEN and f"socket:[{row[9]}]" in sockets
    }


class LoopbackTest(unittest.TestCase):
    def listening(self, *arguments: str, **environment: str) -> dict[str, set[str]]:
        """Addresses of every node of the loop under sim.launch."""
        bare = {name: value for name, value in os.environ.items() if name not in {"ROS_IP", "ROS_HOSTNAME"}}
        bare["ROS_MASTER_URI"] = f"http://127.0.0.1:{urlparse(os.environ['ROS_MASTER_URI']).port}"
        bus = f"loopback{os.getpid()}.{time.monotonic_ns()}"
        with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryDirectory() as folder:
            sim = str(repository() / "launch" / "sim.launch")
            launch = subprocess.Popen(
                ["roslaunch", sim, f"bus:={bus}", f"out:={folder}", *arguments],
                env={**bare, **environment},
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
            found: dict[str, set[str]] = {}

            def all_listen() -> bool:
                nodes = children(launch.pid)
                found.update({name: listening_at(nodes[name]) for name in LOOP if name in nodes})
                return len(found) == len(LOOP) and all(found.values())

            try:
                wait_for("listening nodes", all_listen)
                time.sleep(0.5)  # the other ports that they open
                all_listen()
            finally:
                launch.send_signal(signal.SIGINT)
                launch.wait(3 * LIMIT)
                for path in Path("/dev/shm").glob(f"robot_control.*.{bus}.*"):
                    path.unlink(missing_ok=True)
        return found

    def setUp(self) -> None:
        try:
            socket.gethostbyname(socket.gethostname())
        except OSError:
            self.skipTest("this machine's name does not resolve: without ROS_IP roslaunch itself does not start")

    def test_by_default_it_is_the_loopback(self) -> None:
        for node, addresses in self.listening().items():
            self.assertEqual(addresses, {LOOPBACK}, node)

    def test_whoever_names_a_host_is_reachable_from_outside(self) -> None:
        for node, addresses in self.listening(ROS_HOSTNAME=socket.gethostname()).items():
            self.assertEqual(addresses, {EVERYWHERE}, node)

    def test_the_argument_outweighs_the_environment(self) -> None:
        for node, addresses in self.listening("ip:=127.0.0.1", ROS_HOSTNAME=socket.gethostname()).items():
            self.assertEqual(addresses, {LOOPBACK}, node)
