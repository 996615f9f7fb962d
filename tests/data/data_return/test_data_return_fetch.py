"""fetch and verify: names and manifests from outside, through rclone and from a folder; passwords in messages."""

import hashlib
import json
import os
import stat
import subprocess
import time
from pathlib import Path

import pytest
from robot_control.data.data_return.fetch import verify
from robot_control.data.data_return.parts import MANIFEST, MAX_FILE, GapError, put_together
from robot_control.data.data_return.queue_file import QueueFile
from robot_control.data.data_return.remote import Remote, RemoteError, listed
from robot_control.data.data_return.sender import Sender
from robot_control.data.data_return.settings import Settings, read_settings, redacted
from robot_control.settings.files import SettingsError
from support.data_return_system import DAY, WHOLE_BAG, write

from bench.console.process import program
from bench.data_return.server import PASSWORD, Server, missing

needs_rclone = pytest.mark.skipif(bool(missing()), reason=missing())


def manifest_of(contents, **changed):
    parts = [
        {"name": f"{number:05d}", "size": len(data), "sha256": hashlib.sha256(data).hexdigest()}
        for number, data in enumerate(contents)
    ]
    whole = {"format": 1, "name": "run.1.bag", "size": sum(map(len, contents)), "mtime_ns": 10**18, "part_size": 1000}
    return json.dumps({**whole, "parts": parts, **changed}).encode()


def put_folder(folder, content=b"rows"):
    write(folder / "00000", content)
    write(folder / MANIFEST, manifest_of([content]))


@pytest.fixture
def local_remote(tmp_path):
    """rclone's view of a folder, as of a far side."""
    config = tmp_path / "rclone.conf"
    config.touch(mode=0o600)
    config.write_text("[far]\ntype = local\n")
    (tmp_path / "far").mkdir()
    return f"far:{tmp_path}/far", str(config)


# ---- names


HOSTILE = ("\u2028", "\x85", "\x1c", "\r", "\n", "\x0b", " ", "-v", "...", "a:b", "*", "%2e%2e")


@needs_rclone
@pytest.mark.parametrize("through", ["rclone", "folder"])
def test_a_folder_of_any_name_is_put_together_inside_the_target(tmp_path, local_remote, through, capsys):
    """U+2028 and its like end a line of str.splitlines: what stood behind them was a path of its own."""
    elsewhere = tmp_path / "elsewhere"
    for name in HOSTILE:
        put_folder(tmp_path / f"far/x{name}" / str(elsewhere).lstrip("/"))
        put_folder(tmp_path / "far" / name / "y")
    source, config = (str(tmp_path / "far"), "") if through == "folder" else local_remote
    assert verify(source, config, tmp_path / "out")
    assert not elsewhere.exists()
    written = {path.relative_to(tmp_path / "out") for path in (tmp_path / "out").rglob("*") if path.is_file()}
    sent = {path.parent.relative_to(tmp_path / "far") for path in (tmp_path / "far").rglob(MANIFEST)}
    assert len(written) == 2 * len(HOSTILE)
    assert through == "rclone" or written == sent  # rclone gives control characters as pictures of them
    assert all(line.isprintable() for line in capsys.readouterr().out.split("\n"))


@pytest.mark.parametrize("folder", ["../x", "/x", "a/../../x", "a//x", "a/./x", "a\0b", "a\ud800b", ".."])
def test_a_name_that_is_none_is_a_gap_and_writes_nothing(tmp_path, monkeypatch, capsys, folder):
    """As a remote may list it, or a rclone that was replaced."""
    answer = json.dumps([{"Path": f"{each}/{MANIFEST}", "Size": 3} for each in (folder, "good")]).encode()

    def run(_remote, *words, **_):
        if words[0] == "copy":
            assert words[-2].endswith(":good")
            put_folder(Path(words[-1]))
        return answer

    monkeypatch.setattr(Remote, "_rclone", run)
    monkeypatch.setattr("robot_control.data.data_return.fetch.require_rclone", lambda: None)
    assert not verify("far:", "", tmp_path / "target/out")
    assert [path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()] == [Path("target/out/good")]
    assert "its path has an invalid part" in capsys.readouterr().out


