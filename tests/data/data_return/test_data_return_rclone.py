"""The return of data through rclone: whole over SFTP and WebDAV, and one message for each bad set-up."""

import os
import random
import subprocess
import time

import pytest
from robot_control.data.data_return.fetch import verify
from robot_control.data.data_return.queue_file import QueueFile
from robot_control.data.data_return.remote import InterruptedCallError, Remote, reason
from robot_control.data.data_return.sender import Sender
from robot_control.data.data_return.settings import Settings

from bench.console.process import program
from bench.data_return.server import KINDS, Server, configuration, missing

pytestmark = pytest.mark.skipif(bool(missing()), reason=missing())
SIZE = 5_000_000  # bytes: two parts


class System:
    def __init__(self, tmp_path, kind="sftp", *options, prefix=(), password=None, tls=False, **values):
        self.logs = tmp_path / "logs"
        self.logs.mkdir()
        self.content = random.Random(1).randbytes(SIZE)
        (self.logs / "run.1.bag").write_bytes(self.content)
        os.utime(self.logs / "run.1.bag", (1e9, 1e9))
        self.server = Server(kind, tmp_path / "far", *options, prefix=prefix)
        given = {"password": password} if password else {}
        self.config = configuration(tmp_path / "rclone.conf", kind, self.server.port, tls=tls, **given)
        self.settings = Settings(
            far_side="far:robots",
            robot="r1",
            rclone_config=str(self.config),
            folder=str(self.logs),
            queue_folder=str(tmp_path),
            **values,
        )
        self.reason_to_wait = ""
        self.said = []
        self.queue = QueueFile(tmp_path)
        self.sender = Sender(
            self.settings, self.queue, Remote(self.settings, lambda: self.reason_to_wait), self.said.append
        )

    def step(self, now):
        return self.sender.step(now, time.time(), "")


@pytest.fixture
def systems(tmp_path):
    made = []

    def make(*given, **named):
        made.append(System(tmp_path, *given, **named))
        return made[-1]

    yield make
    for each in made:
        each.server.kill()


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_comes_home(systems, tmp_path, kind):
    system = systems(kind)
    for now in range(3):
        system.step(now)
    assert system.said == []
    assert system.sender.progress == "all 1 files are on the far side"
    assert verify("far:robots", str(system.config), tmp_path / "out")
    (path,) = (tmp_path / "out").rglob("*run.1.bag")
    assert path.read_bytes() == system.content
    assert path.stat().st_mtime == 1e9
    (part,) = (tmp_path / "far").rglob("00001")
    part.write_bytes(bytes(part.stat().st_size))
    assert not verify("far:robots", str(system.config), None)
    assert not verify(str(tmp_path / "far"), "", None)


@pytest.mark.parametrize("kind", KINDS)
def test_a_part_that_is_there_is_not_sent_again_and_a_damaged_one_is(systems, tmp_path, kind):
    system = systems(kind)
    system.step(0.0)
    system.queue.entries.clear()
    system.queue.save()
    (part,) = (tmp_path / "far").rglob("00001")
    part.write_bytes(bytes(part.stat().st_size))
    others = next((tmp_path / "far").rglob("00000")).stat()
    for now in range(10, 30, 5):
        system.step(now)
    assert system.sender.progress == "all 1 files are on the far side"
    assert verify("far:robots", str(system.config), None)
    assert next((tmp_path / "far").rglob("00000")).stat().st_ctime_ns == others.st_ctime_ns


def test_what_is_being_sent_ends_when_nothing_may_be_sent(systems):
    system = systems(bandwidth=0.1)
    far = Remote(system.settings, lambda: "only at rest")
    began = time.monotonic()
    with pytest.raises(InterruptedCallError, match="only at rest"):
        far.put(system.logs, "x")
    assert time.monotonic() - began < 10.0


def said_once(system, words):
    """Three tries, one message; nothing is lost here."""
    for now in (0.0, 100.0, 500.0):
        assert not system.step(now)
    assert len(system.said) == 1, system.said
    assert words in system.said[0]
    assert words in system.sender.progress
    assert (system.logs / "run.1.bag").read_bytes() == system.content


@pytest.mark.parametrize("kind", KINDS)
def test_a_wrong_password(systems, kind):
    said_once(systems(kind, password="wrong"), "far:robots/r1: it refuses user or password: rclone config")


@pytest.mark.parametrize("kind", KINDS)
def test_a_far_side_that_does_not_answer(systems, kind):
    system = systems(kind)
    system.server.kill()
    said_once(system, "it does not answer")


def openssl(folder, *words):
    subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True)


@pytest.mark.parametrize(
    ("days", "trusted", "words"),
    [("-1", True, "its certificate has expired: renew it there"), ("2", False, "is not trusted: set ca_file")],
)
def test_a_certificate_that_is_expired_or_not_trusted(systems, tmp_path, days, trusted, words):
    key = ("-newkey", "rsa:2048", "-nodes")
    openssl(tmp_path, "req", "-x509", *key, "-keyout", "ca.key", "-out", "ca.pem", "-subj", "/CN=ca", "-days", "2")
    openssl(tmp_path, "req", *key, "-keyout", "key.pem", "-out", "request", "-subj", "/CN=far")
    (tmp_path / "names").write_text("subjectAltName=IP:127.0.0.1\n")
    signed = ("x509", "-req", "-in", "request", "-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial")
    openssl(tmp_path, *signed, "-out", "cert.pem", "-days", days, "-extfile", "names")
    options = ("--cert", str(tmp_path / "cert.pem"), "--key", str(tmp_path / "key.pem"))
    ca = {"ca_file": str(tmp_path / "ca.pem")} if trusted else {}
    said_once(systems("webdav", *options, tls=True, **ca), words)


@pytest.mark.parametrize("kind", KINDS)
def test_a_full_far_side(systems, tmp_path, kind):
    (tmp_path / "far").mkdir()
    small = ("unshare", "--mount", "sh", "-c", f'mount -t tmpfs -o size=1m tmpfs {tmp_path}/far && exec "$@"', "sh")
    if subprocess.run([*small, "true"], check=False, capture_output=True).returncode:
        pytest.skip("mounting is not granted")
    said_once(systems(kind, prefix=small), "it cannot write; check its disk space")


def test_a_full_local_disk(systems, monkeypatch):
    system = systems()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_bytes", full)
    said_once(system, "parts: cannot be written: no space left on the disk")


def test_a_remote_that_is_not_configured(systems):
    system = systems()
    system.config.write_text("[other]\ntype = local\n")
    said_once(system, "this remote is not in rclone's configuration")


@pytest.mark.parametrize(
    ("text", "path", "words"),
    [
        ("far_side: /far", "", "needs Debian's rclone: scripts/setup --data-return"),
        ("far_side: /far\nqueue_folder: /sys/data_return", None, "/sys/data_return: "),
        ("far_side: ''", None, "far_side is empty"),
    ],
    ids=["missing rclone", "read-only queue", "no far side"],
)
def test_what_ends_the_program_is_one_message(tmp_path, text, path, words):
    (tmp_path / "my.yaml").write_text(text)
    environment = {**os.environ, **({} if path is None else {"PATH": path})}
    command = ["/usr/bin/python3", program("data_return.py"), "run", "--config", tmp_path / "my.yaml"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, timeout=60)
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert words in done.stderr


def test_an_unknown_failure_is_repeated_in_one_line():
    assert reason("2026/11/26 22:00:30 ERROR : a\x1b\n2026/11/26 22:00:30 Failed to copy\n") == "rclone: Failed to copy"
    assert reason("") == "rclone failed"
