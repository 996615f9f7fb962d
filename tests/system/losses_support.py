"""The losses for the loss tests: a master of their own, the clock of the nodes, a link between two networks."""

import atexit
import contextlib
import ctypes
import errno
import os
import shutil
import socket
import struct
import subprocess
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import rosgraph
from system.system_support import wait_for

CLONE_NEWNET = 0x40000000
"""unshare(2)"""
FULL_SPEED = 1.0
"""m/s: max_linear_speed."""
FAST = 0.97 * FULL_SPEED
"""m/s; a robot that is faster has reached full speed."""
KEPT = 0.9 * FULL_SPEED
"""m/s; a robot that is never slower was not stopped: the brake passes this range in 30 ms."""


def free_port(address: str) -> int:
    """A free TCP port on that address."""
    with socket.socket() as probe:
        probe.bind((address, 0))
        return int(probe.getsockname()[1])


class Master:
    """A ROS master that may be lost; this process and its children use it. Make it before rospy is initialised."""

    def __init__(self, address: str = "127.0.0.1") -> None:
        self.address = address
        self.uri = f"http://{address}:{free_port(address)}"
        os.environ.update(ROS_MASTER_URI=self.uri, ROS_IP=address)
        os.environ.pop("ROS_HOSTNAME", None)
        self.start()
        atexit.register(self.kill)

    def start(self) -> None:
        """Starts it and waits until it answers. After `kill` it is another master, which knows no node."""
        self._process = subprocess.Popen(
            ["rosmaster", "--core", "-p", self.uri.rpartition(":")[2]],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        wait_for(f"a ROS master at {self.uri}", lambda: bool(rosgraph.is_master_online(self.uri)))

    def kill(self) -> None:
        """Kills with -9 and waits for the end; a second call does nothing."""
        self._process.kill()
        self._process.wait()


def run(*words: str) -> None:
    """Runs a command that must succeed."""
    subprocess.run(words, check=True, stdin=subprocess.DEVNULL)


def enter_network_of_own() -> None:
    """Gives this process and its children a network of their own. Call it before any thread.

    Raises:
        OSError: not granted, or the program ip is missing; the network is the one before.
    """
    if shutil.which("ip") is None:
        raise FileNotFoundError(errno.ENOENT, "the program ip is missing: apt install iproute2")
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.unshare(CLONE_NEWNET) != 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
    run("ip", "link", "set", "lo", "up")


class Link:
    """A cable (veth pair) from this network to one behind it, where `run_there` runs programs.

    The addresses are of 192.0.2.0/24, which RFC 5737 reserves for documentation.
    """

    HERE, THERE = "192.0.2.1", "192.0.2.2"

    def __init__(self) -> None:
        self._holder = subprocess.Popen(["unshare", "-n", "sleep", "infinity"], stdin=subprocess.DEVNULL)
        here = Path("/proc/self/ns/net").readlink()
        end = time.monotonic() + 10.0
        while Path(f"/proc/{self._holder.pid}/ns/net").readlink() == here:  # unshare has not run yet
            if time.monotonic() > end:
                raise AssertionError("no second network")
            time.sleep(0.01)
        run("ip", "link", "add", "robot0", "type", "veth", "peer", "name", "teleop0")
        run("ip", "link", "set", "teleop0", "netns", str(self._holder.pid))
        run("ip", "addr", "add", f"{self.HERE}/24", "dev", "robot0")
        run("ip", "link", "set", "robot0", "up")
        self._there("ip", "addr", "add", f"{self.THERE}/24", "dev", "teleop0")
        self._there("ip", "link", "set", "lo", "up")
        self.plug(True)

    def plug(self, plugged: bool) -> None:
        """Plugs the cable in, or pulls it out at the far end."""
        self._there("ip", "link", "set", "teleop0", "up" if plugged else "down")

    def run_there(self, *words: str) -> subprocess.Popen[bytes]:
        """A program behind the link."""
        return subprocess.Popen(
            [*self._prefix(), *words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "ROS_IP": self.THERE},
        )

    def end(self) -> None:
        """The cable goes with the network behind it."""
        self._holder.kill()
        self._holder.wait()

    def _prefix(self) -> Sequence[str]:
        return ("nsenter", "-t", str(self._holder.pid), "-n")

    def _there(self, *words: str) -> None:
        run(*self._prefix(), *words)


class JumpingClock:
    """The wall clock of programs started in `worn`: off by the value of `jump`. No other clock moves."""

    def __init__(self, library: str, file: Path) -> None:
        self._library = library
        self._file = file
        self.jump(0.0)

    def jump(self, seconds: float) -> None:
        """Sets the offset from the true time."""
        # One write of eight bytes, in place: a process that has the file mapped never reads a part of it.
        with self._file.open("r+b" if self._file.exists() else "w+b", buffering=0) as file:
            file.write(struct.pack("=q", int(seconds * 1e9)))

    @contextlib.contextmanager
    def worn(self) -> Iterator[None]:
        """Programs started within see this clock."""
        os.environ.update(LD_PRELOAD=self._library, JUMPING_CLOCK=str(self._file))
        try:
            yield
        finally:
            del os.environ["LD_PRELOAD"], os.environ["JUMPING_CLOCK"]
