"""Files that a user names: which are read, which are replaced, and how messages quote them."""

import os
import pwd
import re
import resource
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from robot_control import ClosedLoop, DriverError, Estimator, ParameterError, RobotError
from robot_control.files.files import (
    InputFileError,
    NewFiles,
    check_input,
    escaped_lines,
    file_error,
    fit_for_message,
    given_path,
    printable,
    write_text,
)
from robot_control.installed_files import share_file
from support.programs import module_of


def test_only_regular_files_up_to_a_size_are_read(tmp_path):
    (tmp_path / "file").write_bytes(b"12345")
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "link").symlink_to("/dev/zero")
    check_input(tmp_path / "file", 5)
    for path, said in (
        ("/dev/zero", "is a device"),
        (tmp_path / "fifo", "is a FIFO"),
        (tmp_path, "is a folder"),
        (tmp_path / "link", "is a device"),
    ):
        with pytest.raises(InputFileError, match=said):
            check_input(type(tmp_path)(path), 10**9)
    with pytest.raises(InputFileError, match="has 5 bytes; at most 4 are read"):
        check_input(tmp_path / "file", 4)


def test_a_path_counts_from_the_callers_folder_and_a_tilde_is_the_home(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert given_path("rel/x").absolute() == tmp_path / "rel/x"
    monkeypatch.setenv("ROBOT_CONTROL_CALLER_FOLDER", "/called/here")
    assert given_path("rel/x") == Path("/called/here/rel/x")
    assert given_path("/abs") == Path("/abs")
    monkeypatch.setenv("HOME", "/home/me")
    assert given_path("~/x") == Path("/home/me/x")
    monkeypatch.delenv("HOME")
    assert given_path("~/x") == Path(pwd.getpwuid(os.getuid()).pw_dir, "x")


def test_both_languages_say_what_was_given_what_it_became_and_why_it_does_not_open(tmp_path, monkeypatch):
    monkeypatch.setenv("ROBOT_CONTROL_CALLER_FOLDER", str(tmp_path))
    sentence = f"mine.urdf: file not found ({tmp_path}/mine.urdf)"
    assert file_error(given_path("mine.urdf"), "file not found") == sentence
    with pytest.raises(RobotError, match=re.escape(sentence)):
        ClosedLoop(urdf="mine.urdf")
    with pytest.raises(DriverError, match=re.escape(sentence.replace("urdf", "xml"))):
        ClosedLoop(scene="mine.xml")
    with pytest.raises(ParameterError, match=re.escape(sentence.replace("urdf", "csv"))):
        ClosedLoop({"robot": {"command_script": "mine.csv"}})
    with pytest.raises(ParameterError, match=re.escape(sentence.replace("urdf", "yaml"))):
        ClosedLoop(drives="mine.yaml")


FOREIGN = os.fsdecode(b"\xff")
"""a byte that no UTF-8 has, as Python reads it in a file's name"""


@pytest.mark.parametrize("kind", [str, os.fsencode, Path])
def test_a_name_that_is_not_utf8_is_refused_by_name(kind, tmp_path):
    shutil.copy(share_file("urdf/diffbot.urdf"), tmp_path / f"{FOREIGN}.urdf")
    name = kind(str(tmp_path / f"{FOREIGN}.urdf"))
    for call in (
        lambda: ClosedLoop(name),
        lambda: ClosedLoop(urdf=name),
        lambda: ClosedLoop(scene=name),
        lambda: ClosedLoop().log_into(name),
        lambda: Estimator(name),
        lambda: Estimator().save_calibration(name),
    ):
        with pytest.raises(InputFileError, match=r"\\udcff.urdf is not UTF-8"):
            call()


@pytest.mark.parametrize("values", [{"robot": {"urdf": FOREIGN}}, {FOREIGN: 1}, {FOREIGN: {"urdf": "a"}}])
def test_a_parameter_that_is_not_utf8_is_refused(values):
    with pytest.raises(InputFileError, match="is not UTF-8"):
        ClosedLoop(values)


@pytest.mark.parametrize(
    ("program", "arguments"),
    [
        ("inspect", ["%.urdf"]),
        ("inspect", ["--params", "%.yaml", share_file("urdf/diffbot.urdf")]),
        ("estimate", ["%.bag"]),
        ("report", ["%.bag"]),
        ("export", ["%.bag", "--csv", "out.csv"]),
        ("replay", ["%.bag"]),
    ],
)
def test_a_program_refuses_such_a_name_in_one_line(program, arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path(f"{FOREIGN}.bag").write_text("#ROSBAG V2.0\n")
    main = module_of(program).main
    with pytest.raises(SystemExit) as refusal:
        main([argument.replace("%", FOREIGN) for argument in arguments])
    said = capsys.readouterr().err.rstrip() or str(refusal.value)
    assert re.search(r"udcff\.(urdf|yaml|bag) is not UTF-8", said)
    assert "\n" not in said


def test_lines_of_a_report_show_what_does_not_print_and_a_name_begins_no_line():
    assert escaped_lines(["a robot\nexact\x1b[2J", "·"]) == "a robot\\nexact\\x1b[2J\n·"


def test_a_message_repeats_no_control_character_and_no_long_input():
    assert printable("a\0b\x1b[2J·") == r"a\x00b\x1b[2J·"
    assert printable("x" * 201) == "x" * 200 + "…"
    assert fit_for_message(f"no {'n' * 10**6} here") == f"no {'n' * 200}… here"
    assert len(fit_for_message('joint "' + "word " * 10**5 + '" is absent')) < 230
    assert len(fit_for_message("word " * 10**5)) < 1800
    assert fit_for_message("one\ntwo\0") == "one\ntwo\\x00"


def test_a_file_is_replaced_with_its_mode_and_owner(tmp_path):
    path = tmp_path / "file"
    path.write_text("old")
    path.chmod(0o640)
    if os.geteuid() == 0:
        os.chown(path, 12345, 23456)
    before = path.stat()
    write_text(path, "new")
    after = path.stat()
    assert path.read_text() == "new"
    assert (after.st_mode, after.st_uid, after.st_gid) == (before.st_mode, before.st_uid, before.st_gid)
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_stays_and_what_it_leads_to_is_written(tmp_path):
    (tmp_path / "target").write_text("old")
    (tmp_path / "link").symlink_to("target")
    (tmp_path / "dangling").symlink_to("fresh")
    write_text(tmp_path / "link", "new")
    write_text(tmp_path / "dangling", "made")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "dangling").is_symlink()
    assert (tmp_path / "target").read_text() == "new"
    assert (tmp_path / "fresh").read_text() == "made"


def test_a_fifo_is_written_to_and_stays(tmp_path):
    os.mkfifo(tmp_path / "fifo")
    reader = os.open(tmp_path / "fifo", os.O_RDONLY | os.O_NONBLOCK)
    write_text(tmp_path / "fifo", "text")
    assert os.read(reader, 10) == b"text"
    os.close(reader)
    assert stat.S_ISFIFO((tmp_path / "fifo").stat().st_mode)


def test_a_device_is_written_to_and_stays(tmp_path):
    node = tmp_path / "null"
    try:
        os.mknod(node, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
        node.open("wb").close()
    except PermissionError:
        pytest.skip("devices are not granted")
    write_text(node, "text")
    assert stat.S_ISCHR(node.stat().st_mode)


def test_nothing_is_replaced_when_the_block_fails(tmp_path):
    (tmp_path / "file").write_text("old")
    with pytest.raises(ZeroDivisionError), NewFiles() as files:
        files.name(tmp_path / "file").write_text("new")
        raise ZeroDivisionError
    assert (tmp_path / "file").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_pipe_is_written_to_by_its_name_in_dev():
    reader, writer = os.pipe()
    write_text(Path(f"/dev/fd/{writer}"), "text")
    assert os.read(reader, 10) == b"text"
    os.close(reader)
    os.close(writer)


def test_an_error_names_the_file_that_the_user_named(tmp_path):
    with pytest.raises(OSError, match="full") as full, NewFiles() as files:
        files.name(tmp_path / "file")
        raise OSError(28, "the disk is full")  # as a write does, without a name
    assert full.value.filename == str(tmp_path / "file")
    with pytest.raises(FileNotFoundError) as absent:
        write_text(tmp_path / "none" / "file", "text")
    assert absent.value.filename == str(tmp_path / "none" / "file"), "not the temporary file's"
    with pytest.raises(FileNotFoundError) as other, NewFiles() as files:
        files.name(tmp_path / "file")
        (tmp_path / "input").read_text()
    assert other.value.filename == str(tmp_path / "input")


def test_the_limit_on_file_sizes_is_a_full_disk(tmp_path):
    (tmp_path / "file").write_text("old")
    program = "import pathlib, robot_control.files.files as files; files.write_text(pathlib.Path('file'), 'x' * 9999)"
    ended = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)),
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
        check=False,
    )
    assert "OSError: [Errno 27] File too large" in ended.stderr
    assert (tmp_path / "file").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 1
