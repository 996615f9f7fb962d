"""Output that a shell has closed, and a name that is taken, give one message and no traceback."""

import ast
import os
import select
import subprocess
import sys
import threading
import xmlrpc.server
from pathlib import Path

import pytest
import roslib.packages
from robot_control.robot import ros_node
from robot_control.robot.ros_master import living

SCRIPTS = Path(__file__).parents[2] / "scripts"
PROGRAMS = sorted(path.name for path in SCRIPTS.glob("*.py"))


def helped(program, output):
    command = [sys.executable, "-P", str(SCRIPTS / program), "--help"]
    return subprocess.run(
        command, stdout=output, stderr=subprocess.PIPE, text=True, check=False, env=os.environ, timeout=120
    )


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_reader_that_has_left_ends_a_program_without_a_word(program):
    reader, writer = os.pipe()
    os.close(reader)
    ended = helped(program, writer)
    os.close(writer)
    assert (ended.returncode, ended.stderr) == (141, "")


def test_an_output_that_cannot_be_written_is_one_message():
    with Path("/dev/full").open("w") as full:
        ended = helped("estimate.py", full)
    assert ended.returncode == 1
    assert ended.stderr.rstrip() == "estimate.py: No space left on device"


def test_a_line_is_in_a_pipe_as_soon_as_it_is_printed():
    """The program waits for an answer to its line, as one behind `| tee` waits for its user."""
    code = "from robot_control.ui.program import run\ndef main(): print('ready'); input()\nrun(main)"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    with subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
    ) as program:
        printed, _, _ = select.select([program.stdout], [], [], 20.0)
        program.communicate(b"on\n")
    assert printed
    assert program.returncode == 0


def test_what_a_program_returns_is_its_exit_code():
    code = "from robot_control.ui.program import run; run(lambda: 7)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 7


def begins_with(path, call):
    """Whether the last statement of a Python program is that call, by itself or below `if __name__ == "__main__"`."""
    last = ast.parse(path.read_text()).body[-1]
    return ast.unparse(last.body[-1] if isinstance(last, ast.If) else last) == call


def test_every_program_writes_its_lines_at_once():
    """`run` does this for Python's programs, `run_node` for nodes.

    unitree_bridge is no node, and flushes each line. expand_xacro and read_bag write a document for their caller.
    """
    package = SCRIPTS.parent / "python/robot_control"
    modules = [path for path in package.rglob("*.py") if "__main__" in path.read_text()]
    python = {*SCRIPTS.rglob("*.py"), *modules} - {package / "setup/expand_xacro.py", package / "files/read_bag.py"}
    assert [str(path) for path in sorted(python) if not begins_with(path, "run(main)")] == []
    nodes = set((SCRIPTS.parent / "src/main").glob("*.cpp"))
    others = [path.stem for path in sorted(nodes) if "return run_node(" not in path.read_text()]
    assert others == ["unitree_bridge"]
    installed = Path(roslib.packages.find_node("robot_control", "telemetry")[0]).parent
    assert {path.stem for path in installed.iterdir()} <= {path.stem for path in python | nodes}


class Answering:
    """A master that lists one node, and this node: one server for both."""

    def __init__(self, name):
        self.server = xmlrpc.server.SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
        self.uri = f"http://127.0.0.1:{self.server.server_address[1]}"
        self.node = self.uri
        self.server.register_function(
            lambda _, node: [1, "", self.node] if node == name else [-1, "unknown", ""], "lookupNode"
        )
        self.server.register_function(lambda _: [1, "", 4711], "getPid")
        threading.Thread(target=self.server.serve_forever, daemon=True).start()


@pytest.fixture
def master(monkeypatch):
    answering = Answering("/robot2/follow_path")
    monkeypatch.setenv("ROS_MASTER_URI", answering.uri)
    yield answering
    answering.server.shutdown()
    answering.server.server_close()


def test_a_node_that_lives_is_not_replaced(master, monkeypatch):
    monkeypatch.setattr(ros_node.rospy, "init_node", None)  # it is not reached
    monkeypatch.setattr(sys, "argv", ["follow_path.py", "__ns:=/robot2"])
    with pytest.raises(SystemExit, match=r"a node /robot2/follow_path already runs.*rosnode kill"):
        ros_node.begin_node("follow_path")


def test_another_name_begins_and_so_does_one_whose_node_has_died(master, monkeypatch):
    begun = []
    monkeypatch.setattr(ros_node.rospy, "init_node", lambda name, anonymous: begun.append(name))
    monkeypatch.setattr(sys, "argv", ["follow_path.py"])
    ros_node.begin_node("follow_path")
    master.node = "http://127.0.0.1:1"  # nothing listens there
    monkeypatch.setattr(sys, "argv", ["follow_path.py", "__ns:=/robot2"])
    ros_node.begin_node("follow_path")
    assert begun == ["follow_path", "follow_path"]
    assert not living("/robot2/follow_path")


def test_without_a_master_nothing_lives(monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:1")
    assert not living("/follow_path")
