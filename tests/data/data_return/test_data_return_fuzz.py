"""Damaged copies of what data return reads from outside: each is used or refused, at once."""

import json

import pytest
from robot_control.data.data_return.fetch import _names
from robot_control.data.data_return.parts import MANIFEST, GapError, put_together
from robot_control.data.data_return.queue_file import QueueFile
from robot_control.data.data_return.remote import RemoteError, listed
from robot_control.data.data_return.settings import read_settings
from robot_control.files.kept_file import digest_of
from robot_control.settings.files import SettingsError
from support.data_return_system import DAY, WHOLE_BAG, System, use_small_parts, write
from support.mutants import mutants
from support.timed import timed

NUMBER = 2000
SETTINGS = """far_side: factory:robots
robot: amr-07
rclone_config: {0}/rclone.conf
bandwidth: 2.5
hours: [22:00-06:00]
metered: true
"""


@pytest.fixture(autouse=True)
def small_parts(monkeypatch):
    use_small_parts(monkeypatch)
    monkeypatch.setattr("os.fsync", lambda _: None)


def write_new(path, content):
    """A file that is written over is flushed by some file systems."""
    path.unlink(missing_ok=True)
    path.write_bytes(content)


def finished(tmp_path):
    """A robot whose files have returned, but for one."""
    system = System(tmp_path, {"run.1.bag": bytes(1500), "black_box/stop.1.bag": WHOLE_BAG})
    system.finish()
    write(tmp_path / "logs/run.2.bag", bytes(range(256)) * 30)
    system.step()
    for _ in range(6):
        system.step()
    return system


def manifests(tmp_path):
    """A manifest that is used at once puts a file together that is as long as it says."""
    system = finished(tmp_path)
    (folder,) = {name.removesuffix(MANIFEST) for name in system.far.content if "run.1" in name and MANIFEST in name}

    def take(mutant):
        files = {**system.far.content, folder + MANIFEST: mutant}
        try:
            return put_together(lambda name: files.get(folder + name, b""), None)["size"] == 1500
        except GapError as error:
            return bool(str(error))

    return take, system.far.content[folder + MANIFEST]


def listings(tmp_path):
    """A name that is used is one in the target."""
    files = [
        {"Path": f"r1/runs/x-run.{n}.bag/{name}", "Name": name, "Size": 1000, "Hashes": {"md5": "0f" * 16, "sha1": ""}}
        for n in range(5)
        for name in ("00000", "00001.gz", MANIFEST)
    ]

    def take(mutant):
        good = True
        for key in ("Name", "Path"):
            try:
                for path, file in listed(mutant, key).items():
                    file.holds(b"rows")
                    out = tmp_path.joinpath(*_names(path))
                    good = good and tmp_path in out.parents and ".." not in out.parts
            except (RemoteError, GapError):
                continue
        return good

    return take, json.dumps(files).encode()


def settings_files(tmp_path):
    path = tmp_path / "my.yaml"
    (tmp_path / "rclone.conf").touch(mode=0o600)
    path.write_text(SETTINGS.format(tmp_path))
    valid = path.read_bytes()
    assert read_settings(path).robot == "amr-07"

    def take(mutant):
        write_new(path, mutant)
        try:
            settings = read_settings(path)
            return settings.destination.startswith(settings.far_side) and settings.logs != settings.queue
        except (SettingsError, OSError) as error:
            return bool(str(error))

    return take, valid


def queues(tmp_path):
    """A queue that is used begins a sender; its next pass harms nothing."""
    system = finished(tmp_path)
    valid = system.queue.path.read_bytes().partition(b"\n")[2]
    logs = {path: path.read_bytes() for path in (tmp_path / "logs").rglob("*.bag")}

    def take(mutant):
        write_new(system.queue.path, f"{digest_of(mutant)}\n".encode() + mutant)
        queue = QueueFile(system.queue.folder)
        for each in queue.entries.values():
            assert each.target.count("/") == 1
        if sum(mutant) % 20 == 0:  # a pass takes longer than to read
            system.begin()
            system.sender.step(0.0, DAY, "")
        return all(path.read_bytes() == content for path, content in logs.items())

    return take, valid


FORMATS = [manifests, listings, settings_files, queues]


def fuzz(kind, tmp_path, number, seed):
    take, valid = kind(tmp_path)
    assert take(valid)
    for mutant in mutants(valid, number, seed):
        assert timed(take, mutant), mutant[:300]


@pytest.mark.parametrize("kind", FORMATS)
def test_a_damaged_copy_is_used_or_refused_at_once(tmp_path, kind):
    fuzz(kind, tmp_path, NUMBER, 1)


@pytest.mark.nightly
@pytest.mark.parametrize("kind", FORMATS)
def test_more_damaged_copies_are_used_or_refused_at_once(tmp_path, kind):
    fuzz(kind, tmp_path, 100_000, 2)
