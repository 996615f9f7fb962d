"""The limits of the drives are limits of the robot: it plans under them, keeps the curve, and says so."""

from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.installed_files import share_file
from robot_control.loop.drives import DRIVES
from robot_control.loop.signal_names import mask_of

LIMIT = 5.0  # rad/s: 0.5 m/s at a radius of 0.1 m
LINEAR, ANGULAR = 0.7, 0.8  # m/s, rad/s: the outer wheel needs 9 rad/s
CASES = [(name, command) for name, row in DRIVES.items() for command in row.wheel_commands]


def loop_with(tmp_path, name, command, **values):
    """A robot behind the drives of the example, in which these keys have other values."""
    lines = Path(share_file(f"config/drives/{name}.yaml")).read_text().splitlines()
    for key, value in values.items():
        lines = [f"  {key}: {value}" if line.split(":")[0].strip() == key else line for line in lines]
    file = tmp_path / f"{name}.yaml"
    file.write_text("\n".join(lines))
    robot = {"wheel_command": command}
    if DRIVES[name].driver != "can":
        robot["driver"] = DRIVES[name].driver
    return ClosedLoop({"robot": robot}, drives=str(file))


def steady(loop, twist):
    """The log of the last second of a drive with this twist."""
    loop.run(1.0, (0.0, 0.0))
    loop.run(5.0, twist)
    return loop.run(1.0, twist)


@pytest.mark.parametrize(("name", "command"), CASES)
def test_a_velocity_limit_keeps_the_curvature_and_is_named(tmp_path, name, command):
    log = steady(loop_with(tmp_path, name, command, velocity_limit=LIMIT), (LINEAR, ANGULAR))
    linear, angular = np.mean(log["truth_linear"]), np.mean(log["truth_angular"])
    assert 0.1 < linear < LINEAR
    assert angular / linear == pytest.approx(ANGULAR / LINEAR, rel=0.05)
    assert (log["command_reasons"].astype(np.uint64) & np.uint64(mask_of("CommandReason", "saturated"))).all()


@pytest.mark.parametrize(("name", "command"), CASES)
def test_the_model_has_the_limits_of_the_drives(tmp_path, name, command):
    loop = loop_with(tmp_path, name, command, velocity_limit=LIMIT)
    assert {joint["velocity_limit"] for joint in loop.robot["joints"] if joint["role"] == "wheel"} == {LIMIT}
    assert any("wheel_velocity_limit" in note["element"] for note in loop.robot["notes"])


@pytest.mark.parametrize(("name", "command"), [case for case in CASES if case[0] != "roboclaw"])
def test_a_torque_limit_is_planned_under(tmp_path, name, command):
    """1 N·m of each wheel accelerates 12 kg by 1.7 m/s² at most; the drive never cuts what was planned."""
    loop = loop_with(tmp_path, name, command, torque_limit=1)
    assert {joint["effort_limit"] for joint in loop.robot["joints"] if joint["role"] == "wheel"} == {1.0}
