"""A program checks its output files before its work."""

import os
from pathlib import Path

import pytest
from robot_control.files.output_files import check_outputs
from robot_control.installed_files import share_file
from robot_control.ui.picture_file import check_picture
from support.programs import module_of


def test_what_can_be_written_is_accepted(tmp_path):
    (tmp_path / "old").touch()
    (tmp_path / "link").symlink_to("old")
    (tmp_path / "dangling").symlink_to("fresh")
    check_outputs([None, tmp_path / "new", tmp_path / "old", tmp_path / "dangling"], [None, tmp_path / "input"])
    check_outputs([tmp_path / "link"])
    check_outputs([Path("/dev/null"), Path("/dev/null")])
    reader, writer = os.pipe()
    check_outputs([Path(f"/dev/fd/{writer}")])
    os.close(reader)
    os.close(writer)


def test_what_cannot_be_written_is_refused_by_name(tmp_path):
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "away").symlink_to("none/file")
    (tmp_path / "input").touch()
    (tmp_path / "same").symlink_to("input")
    for outputs, said in (
        ([tmp_path], "is a folder"),
        ([tmp_path / "none" / "file"], f"folder {tmp_path / 'none'} not found"),
        ([tmp_path / "away"], f"folder {tmp_path / 'none'} not found"),
        ([tmp_path / "loop"], "its symbolic link leads to itself"),
        ([tmp_path / "input"], "is an input of this program"),
        ([tmp_path / "same"], "is an input of this program"),
        ([tmp_path / "a", tmp_path / "b", tmp_path / "a"], "is the name of two outputs"),
    ):
        with pytest.raises(ValueError, match=said):
            check_outputs(outputs, [tmp_path / "input"])


def test_a_picture_has_the_suffix_of_one():
    check_picture(Path("a.png"))
    for name in ("a", "a.docx", "/dev/null"):
        with pytest.raises(ValueError, match="is not a picture: its suffix must be one of"):
            check_picture(Path(name))


@pytest.mark.parametrize(
    ("program", "arguments"),
    [
        ("inspect", ["robot.urdf", "--mjcf", "robot.urdf"]),
        ("export", ["run.bag", "--csv", "run.bag"]),
        ("report", ["run.bag", "--out", "run.bag"]),
        ("estimate", ["run.csv", "--urdf", "robot.urdf", "--calibration", "robot.urdf"]),
    ],
)
def test_no_program_writes_over_what_it_reads(program, arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("robot.urdf").write_bytes(Path(share_file("urdf/diffbot.urdf")).read_bytes())
    Path("run.bag").write_bytes(b"#ROSBAG V2.0\n")
    Path("run.csv").write_bytes(b"time,left,right\n0,0,0\n")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(SystemExit) as refusal:
        module_of(program).main(arguments)
    assert "is an input of this program" in capsys.readouterr().err + str(refusal.value)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize(("program", "option"), [("identify", "--output"), ("calibrate", "--out")])
def test_no_robot_is_driven_for_a_file_that_cannot_be_written(program, option, tmp_path, monkeypatch):
    main = module_of(program)
    monkeypatch.setattr(main, "running_settings", None)  # it is not reached
    monkeypatch.setattr("sys.argv", [f"{program}.py", option, str(tmp_path / "none" / "out.yaml")])
    with pytest.raises(SystemExit, match=r"folder .* not found"):
        main.main()
