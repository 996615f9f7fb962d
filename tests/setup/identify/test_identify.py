"""identify.py without a robot: existing logs, command lines, refusals."""

import math
import sys
from pathlib import Path

import pytest
import yaml
from robot_control import ClosedLoop
from robot_control.installed_files import share_file
from robot_control.settings.block import Settings
from robot_control.setup.identify.evaluation import parse_options, plan
from robot_control.setup.identify.fit import Estimate
from robot_control.setup.identify.main import main
from robot_control.setup.identify.report import _measured

PARAMS = share_file("config/robot_params.yaml")
FRICTION = 0.1  # N·m


def written(loop, folder, seconds, command):
    """The log of such a drive."""
    loop.log_into(folder)
    loop.run(seconds, command)
    loop.end_log()
    return folder / "run.bag"


@pytest.fixture(scope="module")
def run_bag(tmp_path_factory):
    """A log of the excitation."""
    options = parse_options(["--repeats=1"])
    excitation = plan(Settings(PARAMS, ()), options)
    loop = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet", "motor_friction": FRICTION}})
    return written(loop, tmp_path_factory.mktemp("log"), excitation.seconds + 0.5, excitation.command)


def identify(monkeypatch, *arguments):
    monkeypatch.setattr(sys, "argv", ["identify.py", *map(str, arguments)])
    main()


def refusal(monkeypatch, *arguments):
    with pytest.raises(SystemExit) as ended:
        identify(monkeypatch, *arguments)
    assert ended.value.code not in (None, 0)
    return str(ended.value.code)


def test_fits_a_log_and_writes_an_overlay_that_the_loop_takes(run_bag, tmp_path, monkeypatch, capsys):
    output = tmp_path / "identified.yaml"
    identify(monkeypatch, f"--log={run_bag}", f"--output={output}", f"--params={PARAMS}")
    printed = capsys.readouterr().out
    for word in ("nominal", "measured", "proposed", "±", "gain margin", "delay margin", "spectral radius"):
        assert word in printed
    overlay = yaml.safe_load(output.read_text())
    assert list(overlay) == ["diff_drive_controller"]
    assert overlay["diff_drive_controller"]["feed_forward"]["wheel_friction"] == pytest.approx(FRICTION, rel=0.05)
    loop = ClosedLoop(overlay)
    assert loop.run(3.0, (0.5, 0.0))["truth_linear"][-1] == pytest.approx(0.5, rel=0.01)


def test_refuses_the_log_of_another_robot(tmp_path, monkeypatch):
    urdf = tmp_path / "other.urdf"
    urdf.write_text(Path(share_file("urdf/diffbot.urdf")).read_text().replace("left_wheel_joint", "port_wheel"))
    other = written(ClosedLoop(urdf=str(urdf)), tmp_path, 0.1, (0.0, 0.0))
    message = refusal(monkeypatch, f"--log={other}", f"--output={tmp_path}/x.yaml")
    assert "the log is from another robot: it has no joint left_wheel_joint, but port_wheel" in message
    assert not (tmp_path / "x.yaml").exists()


def test_refuses_the_log_of_a_robot_on_legs(tmp_path, monkeypatch):
    log = written(ClosedLoop(urdf=share_file("urdf/quadbot.urdf")), tmp_path, 0.1, (0.0, 0.0))
    message = refusal(monkeypatch, f"--log={log}", f"--output={tmp_path}/x.yaml")
    assert message == "identify.py: this robot is a quadruped: identify.py works on wheels only"


def test_refuses_a_log_that_is_not_there(tmp_path, monkeypatch):
    message = refusal(monkeypatch, f"--log={tmp_path}/none.bag")
    assert message == f"identify.py: {tmp_path}/none.bag: file not found"


@pytest.mark.parametrize(
    ("command", "missing"),
    [
        ((0.5, 0.0), "turning cannot be determined from this log: it contains no turns"),
        ((0.0, 0.5), "straight cannot be determined"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_a_log_without_turns_or_ramps_is_refused_in_words_without_nan(command, missing, tmp_path, monkeypatch):
    log = written(ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}}), tmp_path, 6.0, command)
    message = refusal(monkeypatch, f"--log={log}", f"--output={tmp_path}/x.yaml")
    assert missing in message
    assert "nan" not in message


@pytest.mark.filterwarnings("error")
def test_the_log_of_a_demo_is_refused_without_nan_or_a_warning(tmp_path, monkeypatch):
    loop = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}})
    log = written(loop, tmp_path, 10.0, lambda t: (0.5, 0.2) if 1 < t < 9 else (0.0, 0.0))
    message = refusal(monkeypatch, f"--log={log}", f"--output={tmp_path}/x.yaml")
    assert "The log contains too little of it; drive more" in message or "cannot be determined" in message
    assert "nan" not in message


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [(1.5, 0.02, "1.5 ± 0.02"), (math.nan, math.nan, "not in the log"), (3.0, math.inf, "3, error unknown")],
)
def test_a_table_cell_holds_no_nan(value, error, text):
    assert _measured(Estimate(value, error)) == text


def test_refuses_parameters_that_are_wrong(run_bag, tmp_path, monkeypatch):
    params = tmp_path / "params.yaml"
    params.write_text("robot: {rate: fast}\n")
    assert "robot.rate" in refusal(monkeypatch, f"--log={run_bag}", f"--params={params}")


def test_without_a_master_it_names_both_ways_out(monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:1")  # reserved; no process listens
    message = refusal(monkeypatch)
    assert "no ROS master at http://127.0.0.1:1" in message
    assert "--log" in message


@pytest.mark.parametrize(
    "arguments",
    [
        ["--space=0"],
        ["--space=nan"],
        ["--max-speed=-1"],
        ["--repeats=0"],
        ["--mass=0"],
        ["--urdf=a.urdf"],
        ["--params=a.yaml"],
    ],
)
def test_refuses_a_wrong_command_line(arguments, monkeypatch, capsys):
    with pytest.raises(SystemExit) as ended:
        identify(monkeypatch, *arguments)
    assert ended.value.code == 2
    assert arguments[0].split("=")[0] in capsys.readouterr().err


def test_a_joint_that_turns_slowly_slows_the_plan():
    fast = plan(Settings(PARAMS, ()), parse_options([])).linear
    slow = plan(Settings(PARAMS, (("robot.wheel_velocity_limit", "3"),)), parse_options([])).linear
    assert fast == 0.5
    assert slow == pytest.approx(0.9 * 3 * 0.1)
