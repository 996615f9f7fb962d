"""identify.py without a robot: existing logs, command lines, refusals."""

import math
import sys

import pytest
import yaml
from robot_control import ClosedLoop
from robot_control.common.settings import Settings
from robot_control.identify.evaluation import parse_options, plan
from robot_control.identify.fit import Estimate
from robot_control.identify.main import main
from robot_control.identify.report import _measured
from robot_control.installed_files import share_file

PARAMS = share_file("config/robot_params.yaml")
FRICTION = 0.1  # N·m


def written(log, folder):
    """Writes a log as telemetry does."""
    file = folder / "run.csv"
    rows = zip(*log.values(), strict=True)
    lines = [",".join(log), *(",".join("" if math.isnan(cell) else repr(float(cell)) for cell in row) for row in rows)]
    file.write_text("\n".join(lines) + "\n")
    return file


@pytest.fixture(scope="module")
def run_csv(tmp_path_factory):
    """A log of the excitation as telemetry writes it."""
    options = parse_options(["--repeats=1"])
    excitation = plan(Settings(PARAMS, ()), options)
    loop = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet", "motor_friction": FRICTION}})
    log = loop.run(excitation.seconds + 0.5, excitation.command)
    return written(log, tmp_path_factory.mktemp("log"))


def identify(monkeypatch, *arguments):
    monkeypatch.setattr(sys, "argv", ["identify.py", *map(str, arguments)])
    main()


def refusal(monkeypatch, *arguments):
    with pytest.raises(SystemExit) as ended:
        identify(monkeypatch, *arguments)
    assert ended.value.code not in (None, 0)
    return str(ended.value.code)


def test_fits_a_log_and_writes_an_overlay_that_the_loop_takes(run_csv, tmp_path, monkeypatch, capsys):
    output = tmp_path / "identified.yaml"
    identify(monkeypatch, f"--log={run_csv}", f"--output={output}", f"--params={PARAMS}")
    printed = capsys.readouterr().out
    for word in ("nominal", "measured", "proposed", "±", "gain margin", "delay margin", "spectral radius"):
        assert word in printed
    overlay = yaml.safe_load(output.read_text())
    assert list(overlay) == ["diff_drive_controller"]
    assert overlay["diff_drive_controller"]["feed_forward"]["wheel_friction"] == pytest.approx(FRICTION, rel=0.05)
    loop = ClosedLoop(overlay)
    assert loop.run(3.0, (0.5, 0.0))["truth_linear"][-1] == pytest.approx(0.5, rel=0.01)


def test_refuses_the_log_of_another_robot(run_csv, tmp_path, monkeypatch):
    text = run_csv.read_text().replace("left_wheel_joint", "port_wheel", 100)
    other = tmp_path / "run.csv"
    other.write_text(text)
    message = refusal(monkeypatch, f"--log={other}", f"--output={tmp_path}/x.yaml")
    assert "the log is of another robot: it has no joint left_wheel_joint, but port_wheel" in message
    assert not (tmp_path / "x.yaml").exists()


@pytest.mark.parametrize("column", ["gate_verdict", "left_wheel_joint_velocity_command"])
def test_names_a_column_that_the_log_does_not_have(run_csv, column, tmp_path, monkeypatch):
    header, rest = run_csv.read_text().split("\n", 1)
    other = tmp_path / "run.csv"
    other.write_text(",".join("x" if name == column else name for name in header.split(",")) + "\n" + rest)
    message = refusal(monkeypatch, f"--log={other}", f"--output={tmp_path}/x.yaml")
    assert message == f"identify.py: {other}: no column {column}, which is needed here"
    assert not (tmp_path / "x.yaml").exists()


def test_refuses_a_log_that_is_not_there(tmp_path, monkeypatch):
    message = refusal(monkeypatch, f"--log={tmp_path}/none.csv")
    assert message == f"identify.py: {tmp_path}/none.csv cannot be opened or written: No such file or directory"


@pytest.mark.parametrize(
    ("command", "missing"),
    [
        ((0.5, 0.0), "turning cannot be determined from this log: it holds no turns"),
        ((0.0, 0.5), "straight cannot be determined"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_a_log_without_turns_or_ramps_is_refused_in_words_without_nan(command, missing, tmp_path, monkeypatch):
    log = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}}).run(6.0, command)
    message = refusal(monkeypatch, f"--log={written(log, tmp_path)}", f"--output={tmp_path}/x.yaml")
    assert missing in message
    assert "nan" not in message


@pytest.mark.filterwarnings("error")
def test_the_log_of_a_demo_is_refused_without_nan_or_a_warning(tmp_path, monkeypatch):
    log = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}}).run(
        10.0, lambda t: (0.5, 0.2) if 1 < t < 9 else (0.0, 0.0)
    )
    message = refusal(monkeypatch, f"--log={written(log, tmp_path)}", f"--output={tmp_path}/x.yaml")
    assert "the log holds too little of it; drive more" in message or "cannot be determined" in message
    assert "nan" not in message


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [(1.5, 0.02, "1.5 ± 0.02"), (math.nan, math.nan, "not in the log"), (3.0, math.inf, "3, error unknown")],
)
def test_a_table_cell_holds_no_nan(value, error, text):
    assert _measured(Estimate(value, error)) == text


def test_refuses_parameters_that_are_wrong(run_csv, tmp_path, monkeypatch):
    params = tmp_path / "params.yaml"
    params.write_text("robot: {rate: fast}\n")
    assert "robot.rate" in refusal(monkeypatch, f"--log={run_csv}", f"--params={params}")


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
