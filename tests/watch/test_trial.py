"""scripts/try without its build."""

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
import urllib.request
from pathlib import Path

import pytest
from robot_control.watch import trial

LIMIT = 200.0
"""s, ten times the promise"""


@pytest.mark.parametrize("given", [["nothing.urdf"], ["--port", "1"], ["--port", "99999"], ["--scene"]])
def test_a_wrong_argument_ends_it_before_anything_starts(given, monkeypatch, capsys):
    monkeypatch.setattr(trial, "_free", lambda port: port not in (1, 99999))
    with pytest.raises(SystemExit) as ended:
        trial.parse(given)
    assert ended.value.code == 2
    assert "usage" in capsys.readouterr().err


def test_a_port_in_use_is_named():
    with trial.socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(SystemExit):
            trial.parse(["--port", str(taken.getsockname()[1])])


@contextlib.contextmanager
def started(tmp_path, *arguments):
    """A program whose output ends: one that prints nothing for long is ended."""
    pytest.importorskip("aiohttp", reason="scripts/setup --console installs it")
    environment = {**os.environ, "ROS_HOME": str(tmp_path), "TMPDIR": str(tmp_path)}
    command = [sys.executable, "-u", "-m", "robot_control.watch.trial", "--no-browser", *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    with subprocess.Popen(command, env=environment, text=True, start_new_session=True, **pipes) as process:
        end = threading.Timer(LIMIT, process.terminate)
        end.start()
        try:
            yield process
        finally:
            end.cancel()
            process.terminate()


def call(master, name):
    """The answer of a service, a success if there is one within half a minute."""
    command = [sys.executable, "-c", CALL, name]
    environment = {**os.environ, "ROS_MASTER_URI": master}
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=True).stdout


CALL = """
import sys, time, rospy
from std_srvs.srv import Trigger
rospy.wait_for_service(sys.argv[1], 30)
end = time.monotonic() + 30
while not (answer := rospy.ServiceProxy(sys.argv[1], Trigger)()).success and time.monotonic() < end:
    time.sleep(0.5)  # a reset needs a moment without a command
print(answer)
"""


def run_once(tmp_path, robot, *services):
    """Everything that is printed until Ctrl-C, after a look at the page and calls of services."""
    with started(tmp_path, robot) as process:
        said = line = process.stdout.readline()
        assert "open  http://127.0.0.1:" in line, line + process.stdout.read()
        with urllib.request.urlopen(line.split("open  ")[1].strip(), timeout=20) as page:
            assert page.status == 200
            assert b"<title>" in page.read()
        while "Ctrl-C ends all" not in line:
            line = process.stdout.readline()
            said += line
            assert line, said
        master = re.search(r"export ROS_MASTER_URI=(\S+)", said)
        for name in services:
            answer = call(master[1] if master else f"http://127.0.0.1:{trial.MASTER_PORT}", name)
            assert "success: True" in answer, answer
        process.send_signal(signal.SIGINT)
        said += process.stdout.read()
        assert process.wait(60) == 0, said
    assert_nothing_left(tmp_path)
    return said


@pytest.mark.parametrize("robot", trial.ROBOTS)
def test_it_prints_one_address_that_answers_and_ctrl_c_ends_all(robot, tmp_path):
    run_once(tmp_path, robot)


def test_a_robot_that_was_stopped_before_its_end_starts_stopped_and_says_so(tmp_path):
    run_once(tmp_path, "diffbot", "e_stop_trigger")
    said = run_once(tmp_path, "diffbot", "e_stop_reset")
    assert "STOPPED: e_stop_service: " in said
    assert "call e_stop_reset" in said


@pytest.mark.parametrize("delay", [0.8, 1.6, 2.4])
def test_ctrl_c_during_the_start_leaves_nothing(delay, tmp_path):
    with started(tmp_path) as process:
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=LIMIT)
    assert_nothing_left(tmp_path)


def assert_nothing_left(tmp_path):
    groups = Path("/proc").glob("[0-9]*/environ")
    assert not any(str(tmp_path).encode() in content(each) for each in groups), "a process has outlived it"


def content(path):
    try:
        return path.read_bytes()
    except OSError:
        return b""


def test_a_robot_that_is_refused_ends_it_with_the_reason(tmp_path):
    broken = tmp_path / "broken.urdf"
    broken.write_text("<robot name='broken'><link name='base_link'/></robot>")
    with started(tmp_path, str(broken)) as process:
        said, _ = process.communicate(timeout=LIMIT)
        assert process.returncode == 1
        assert "refused:" in said.splitlines()[1]
        assert "broken.urdf" in said
