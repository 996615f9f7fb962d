"""The return of data in virtual time: the queue outlives a loss of power, nothing is lost, little is sent twice."""

import os
import random
import re
from datetime import datetime
from itertools import pairwise
from pathlib import Path

import pytest
from robot_control.data.data_return import parts, plan
from robot_control.data.data_return.fetch import verify
from robot_control.data.data_return.main import _print_status
from robot_control.data.data_return.node import default_interfaces
from robot_control.data.data_return.parts import (
    MANIFEST,
    GapError,
    manifest,
    opened,
    packed,
    put_together,
    read_manifest,
)
from robot_control.data.data_return.plan import Entry, Part, deletable, next_entry, reason_to_wait
from robot_control.data.data_return.queue_file import QueueError, QueueFile
from robot_control.data.data_return.settings import Settings, read_settings
from robot_control.files import files as common_files
from robot_control.files.files import write_durably
from robot_control.files.kept_file import digest_of
from robot_control.settings.files import SettingsError
from support.data_return_system import (
    DAY,
    OPEN_BAG,
    PART,
    WHOLE_BAG,
    System,
    check_nothing_is_lost,
    use_small_parts,
    write,
)
from support.virtual_disk import VirtualDisk

from bench.data_return.virtual_remote import PowerLoss, VirtualRemote


@pytest.fixture(autouse=True)
def small_parts(monkeypatch):
    use_small_parts(monkeypatch)


def entry(name, kind="runs", at=0, size=10, **fields):
    return Entry(name, name, kind, size, at, f"{kind}/{name}", **fields)


# ---- what is sent, when, and what is deleted


def test_incidents_go_before_reports_and_runs_and_what_was_begun_before_the_oldest():
    begun = entry("c", at=3, parts={0: Part("00000", 1, "")})
    entries = [entry("a", at=1), begun, entry("r", "reports", at=9), entry("i", "incidents", at=9)]
    order = []
    while (chosen := next_entry(entries)) is not None:
        order.append(chosen.path)
        chosen.returned = True
    assert order == ["i", "r", "c", "a"]


def test_the_oldest_that_has_returned_is_deleted_and_only_beyond_the_quota():
    entries = [entry(str(at), at=at, size=10, returned=at != 0) for at in range(5)]
    assert deletable(entries, 50 / plan.GB) == []
    assert [each.path for each in deletable(entries, 35 / plan.GB)] == ["1", "2"]
    assert [each.path for each in deletable(entries, 1 / plan.GB)] == ["1", "2", "3", "4"]
    assert deletable(entries, 0) == []
    assert deletable([entry("run.bag", returned=True)], 1 / plan.GB) == []


NIGHT = Settings(hours=("22:00-06:00", "12:00-13:00"))
AT_REST = Settings(only_at_rest=True)
CHEAP = Settings(metered_interfaces=("wwan*", "ppp*"))


@pytest.mark.parametrize(
    ("settings", "given", "words"),
    [
        (NIGHT, {"now": datetime(2026, 1, 1, 23, 0)}, ""),
        (NIGHT, {"now": datetime(2026, 1, 1, 5, 59)}, ""),
        (NIGHT, {"now": datetime(2026, 1, 1, 12, 0)}, ""),
        (NIGHT, {"now": datetime(2026, 1, 1, 6, 0)}, "outside of hours (22:00-06:00, 12:00-13:00)"),
        (AT_REST, {"mode": "idle"}, ""),
        (AT_REST, {"mode": "stopped"}, ""),
        (AT_REST, {"mode": "automatic"}, "only at rest, and the robot is commanded (automatic)"),
        (AT_REST, {"mode": ""}, "robot_status is silent"),
        (CHEAP, {"interfaces": ["wlan0"]}, ""),
        (CHEAP, {"interfaces": ["wlan0", "wwan1"]}, "the link wwan1 is metered"),
        (Settings(metered=True, metered_interfaces=("wwan*",)), {"interfaces": ["wwan1"]}, ""),
    ],
)
def test_it_waits_for_hours_rest_and_a_link_that_costs_nothing(settings, given, words):
    assert reason_to_wait(settings, **{"now": datetime(2026, 1, 1), **given}) == words


