"""blackbox.py finds a black box and refuses others. tests/losses/black_box_test.cpp tests that it reads one."""

import os
from pathlib import Path

import pytest
from robot_control.data.black_box import incidents_of, ring_of
from robot_control.data.blackbox.main import main


def make_ring(path: Path) -> Path:
    path.mkdir(parents=True)
    (path / "0.bag").write_bytes(b"x" * 100)
    return path


def test_the_ring_of_a_folder_of_logs_comes_before_the_one_of_the_telemetry_before(tmp_path):
    folder = tmp_path / "black_box"
    make_ring(folder / "ring.before")
    assert ring_of(tmp_path) == ring_of(folder) == folder / "ring.before"
    make_ring(folder / "ring")
    assert ring_of(tmp_path) == ring_of(folder) == folder / "ring"
    assert ring_of(folder / "ring.before") == folder / "ring.before"


def test_what_telemetry_saved_by_itself_is_named_the_newest_last(tmp_path, capsys):
    folder = tmp_path / "black_box"
    folder.mkdir()
    for age, name in enumerate(["stop.10.bag", "crash.2.bag", "stop.9.bag"]):
        (folder / name).touch()
        os.utime(folder / name, (1000 - age, 1000 - age))
    for name in ("run.bag", "stop.x.bag"):
        (folder / name).touch()
    make_ring(folder / "crash.3.ring")
    expected = [folder / name for name in ("stop.9.bag", "crash.2.bag", "stop.10.bag")]
    assert incidents_of(tmp_path) == incidents_of(folder) == incidents_of(make_ring(folder / "ring")) == expected
    (folder / "ring" / "0.bag").unlink()
    (folder / "ring").rmdir()
    with pytest.raises(SystemExit, match=r"no black box in .*\nsaved before: .*stop.9.bag"):
        main([str(tmp_path)])


def test_a_folder_that_cannot_be_read_hides_no_message(tmp_path, monkeypatch):
    (tmp_path / "ring").write_bytes(b"x" * 100)
    monkeypatch.setattr(Path, "iterdir", lambda _: (_ for _ in ()).throw(PermissionError(13, "denied")))
    with pytest.raises(SystemExit, match="ring: is not a black box of this version"):
        main([str(tmp_path / "ring"), "--out", str(tmp_path / "out")])


def test_refusals_name_the_folder(tmp_path):
    with pytest.raises(SystemExit, match="no black box in"):
        main([str(tmp_path)])
    ring = make_ring(tmp_path / "ring")
    with pytest.raises(SystemExit, match=r"ring holds no record that is whole: .*bags that cannot be read: 1 of 1"):
        main([str(tmp_path), "--out", str(tmp_path / "out")])
    (ring / "0.bag").unlink()
    with pytest.raises(SystemExit, match="ring: is not a black box of this version"):
        main([str(tmp_path), "--out", str(tmp_path / "out")])
    (tmp_path / "run.bag").touch()
    with pytest.raises(SystemExit, match=r"run\.bag.* exists"):
        main([str(tmp_path), "--out", str(tmp_path)])
