"""replay.py computes a log again, refuses another one, and answers what-if questions."""

import pytest
from robot_control import ClosedLoop
from robot_control.data.replay.main import main

CYCLES = 1500


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A log of a drive with an emergency stop and a live change."""
    folder = tmp_path_factory.mktemp("log")
    loop = ClosedLoop()
    loop.log_into(folder)
    loop.run(0.7, command=(0.4, 0.3))
    loop.set_parameters({"max_linear_speed": 0.3})
    loop.run(0.5, command=(0.4, 0.3))
    loop.e_stop()
    loop.run(0.3, command=(0.0, 0.0))
    loop.end_log()
    return folder / "run.bag"


def replay(capsys, *arguments):
    """Exit code, printed text, and the message of a refusal."""
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    printed = capsys.readouterr()
    return end.value.code, printed.out, printed.err


def compared(text):
    """Law → rows compared, different, not compared."""
    rows = [line.split() for line in text.splitlines()]
    return {row[0]: [int(cell) for cell in row[1:]] for row in rows if len(row) == 4 and row[1].isdigit()}


def test_every_row_of_a_log_is_computed_again(log, capsys):
    code, text, _ = replay(capsys, log)
    assert code == 0, text
    assert list(compared(text).values()) == [[CYCLES, 0, 0]] * 4


def test_one_law_alone(log, capsys):
    code, text, _ = replay(capsys, log, "--law", "estimator")
    assert code == 0
    assert list(compared(text)) == ["estimator"]


def test_what_if_draws_both(log, capsys, tmp_path):
    picture = tmp_path / "what_if.png"
    code, text, _ = replay(capsys, log, "--set", "diff_drive_controller.max_linear_speed=0.2", "--plot", picture)
    assert code == 0, text
    assert picture.stat().st_size > 10_000


def test_a_picture_that_cannot_be_written_is_refused_before_the_replay(log, capsys, tmp_path, monkeypatch):
    monkeypatch.setattr("robot_control.data.replay.main.replay_log", None)  # it is not reached
    value = "diff_drive_controller.max_linear_speed=0.2"
    for picture, reason in (
        ("none/what_if.png", " not found; create it first"),
        (".", "is a folder"),
        ("what_if.csv", "is not a picture"),
    ):
        code, _, message = replay(capsys, log, "--set", value, "--plot", tmp_path / picture)
        assert code == 2
        assert reason in message


def test_the_log_is_not_overwritten_by_its_picture(log, capsys):
    before = log.read_bytes()
    code, _, message = replay(capsys, log, "--set", "diff_drive_controller.max_linear_speed=0.2", "--plot", log)
    assert code == 2
    assert "is an input of this program" in message
    assert log.read_bytes() == before


@pytest.mark.parametrize("value", ["diff_drive_controller.no_such_key=1", "diff_drive_controller.pid_kp=-1"])
def test_what_no_node_would_take_is_refused(log, capsys, value):
    code, _, message = replay(capsys, log, "--set", value)
    assert code == 2
    assert value.split("=")[0].split(".")[1] in message


def test_another_rate_is_refused(log, capsys, tmp_path):
    other = tmp_path / "other.yaml"
    other.write_text("robot: {rate: 500}\n")
    for arguments in (("--set", "robot.rate=500"), ("--params", other)):
        code, _, message = replay(capsys, log, *arguments, "--plot", tmp_path / "what_if.png")
        assert code == 2
        assert "robot.rate is 500 Hz, that of the log 1000 Hz" in message


def test_what_no_law_takes_over_is_said(log, capsys, tmp_path):
    value = "diff_drive_controller.one_sender=false"
    code, text, _ = replay(capsys, log, "--set", value, "--plot", tmp_path / "what_if.png")
    assert code == 0
    assert "! diff_drive_controller.one_sender has no effect here" in text


def test_a_gain_that_the_log_left_out_is_taken_over(log, capsys, tmp_path):
    gain = "diff_drive_controller.pid_kp=1.0"  # as in docs/log.md
    code, text, _ = replay(capsys, log, "--set", gain, "--plot", tmp_path / "what_if.png")
    assert code == 0
    assert "no effect" not in text


def test_a_file_of_parameters_lies_over_those_of_the_log(log, capsys, tmp_path):
    other = tmp_path / "other.yaml"
    other.write_text("diff_drive_controller: {max_linear_speed: 0.1}\n")
    code, text, _ = replay(capsys, log, "--params", other, "--plot", tmp_path / "what_if.png")
    assert code == 0, text


def test_a_log_that_is_not_there_is_named(capsys, tmp_path):
    code, _, message = replay(capsys, tmp_path / "none.bag")
    assert code == 2
    assert "none.bag" in message