@needs_rclone
@pytest.mark.parametrize("through", ["rclone", "folder"])
def test_one_folder_that_fails_ends_nothing(tmp_path, local_remote, through, capsys):
    far = tmp_path / "far"
    for name in ("a", "a/b", "c", "d", "e"):
        put_folder(far / name)
    (far / "c/00000").unlink()
    (far / "c/00000").mkdir()
    (far / "d/00000").write_bytes(bytes(100))
    source, config = (str(far), "") if through == "folder" else local_remote
    assert not verify(source, config, tmp_path / "out")
    assert (tmp_path / "out/e").read_bytes() == b"rows"
    said = capsys.readouterr().out
    assert "gap:   a/b: " in said  # a file stands where its folder had to be
    assert said.endswith("2 files are complete, 3 are not\n")


@needs_rclone
def test_a_folder_of_one_file_can_be_fetched_by_itself(tmp_path, local_remote):
    put_folder(tmp_path / "far/r1/runs/x-run.1.bag")
    source, config = local_remote
    assert verify(f"{source}/r1/runs/x-run.1.bag", config, tmp_path / "out")
    assert (tmp_path / "out/x-run.1.bag").read_bytes() == b"rows"


@pytest.mark.parametrize("kind", ["fifo", "link", "long"])
def test_a_part_that_is_no_plain_file_is_a_gap(tmp_path, capsys, kind):
    far = tmp_path / "far/r1"
    put_folder(far)
    (far / "00000").unlink()
    if kind == "fifo":
        os.mkfifo(far / "00000")
    elif kind == "link":
        (far / "00000").symlink_to("/etc/hostname")
    else:
        with (far / "00000").open("wb") as file:
            file.truncate(1 << 40)
    assert not verify(str(tmp_path / "far"), "", tmp_path / "out")
    assert "0 files are complete, 1 are not" in capsys.readouterr().out


@needs_rclone
def test_a_file_longer_than_a_part_may_be_is_not_copied(tmp_path, local_remote, monkeypatch):
    put_folder(tmp_path / "far/r1")
    with (tmp_path / "far/r1/00000").open("wb") as file:
        file.truncate(1 << 40)
    began = time.monotonic()
    assert not verify(*local_remote, None)
    assert time.monotonic() - began < 30.0


# ---- what a part may unpack to


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"part_size": 1 << 30}, "part_size is 1073741824, and must be from 1 to"),
        ({"size": 5}, "holds more than 5 bytes"),
        ({"size": 2001}, "the parts hold 1000 of 2001 bytes"),
        ({"parts": []}, "lists no part"),
        ({"parts": [{"name": "00000", "size": 1 << 40, "sha256": ""}]}, "must have from 0 to"),
        ({"parts": [{"name": "00000", "size": -1, "sha256": ""}]}, "must have from 0 to"),
        ({"parts": [{"name": "00000", "size": True, "sha256": ""}]}, "cut off or damaged"),
        ({"parts": {"0": 1}}, "cut off or damaged"),
        ({"format": 2}, "another format"),
    ],
    ids=str,
)
def test_a_manifest_bounds_what_is_unpacked(changed, words):
    data = bytes(1000)
    with pytest.raises(GapError, match=words):
        put_together(lambda name: manifest_of([data], **changed) if name == MANIFEST else data, None)


def test_a_part_of_zeros_that_unpacks_to_a_gibibyte_takes_no_memory():
    import gzip
    import resource

    data = gzip.compress(bytes(1 << 28), compresslevel=9)
    part = {"name": "00000.gz", "size": len(data), "sha256": hashlib.sha256(data).hexdigest()}
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    content = manifest_of([], size=MAX_FILE, part_size=MAX_FILE, parts=[part])
    with pytest.raises(GapError, match="holds more than"):
        put_together(lambda name: content if name == MANIFEST else data, None)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000  # kB


NO_LISTS = (
    *(b"", b"3", b"[1]", b"[" * 100_000),
    *(b'[{"Name": 1, "Size": 1}]', b'[{"Name": "a", "Size": 1e9}]', b'[{"Name": "a"}]'),
    *(b'[{"Name": "a", "Size": 1, "Hashes": 3}]', b'[{"Name": "a", "Size": 1, "Hashes": {"md5": 3}}]'),
)


@pytest.mark.parametrize("answer", NO_LISTS, ids=range(len(NO_LISTS)))
def test_an_answer_of_rclone_that_is_no_list_is_an_error(answer):
    with pytest.raises(RemoteError, match="no list of files"):
        listed(answer)


# ---- settings, and passwords


@pytest.mark.parametrize("robot", ["..", ".", ".hidden", "a/b", "a b", "", "x" * 65])
def test_the_name_of_a_robot_is_that_of_a_folder(tmp_path, robot, monkeypatch):
    monkeypatch.setattr("socket.gethostname", lambda: "..")
    (tmp_path / "my.yaml").write_text(f"far_side: /far\nrobot: '{robot}'")
    with pytest.raises(SettingsError, match=r"robot = .*: must be of letters, digits and _ \. -, at most 64"):
        read_settings(tmp_path / "my.yaml")