def test_default_routes_are_read(tmp_path):
    head = "Iface Destination Gateway Flags RefCnt Use Metric Mask MTU Window IRTT\n"
    (tmp_path / "route").write_text(head + "wwan0 00000000 0101A8C0 3\nwlan0 0001A8C0 00000000 1\n")
    assert default_interfaces(tmp_path / "route") == ["wwan0"]
    assert default_interfaces(tmp_path / "none") == []


# ---- the queue's file


def test_a_loss_of_power_at_any_call_leaves_the_old_or_the_new_content(monkeypatch):
    old, new = b"old content", "new content, which is longer"
    losses = 0
    for lost_at in range(100):
        disk = VirtualDisk("queue.json", old, lost_at)
        monkeypatch.setattr(common_files, "os", disk)
        try:
            write_durably(Path("/queue.json"), new)
        except PowerLoss:
            losses += 1
            assert set(disk.states("queue.json")) <= {old, new.encode()}
            continue
        assert set(disk.states("queue.json")) == {new.encode()}
        break
    assert losses > 5


@pytest.mark.parametrize("left_out", ["fsync", "replace"])
def test_the_disk_of_that_test_notices_what_is_missing(monkeypatch, left_out):
    """Without a flush of the content or of the folder, or without the rename, that test fails."""
    disk = VirtualDisk("queue.json", b"old", 100)
    monkeypatch.setattr(disk, left_out, lambda *_: None)
    monkeypatch.setattr(common_files, "os", disk)
    write_durably(Path("/queue.json"), "new")
    assert set(disk.states("queue.json")) != {b"new"}


