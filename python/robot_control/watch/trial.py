"""Starts a simulated robot in a scene with its console, prints the address of the page, and ends all at Ctrl-C."""

import argparse
import contextlib
import ctypes
import itertools
import os
import re
import signal
import socket
import sys
import tempfile
import time
import webbrowser
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import FrameType

import rosgraph

from robot_control.ui.child import Child, children
from robot_control.ui.program import run

ROBOTS = ("diffbot", "quadbot")
MASTER_PORT, CONSOLE_PORT, PORTS = 11311, 8080, 100
"""the usual ports of a ROS master and of the console, and how many are tried from there on"""
LASER_RATE = 10
"""Hz"""
STARTED = re.compile(r"(?:ready|STOPPED): .*")
"""what a robot prints when it may be commanded, or waits for a reset: a stop outlives a restart"""
SET_CHILD_SUBREAPER = 36
"""PR_SET_CHILD_SUBREAPER of linux/prctl.h"""
POLL = 0.1
"""s"""
LAST = 10.0
"""s for a launch that has lost its robot to end, and for programs that lost their parent"""
LINES = 15
"""of an output that are shown when it has ended"""


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """`robot` (name or file), `scene`, `port` and `browser` of scripts/try; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="scripts/try",
        description="A simulated robot with a laser, a console and a black box. Ctrl-C ends all.",
        epilog="Programs beside it, as rosrun robot_control why.py, run in a terminal after source install/setup.bash.",
    )
    what = "diffbot, quadbot, or a URDF or xacro file (default %(default)s)"
    parser.add_argument("robot", nargs="?", type=_robot, default=ROBOTS[0], help=what)
    parser.add_argument("--scene", default="room", help="an included scene or an MJCF file (default %(default)s)")
    parser.add_argument("--port", type=int, help=f"of the console (default: the first free one from {CONSOLE_PORT} on)")
    parser.add_argument("--no-browser", dest="browser", action="store_false", help="only print the address")
    given = parser.parse_args(arguments)
    if given.port is not None and not _free(given.port):
        parser.error(f"--port {given.port} is in use: remove --port, or stop the program that uses it")
    return given


def try_out(robot: str, scene: str, port: int, out: Path, *, browser: bool) -> int:
    """Runs until Ctrl-C, or until a part of it ends. Returns the exit code."""
    master = _free_port(MASTER_PORT)
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{master}"
    os.environ["ROS_IP"] = "127.0.0.1"
    os.environ.pop("ROS_HOSTNAME", None)
    which = f"robot:={robot}" if robot in ROBOTS else f"urdf:={robot}"
    launch = ["roslaunch", "-p", str(master), "robot_control", "sim.launch", which, f"scene:={scene}"]
    with _descendants(), children() as started:
        robot_part = Child([*launch, f"laser_rate:={LASER_RATE}"], out / "robot.log")
        started.append(robot_part)
        while robot_part.running and not rosgraph.is_master_online():
            time.sleep(POLL)
        console = Child(["rosrun", "robot_control", "console.py", "--port", str(port)], out / "console.log")
        started.append(console)
        address = ""
        while robot_part.running and console.running:
            if not address and (address := _address(robot_part, console)):
                _say(address, robot_part, robot, out)
                if browser and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
                    webbrowser.open(address)
            time.sleep(POLL)
        # The console ends with its master: what ended the robot is the cause.
        ended = robot_part if robot_part.wait(LAST) else console
    print(f"scripts/try: it has ended:\n{_last_words(ended.output)}", file=sys.stderr)
    return 1


@contextlib.contextmanager
def _descendants() -> Iterator[None]:
    """Ends what the block has started, also programs that lost their parent, which become children of this process.

    The ROS master of a roslaunch is one, if that is interrupted before its master runs.
    """
    ctypes.CDLL(None).prctl(SET_CHILD_SUBREAPER, 1)
    try:
        yield
    finally:
        kill_at = time.monotonic() + LAST
        while left := Path(f"/proc/self/task/{os.getpid()}/children").read_text().split():
            for process in left:
                os.kill(int(process), signal.SIGTERM if time.monotonic() < kill_at else signal.SIGKILL)
            time.sleep(POLL)
            with contextlib.suppress(ChildProcessError):
                while os.waitpid(-1, os.WNOHANG)[0]:
                    pass


def _address(robot_part: Child, console: Child) -> str:
    """That of the page, once the robot may be commanded or reset; empty before."""
    found = re.search(r"^open (\S+)$", console.output.read_text(), re.MULTILINE)
    return found[1] if found and STARTED.search(_plain(robot_part.output)) else ""


def _say(address: str, robot_part: Child, robot: str, out: Path) -> None:
    lines = [f"{Path(robot).stem} runs; open  {address}", f"log: {out}"]
    if (state := STARTED.findall(_plain(robot_part.output))[-1]).startswith("STOPPED"):
        lines.append(state)
    if (master := os.environ["ROS_MASTER_URI"]) != f"http://127.0.0.1:{MASTER_PORT}":
        lines.append(f"programs beside it: export ROS_MASTER_URI={master}")
    print("\n".join([*lines, "Ctrl-C ends all"]))


def _last_words(log: Path) -> str:
    """The output of a launch from its first refusal on, else its last lines, without colours and stamps."""
    said = [re.sub(r"^\[\s*\w+\] \[[\d.]+\]: ", "", line) for line in _plain(log).splitlines() if line.strip()]
    first = next((i for i, line in enumerate(said) if "refused:" in line), len(said) - LINES)
    shown = said[max(0, first) :]
    return "\n".join(itertools.takewhile(lambda line: "REQUIRED process" not in line, shown[:LINES]))


def _plain(output: Path) -> str:
    """Its text without colours."""
    return re.sub(r"\x1b\[[0-9;]*m", "", output.read_text(errors="replace"))


def _robot(text: str) -> str:
    if text in ROBOTS:
        return text
    path = Path(text).resolve()
    if not path.is_file():
        raise argparse.ArgumentTypeError(f"{text} is neither {' nor '.join(ROBOTS)} nor a file")
    return str(path)


def _free(port: int) -> bool:
    with socket.socket() as probe, contextlib.suppress(OSError, OverflowError):
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        probe.bind(("127.0.0.1", port))
        return True
    return False


def _free_port(first: int) -> int:
    for port in range(first, first + PORTS):
        if _free(port):
            return port
    raise OSError(f"none of the ports {first} … {first + PORTS - 1} is free")


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt


def main() -> int:
    """Entry point of scripts/try."""
    given = parse()
    signal.signal(signal.SIGTERM, _interrupt)
    port = _free_port(CONSOLE_PORT) if given.port is None else given.port
    with tempfile.TemporaryDirectory(prefix="robot_control_try_") as out:
        try:
            return try_out(given.robot, given.scene, port, Path(out), browser=given.browser)
        except KeyboardInterrupt:
            return 0


if __name__ == "__main__":
    run(main)