SECRET = "s3cr3t"


@pytest.mark.parametrize(
    ("place", "shown"),
    [
        (f":sftp,host=h,user=u,pass={SECRET}:robots", ":sftp,…"),
        (f'far,pass="{SECRET}:x":robots', "far,…"),
        (f":webdav,url='https://u:{SECRET}@h/dav',vendor=other:robots", ":webdav,…"),
        (f"https://u:{SECRET}@h/dav", "https://…"),
        ("factory:robots", "factory:robots"),
        ("/mnt/a,b", "/mnt/a,b"),
    ],
)
def test_a_place_is_shown_without_its_passwords(place, shown):
    assert redacted(place) == shown


@pytest.mark.parametrize(
    "text",
    [
        f'far_side: ":sftp,pass={SECRET}:x"\nbandwidth: fast',
        f'far_side: "-:sftp,pass={SECRET}:x"',
        f'far_side: [":sftp,pass={SECRET}:x"]',
        f'far_side: ":sftp,pass={SECRET}:x',
        f'bandwidth: ":sftp,pass={SECRET}:x"',
        f'":sftp,pass={SECRET}:x": 3',
        f'far_side: ":sftp,pass={SECRET}:x\\0"',
    ],
)
def test_no_error_of_the_settings_repeats_a_password(tmp_path, text):
    (tmp_path / "my.yaml").write_text(text)
    with pytest.raises(SettingsError) as error:
        read_settings(tmp_path / "my.yaml")
    assert SECRET not in str(error.value)


def shim(folder):
    """A rclone that notes its command lines."""
    real = subprocess.run(["which", "rclone"], capture_output=True, text=True, check=True).stdout.strip()
    (folder / "bin").mkdir()
    script = folder / "bin/rclone"
    script.write_text(f'#!/bin/sh\necho "$@" >> {folder}/words\nexec {real} "$@"\n')
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    return f"{folder}/bin:{os.environ['PATH']}"


@needs_rclone
def test_a_connection_string_works_and_its_password_is_seen_nowhere(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PATH", shim(tmp_path))
    hidden = subprocess.run(["rclone", "obscure", PASSWORD], capture_output=True, text=True, check=True).stdout.strip()
    (tmp_path / "words").unlink()
    server = Server("sftp", tmp_path / "far")
    try:
        write(tmp_path / "logs/run.1.bag", WHOLE_BAG)
        where = f":sftp,host=127.0.0.1,port={server.port},user=robot,pass={hidden}:robots"
        no_config = str(tmp_path / "no")
        settings = Settings(far_side=where, robot="r1", folder=str(tmp_path / "logs"), rclone_config=no_config)
        said = []
        (tmp_path / "queue").mkdir()
        sender = Sender(settings, QueueFile(tmp_path / "queue"), Remote(settings), said.append)
        for now in range(0, 30, 10):
            sender.step(now, DAY, "")
        assert said == []
        assert sender.progress == "all 1 files are on the far side"
        assert verify(where, no_config, tmp_path / "out")
    finally:
        server.kill()
    write(tmp_path / "logs/run.2.bag", WHOLE_BAG + b"x")
    sender.step(100.0, DAY, "")
    with pytest.raises(RemoteError, match=r":sftp,…: it does not answer"):
        verify(where, no_config, None)
    with pytest.raises(RemoteError, match=r":nosuch,…: rclone failed"):
        verify(f":nosuch,pass={hidden}:x", no_config, None)
    texts = [
        *said,
        sender.problem,
        sender.progress,
        capsys.readouterr().out,
        (tmp_path / "queue/queue.json").read_text(),
    ]
    assert ":sftp,…/r1: it does not answer" in said[0] or ":sftp,…: it does not answer" in said[0]
    words = (tmp_path / "words").read_text().replace("serve", "")
    assert hidden not in words.split("--pass", 1)[-1]
    assert not any(hidden in each for each in texts)


@needs_rclone
def test_the_program_says_no_password(tmp_path):
    (tmp_path / "my.yaml").write_text(f'far_side: ":sftp,host=127.0.0.1,pass={SECRET}:x"\nrobot: ".."\n')
    command = ["/usr/bin/python3", program("data_return.py"), "run", "--config", tmp_path / "my.yaml"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 1
    assert SECRET not in done.stdout + done.stderr
