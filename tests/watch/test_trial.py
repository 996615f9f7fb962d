"""scripts/try without its build."""

import os
import signal
import subprocess
import sys
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


def start(tmp_path, *arguments):
    pytest.importorskip("aiohttp", reason="scripts/setup --console installs it")
    environment = {**os.environ, "ROS_HOME": str(tmp_path), "TMPDIR": str(tmp_path)}
    command = [sys.executable, "-u", "-m", "robot_control.watch.trial", "--no-browser", *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    return subprocess.Popen(command, env=environment, text=True, start_new_session=True, **pipes)


@pytest.mark.parametrize("robot", trial.ROBOTS)
def test_it_prints_one_address_that_answers_and_ctrl_c_ends_all(robot, tmp_path):
    with start(tmp_path, robot) as process:
        begun = time.monotonic()
        line = process.stdout.readline()
        assert "open  http://127.0.0.1:" in line, line
        assert time.monotonic() - begun < LIMIT
        address = line.split("open  ")[1].strip()
        with urllib.request.urlopen(address, timeout=20) as page:
            assert page.status == 200
            assert b"<title>" in page.read()
        process.send_signal(signal.SIGINT)
        rest = process.stdout.read()
        assert process.wait(60) == 0, rest
        assert "Ctrl-C ends all" in rest
    assert_nothing_left(tmp_path)


@pytest.mark.parametrize("delay", [0.8, 1.6, 2.4])
def test_ctrl_c_during_the_start_leaves_nothing(delay, tmp_path):
    with start(tmp_path) as process:
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
    with start(tmp_path, str(broken)) as process:
        said, _ = process.communicate(timeout=LIMIT)
        assert process.returncode == 1
        assert "refused:" in said.splitlines()[1]
        assert "broken.urdf" in said