def test_an_error_of_the_disk_names_the_file_and_leaves_the_old_content(tmp_path, monkeypatch):
    path = tmp_path / "queue.json"
    write_durably(path, "old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(common_files.os, "write", full)
    with pytest.raises(OSError, match=r"queue\.json"):
        write_durably(path, "new")
    assert path.read_text() == "old"


KNOWN = '{"key": "1-10-1", "path": "a", "kind": "runs", "size": 10, "mtime_ns": 1, "target": %s, "parts": %s, %s}'


@pytest.mark.parametrize(
    "text",
    [
        "",
        '{"files": []}',
        '[{"key": 1}]',
        "3",
        f"[{KNOWN}]" % ('"runs/../../r2"', "{}", '"returned": true'),
        f"[{KNOWN}]" % ('"runs/a"', "{}", '"returned": 1'),
        f"[{KNOWN}]" % ('"runs/a"', "{}", '"returned": true, "size": 1e300'),
        f"[{KNOWN}]" % ('"runs/a"', '{"7": {"name": "00007", "size": 1, "sha256": ""}}', '"returned": true'),
        f"[{KNOWN}]" % ('"runs/a"', '{"0": {"name": "../0", "size": 1, "sha256": ""}}', '"returned": true'),
    ],
    ids=["empty", "before", "key", "no list", "target", "type", "size", "number", "name"],
)
def test_a_file_that_is_no_queue_is_put_aside_and_all_is_compared_again(tmp_path, text):
    system = System(tmp_path, {"run.1.bag": b"x" * 10})
    system.finish()
    received = system.far.received
    digest = f"{digest_of(text.encode())}\n" if text.startswith(("[", "3")) else ""
    system.queue.path.write_text(text := digest + text)
    with pytest.raises(QueueError, match="is not a queue"):
        _print_status(QueueFile(system.queue.folder))
    assert system.queue.path.read_text() == text
    system.begin()
    assert "is not a queue" in system.queue.damage
    system.queue.lock()
    assert (system.queue.folder / "queue.json.damaged").read_text() == text
    system.finish()
    assert system.far.received == received
    system.verify_far_side()


def test_one_program_uses_a_queue(tmp_path):
    first = QueueFile(tmp_path)
    first.lock()
    with pytest.raises(QueueError, match="another data_return"):
        QueueFile(tmp_path).lock()


# ---- what is finished


def opened_file(path):
    return opened(path, plan.identity(path.stat()))


def found(tmp_path, day=DAY):
    queue = QueueFile(tmp_path / "queue")
    queue.folder.mkdir(exist_ok=True)
    queue.scan(tmp_path / "logs", day)
    return {each.path: each.kind for each in queue.entries.values()}


def test_only_finished_files_return(tmp_path):
    logs = tmp_path / "logs"
    write(logs / "run.bag", OPEN_BAG)
    write(logs / "run.7.bag", OPEN_BAG, 2e8)  # of a telemetry that was killed
    write(logs / "trial/run.bag", WHOLE_BAG, 3e8)
    write(logs / "black_box/stop.3.bag", WHOLE_BAG, 4e8)
    write(logs / "black_box/ring/0.bag", OPEN_BAG, 4e8)
    write(logs / ".run.1.partial.bag", WHOLE_BAG, 5e8)
    write(logs / "user.bag.active", OPEN_BAG)
    write(logs / "run.html", b"page", 6e8)
    write(logs / "young.html", b"page", DAY - 5)
    (logs / "link.bag").symlink_to(logs / "trial/run.bag")
    assert found(tmp_path) == {
        "run.7.bag": "runs",
        "trial/run.bag": "runs",
        "black_box/stop.3.bag": "incidents",
        "run.html": "reports",
    }


def test_a_renamed_run_is_the_same_file(tmp_path):
    logs = tmp_path / "logs"
    write(logs / "run.bag", WHOLE_BAG)
    queue = QueueFile(tmp_path)
    queue.scan(logs, DAY)
    (known,) = queue.entries.values()
    known.returned = True
    (logs / "run.bag").rename(logs / "run.1.bag")
    assert queue.scan(logs, DAY) == []
    assert [(each.path, each.returned) for each in queue.entries.values()] == [("run.1.bag", True)]


# ---- parts


def test_parts_are_the_same_whenever_they_are_packed_and_compressed_where_it_helps(tmp_path):
    noise = random.Random(1).randbytes(PART)
    write(tmp_path / "run.1.bag", bytes(PART) + noise + b"end")
    with opened_file(tmp_path / "run.1.bag") as file:
        assert [packed(file, number)[0].name for number in range(3)] == ["00000.gz", "00001", "00002"]
        assert packed(file, 0)[1][4:8] == bytes(4)  # gzip's field for the time of day


@pytest.mark.parametrize("size", [0, 1, PART, PART + 1, 3 * PART])
def test_a_file_of_any_size_is_put_together(tmp_path, size):
    source = random.Random(size).randbytes(size)
    system = System(tmp_path, {"run.1.bag": source})
    system.finish()
    system.verify_far_side()


@pytest.mark.parametrize(
    ("name", "change", "words"),
    [
        ("00001", lambda data: data[:-1], "part 2 of 3: 00001 has 999 of 1000 bytes"),
        ("00001", lambda data: bytes(len(data)), "part 2 of 3: 00001 has different content than was sent"),
        ("00000", None, "part 1 of 3: 00000 is missing"),
        (MANIFEST, lambda data: data[:-5], "manifest.json is cut off or damaged"),
        (MANIFEST, lambda data: data.replace(b'"size": 1000', b'"size": 1e999'), "manifest.json is cut off or damaged"),
        (MANIFEST, lambda _: b"[" * 100_000, "manifest.json is cut off or damaged"),
        (MANIFEST, lambda data: data.replace(b'_size": 1000', b'_size": 0'), "part_size is 0, and must be from 1 to"),
        (MANIFEST, lambda data: re.sub(rb'_ns": \d+', b'_ns": 99999999999999999999', data), "mtime_ns is 99999999999"),
        (MANIFEST, lambda data: data.replace(b"00001", b"../01"), "does not list the parts one by one"),
        (MANIFEST, lambda data: data.replace(b'"size": 3000,\n "m', b'"size": 3001,\n "m'), "hold 3000 of 3001 bytes"),
    ],
    ids=["short", "content", "missing", "cut manifest", "infinity", "deep", "part size", "time", "names", "size"],
)
def test_every_gap_is_named(tmp_path, capsys, name, change, words):
    system = System(tmp_path, {"run.1.bag": random.Random(1).randbytes(3 * PART)})
    system.finish()
    far = system.written(tmp_path / "far")
    assert verify(str(far), "", None)
    (path,) = far.rglob(name)
    path.write_bytes(change(path.read_bytes())) if change else path.unlink()
    assert not verify(str(far), "", tmp_path / "out")
    assert words in capsys.readouterr().out
    assert not list((tmp_path / "out").rglob("*.bag"))


def test_a_part_that_unpacks_to_more_than_it_may_is_refused(tmp_path):
    write(tmp_path / "run.1.bag", bytes(PART))
    with opened_file(tmp_path / "run.1.bag") as file:
        part, data = packed(file, 0)
    whole = manifest(entry("run.1.bag", size=PART, parts={0: part}))
    small = whole.replace(b'"part_size": 1000', b'"part_size": 10')
    with pytest.raises(GapError, match="more than 10 bytes"):
        put_together(lambda wanted: small if wanted == MANIFEST else data, None)
    assert read_manifest(whole)["size"] == PART


# ---- the sender with a remote in memory


def some_files(seed=1):
    source = random.Random(seed)
    return {
        "run.1.bag": source.randbytes(7300),
        "black_box/stop.1.bag": source.randbytes(2500),
        "run.html": b"page " * 500,
    }


@pytest.mark.parametrize("hashes", [True, False])
def test_the_program_may_end_before_every_effect(tmp_path, monkeypatch, hashes):
    """Ended at each flush, rename and effect on the far side; begun again, all arrives, little of it twice."""
    files = some_files()
    total = sum(map(len, files.values()))
    for lost_at in range(1000):
        folder = tmp_path / str(lost_at)
        left = [lost_at]

        def count(left=left):
            left[0] -= 1
            if left[0] == -1:
                raise PowerLoss

        def counted(call, count=count):
            return lambda *given, **named: (count(), call(*given, **named))[1]

        monkeypatch.setattr(os, "fsync", lambda _: None)
        system = System(folder, files, VirtualRemote(hashes=hashes, before=count), local_quota=1e-9)
        with monkeypatch.context() as patch:
            for name in ("fsync", "replace"):
                patch.setattr(os, name, counted(getattr(os, name)))
            patch.setattr(Path, "unlink", counted(Path.unlink))
            patch.setattr(parts, "renamed", counted(parts.renamed))
            try:
                for _ in range(100):
                    system.step()
            except PowerLoss:
                left[0] = -2
                check_nothing_is_lost(system)
                system.begin()
        for _ in range(100):
            system.step()
        check_nothing_is_lost(system)
        assert not list((folder / "logs").rglob("*.bag"))
        system.verify_far_side()
        assert system.far.received <= total + PART * plan.BATCH + 1000
        if left[0] > -1:
            break
    assert lost_at > 30


@pytest.mark.parametrize(("in_batch_time", "parts"), [(0.0, 4), (1.0, 4), (10.5, 10), (100.0, 16)])
def test_a_batch_lasts_so_long_that_its_start_costs_little_of_the_bandwidth(in_batch_time, parts):
    entry = plan.Entry("key", "run.1.bag", "runs", 100 * plan.PART_BYTES, 0, "runs/run.1.bag")
    bandwidth = 1e-6 * in_batch_time * plan.PART_BYTES / plan.BATCH_TIME
    assert plan.next_parts(entry, bandwidth) == list(range(parts))


@pytest.mark.parametrize("hashes", [True, False])
def test_a_damaged_part_is_sent_again(tmp_path, hashes):
    system = System(tmp_path, {"run.1.bag": random.Random(1).randbytes(PART)}, VirtualRemote(hashes=hashes))
    put = system.far.put

    def damaged(source, target):
        put(source, target)
        for name in system.far.content:
            system.far.content[name] = bytes(PART)
        system.far.put = put

    system.far.put = damaged
    system.finish()
    system.verify_far_side()
    assert "different content" in system.said[0]


def test_a_manifest_that_arrived_damaged_is_sent_again_and_nothing_is_deleted_before(tmp_path):
    system = System(tmp_path, {"run.1.bag": b"x" * 10}, local_quota=1e-9)
    system.step()
    put = system.far.put

    def damaged(source, target):
        put(source, target)
        name = f"{target}/{MANIFEST}"
        system.far.content[name] = bytes(len(system.far.content[name]))
        system.far.put = put

    system.far.put = damaged
    system.step()
    for _ in range(100):
        check_nothing_is_lost(system)
        system.step()
    assert not (tmp_path / "logs/run.1.bag").exists()
    system.verify_far_side()


def test_what_was_verified_is_known_after_a_restart(tmp_path):
    system = System(tmp_path, {"run.1.bag": random.Random(1).randbytes(9 * PART)})
    system.step()
    system.begin()
    (known,) = system.queue.entries.values()
    assert sorted(known.parts) == list(range(plan.BATCH))


def test_a_part_that_the_far_side_has_lost_is_sent_again(tmp_path):
    system = System(tmp_path, {"run.1.bag": random.Random(1).randbytes(2 * PART)})
    system.step()
    del system.far.content[next(iter(system.far.content))]
    system.finish()
    system.verify_far_side()


def test_a_failure_is_said_once_and_tried_again_later_and_later(tmp_path):
    system = System(tmp_path, {"run.1.bag": b"x" * 10})
    tries = []

    def fails():
        tries.append(system.now)
        raise OSError(5, "it does not answer")

    system.far.before = fails
    for _ in range(2000):
        system.step()
    assert len(system.said) == 1
    pauses = [b - a for a, b in pairwise(tries)]
    assert pauses[:5] == [2, 4, 8, 16, 32]
    assert max(pauses) == plan.LONGEST_WAIT
    assert "it does not answer" in system.sender.progress
    system.far.before = lambda: None
    system.finish()
    assert system.sender.problem == ""
    assert system.sender.progress == "all 1 files are on the far side"


def test_nothing_is_sent_while_it_waits_and_the_reason_is_shown(tmp_path):
    system = System(tmp_path, some_files())
    for _ in range(20):
        assert not system.step("outside of hours")
    assert system.far.content == {}
    assert system.sender.progress == "waits: outside of hours; to go: 3 files, 0.0 MB"


def test_beyond_the_quota_of_the_far_side_nothing_is_sent_until_there_is_room(tmp_path):
    system = System(tmp_path, {"run.1.bag": random.Random(1).randbytes(8 * PART)}, far_quota=5.5 * PART / plan.GB)
    for _ in range(1000):
        system.step()
    assert system.far.used() == 4 * PART
    assert "far_quota" in system.said[0]
    system.sender._settings = Settings(folder=system.settings.folder, far_quota=1.0)
    system.finish()
    system.verify_far_side()


def test_a_file_that_is_deleted_before_it_was_sent_is_named(tmp_path):
    system = System(tmp_path, {"run.1.bag": random.Random(1).randbytes(9 * PART), "run.2.bag": b"x"})
    system.step()
    (tmp_path / "logs/run.1.bag").unlink()
    system.finish()
    assert any("run.1.bag was deleted or changed before it was sent" in each for each in system.said)


# ---- settings


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{}", "far_side is empty"),
        ("far_side: [", "is not YAML"),
        ("- a", "must hold keys"),
        ("far_side: /far\nbandwith: 1", "bandwith: is unknown; known are far_side,"),
        ("far_side: /far\nbandwidth: fast", "bandwidth = fast: must be a number from 0 to 1e+09"),
        ("far_side: /far\nbandwidth: -1", "bandwidth = -1: must be a number"),
        ("far_side: /far\nbandwidth: .nan", "bandwidth = nan: must be a number"),
        ("far_side: /far\nbandwidth: 0.001", "must be 0 (no limit) or at least"),
        ("far_side: /far\nhours: 22:00-06:00", "hours = 22:00-06:00: must be a list"),
        ("far_side: /far\nhours: [25:00-06:00]", "hours: 25:00-06:00: must be as in"),
        ("far_side: /far\nmetered: 3", "metered = 3: must be true or false"),
        ("far_side: /far\nrobot: a/b", "robot = a/b: must be of letters"),
        ("far_side: -v", "begins with -"),
        ("far_side: x:y\nrclone_config: /none", "rclone_config = /none: file not found"),
        ("far_side: /far\nca_file: /none", "ca_file = /none: file not found"),
    ],
    ids=str,
)
def test_a_wrong_value_is_named(tmp_path, text, words):
    (tmp_path / "my.yaml").write_text(text)
    with pytest.raises(SettingsError, match=re.escape(words)):
        read_settings(tmp_path / "my.yaml")


def test_passwords_that_others_can_read_are_refused(tmp_path):
    (tmp_path / "rclone.conf").write_text("[x]\n")
    (tmp_path / "my.yaml").write_text(f"far_side: x:y\nrclone_config: {tmp_path}/rclone.conf")
    (tmp_path / "rclone.conf").chmod(0o644)
    with pytest.raises(SettingsError, match="chmod 600"):
        read_settings(tmp_path / "my.yaml")
    (tmp_path / "rclone.conf").chmod(0o600)
    assert read_settings(tmp_path / "my.yaml", tmp_path / "my.yaml").far_side == "x:y"


def test_the_shipped_file_holds_the_defaults():
    shipped = Path(__file__).parents[3] / "config/data_return.yaml"
    with pytest.raises(SettingsError, match="far_side is empty"):
        read_settings(shipped)
