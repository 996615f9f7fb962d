"""The code blocks of README and docs: `sh` and `python` run in order, `console` is checked word by word.

`console` marks commands that need root, hardware, another machine or many minutes, and entry points that tests run
anyway.
"""

import re
import shlex
import shutil
import subprocess
from functools import cache

import numpy as np
import pytest
import rosbag
import rospy
from pages import PAGES, README, ROOT, blocks
from robot_control import ClosedLoop
from sensor_msgs.msg import Imu, JointState
from terminal import Terminal

LANGUAGES = {"sh", "python", "console", "c", "cpp", "text"}
ALL = [block for page in PAGES for block in blocks(page)]
RUN = [block for block in ALL if block.language in ("sh", "python")]
CONSOLE = [block for block in ALL if block.language == "console"]
FOREIGN = {"git", "printf", "docker", "cd", "cmake", "nft", "roscore"}
"""Programs that are not of this project, in `console` blocks."""


def test_every_block_has_a_language_that_says_how_it_is_tested():
    assert [block.place for block in ALL if block.language not in LANGUAGES] == []


def test_at_most_a_quarter_of_the_blocks_is_not_run():
    assert 4 * len(CONSOLE) <= len(CONSOLE) + len(RUN)


@pytest.fixture(scope="module")
def terminal(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reader")
    prepare(folder)
    terminal = Terminal(folder)
    yield terminal
    terminal.close()


def prepare(folder):
    """The files that a reader has: a robot, a drive as CSV and as bag, a log of this package."""
    shutil.copy(ROOT / "urdf" / "diffbot.urdf", folder / "robot.urdf")
    time = np.arange(0, 4, 0.01)
    angle = np.where(time < 1, 0, 4 * (time - 1))  # rad; a second of rest, then 0.4 m/s
    counts = np.floor(angle * 1024 / (2 * np.pi)).astype(int)
    rows = [f"{t:.2f},{c},{c}" for t, c in zip(time, counts, strict=True)]
    (folder / "drive.csv").write_text("\n".join(["t,enc_l,enc_r", *rows]) + "\n")
    write_bag(folder / "drive.bag", time, angle)
    loop = ClosedLoop()
    loop.log_into(folder)
    loop.run(2.0, (0.4, 0.3))
    loop.end_log()


def write_bag(path, time, angle):
    with rosbag.Bag(str(path), "w") as bag:
        for t, q in zip(time, angle, strict=True):
            stamp = rospy.Time.from_sec(100 + t)
            joints = JointState(name=["left_wheel_joint", "right_wheel_joint"], position=[q, q])
            imu = Imu()
            imu.linear_acceleration.z = 9.81
            for topic, message in (("joint_states", joints), ("imu/data_raw", imu)):
                message.header.stamp = stamp
                bag.write(topic, message, stamp)


def pages_to_follow():
    """The README is followed in every run of the tests, the reference pages every night."""
    for page in PAGES:
        if any(block.page == page for block in RUN):
            yield pytest.param(page, id=page.name, marks=() if page == README else pytest.mark.nightly)


@pytest.mark.parametrize("page", pages_to_follow())
def test_a_page_can_be_followed_from_top_to_bottom(page, terminal):
    """The terminal has sourced install/setup.bash; programs that a page starts are ended after it."""
    for block in RUN:
        if block.page == page:
            if block.language == "python":
                terminal.run_python(block.text)
            else:
                for command in block.commands():
                    terminal.run(command, refused=command in block.refused())
    terminal.end_programs()


@cache
def help_of(script):
    done = subprocess.run(
        ["rosrun", "robot_control", script, "--help"], capture_output=True, text=True, timeout=60, check=False
    )
    return done.stdout + done.stderr


@pytest.mark.parametrize("block", CONSOLE, ids=lambda block: block.place)
def test_what_a_block_that_is_not_run_names_exists(block):
    for command in block.commands():
        for part in command.split(" && "):
            check(shlex.split(part))


def check(words):
    program, options = words[0], [word.split("=")[0] for word in words if word.startswith("--")]
    if program.startswith("build/"):
        assert re.fullmatch(r"build/robot_control/tests/\w+/test_\w+", program), words
    elif (ROOT / program).is_file():
        text = (ROOT / program).read_text()
        assert all(option in text for option in options), words
    elif program == "rosrun" and words[1] == "robot_control":
        assert any((ROOT / "scripts").rglob(words[2])), words
        assert all(option in help_of(words[2]) for option in options), words
    elif program == "roslaunch":
        assert (ROOT / "launch" / words[2]).is_file(), words
    elif program == "rosservice":
        assert f"`{words[2]}`" in (ROOT / "docs" / "interfaces.md").read_text(), words
    elif program == "rostopic":
        assert any(f"`{word}`" in (ROOT / "docs" / "interfaces.md").read_text() for word in words[2:]), words
    elif program == "rosparam":
        assert any(words[2] in path.read_text() for path in (ROOT / "python").rglob("*.py")), words
    else:
        assert program in FOREIGN, words
