"""record.py calls rosbag with these arguments; no ROS runs."""

import os
import re
import sys
from pathlib import Path

import pytest
from robot_control.data.record.main import TOPICS, main, namespace_of, record_command


def topics(*arguments: str, **environment: str) -> list[str]:
    return record_command(["/out", *arguments], environment)[2:]


@pytest.mark.parametrize(
    ("arguments", "environment", "namespace"),
    [
        ([], {}, "/"),
        (["__ns:=robot2"], {}, "/robot2/"),
        (["__ns:=/robot2/"], {}, "/robot2/"),
        ([], {"ROS_NAMESPACE": "fleet/robot2"}, "/fleet/robot2/"),
        (["__ns:=robot2"], {"ROS_NAMESPACE": "robot3"}, "/robot2/"),
    ],
)
def test_namespace_is_that_of_the_command_line_else_of_the_environment(
    arguments: list[str], environment: dict[str, str], namespace: str
) -> None:
    assert namespace_of(arguments, environment) == namespace


def test_names_are_absolute_and_all_there() -> None:
    assert set(topics()) == {"/" + topic.lstrip("/") for topic in TOPICS}
    assert {"/odom", "/tf", "/imu/data_raw", "/joint_states", "/cmd_vel_out", "/clock"} <= set(topics())


def test_every_topic_of_the_interface_table_is_recorded() -> None:
    page = (Path(__file__).parents[3] / "docs" / "interfaces.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (?:in|out|in, out) \| ([^|]*) \|", page, re.MULTILINE)
    table = {name for row in rows for name in re.findall(r"`([\w/]+)`", row)}
    assert len(table) > 30
    assert set(TOPICS) - table == {"tf", "/rosout"}
    assert table <= set(TOPICS)


def test_namespace_moves_what_belongs_to_the_robot_and_nothing_else() -> None:
    moved = set(topics("__ns:=robot2"))
    assert {"/robot2/odom", "/robot2/tf", "/robot2/imu/data_raw"} <= moved
    assert {topic for topic in moved if not topic.startswith("/robot2/")} == {"/diagnostics", "/clock", "/rosout"}


@pytest.mark.parametrize(
    ("arguments", "prefix"),
    [
        (["/out"], "/out/robot_control"),
        (["/out", "__name:=record", "__log:=/tmp/record.log"], "/out/robot_control"),
        (["__ns:=/fleet/robot2", "/out"], "/out/fleet/robot2/robot_control"),
    ],
)
def test_bag_lies_in_the_folder_of_the_namespace(arguments: list[str], prefix: str) -> None:
    recorder, output, *_ = record_command(arguments, {})
    assert (Path(recorder).parts[-2:], output) == (("rosbag", "record"), f"--output-prefix={prefix}")


@pytest.mark.parametrize("arguments", [[], ["__name:=record"], ["/out", "/other"], ["--nonsense"], ["-h"], ["--help"]])
def test_without_one_folder_the_usage_is_printed(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        record_command(arguments, {})
    assert "usage: record.py [-h] FOLDER" in "".join(capsys.readouterr())


def test_makes_the_folder_and_becomes_rosbag(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    commands = []
    monkeypatch.setattr(os, "execv", lambda _, command: commands.append(command))
    monkeypatch.setattr(sys, "argv", ["record.py", str(tmp_path / "not" / "there"), "__ns:=robot2"])
    main()
    assert (tmp_path / "not" / "there" / "robot2").is_dir()
    assert commands == [record_command([str(tmp_path / "not" / "there"), "__ns:=robot2"], {})]


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(sys, "argv", ["record.py", str(tmp_path / "file" / "out")])
    with pytest.raises(SystemExit, match="Not a directory") as ended:
        main()
    assert str(tmp_path / "file" / "out") in str(ended.value)
    assert "another folder" in str(ended.value)
