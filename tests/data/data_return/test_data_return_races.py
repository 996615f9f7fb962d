"""Files that change while they are sent, files that cannot be sent, and what may be deleted; in virtual time."""

import io
import os
import random
from types import SimpleNamespace

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from robot_control.data.data_return import node, parts
from robot_control.data.data_return.node import Node
from robot_control.data.data_return.parts import MANIFEST, put_together
from robot_control.robot.boundary import Boundary
from support.data_return_system import OPEN_BAG, PART, WHOLE_BAG, System, use_small_parts, write

from bench.data_return.changes import Changes
from bench.data_return.virtual_remote import PowerLoss, VirtualRemote


@pytest.fixture(autouse=True)
def small_parts(monkeypatch):
    use_small_parts(monkeypatch)


def some_bytes(size, seed=1):
    return random.Random(seed).randbytes(size)


def whole(system):
    """The files that the remote has, by the names in their manifests."""
    files = []
    for name in [name for name in system.far.content if name.endswith(MANIFEST)]:
        raw, begin = io.BytesIO(), name.removesuffix(MANIFEST)
        put_together(lambda part, begin=begin: system.far.content[begin + part], raw)
        files.append(raw.getvalue())
    return files


# ---- a file that changes while it is sent


@pytest.mark.parametrize("hashes", [True, False])
def test_a_telemetry_that_begins_while_run_bag_is_sent_costs_no_file(tmp_path, hashes):
    content = WHOLE_BAG + some_bytes(8 * PART)
    system = System(tmp_path, {"run.bag": content}, VirtualRemote(hashes=hashes), local_quota=1e-9)
    system.step()
    logs = tmp_path / "logs"
    (logs / "run.bag").rename(logs / "run.1.bag")
    write(logs / "run.bag", OPEN_BAG + some_bytes(8 * PART, 2))
    for _ in range(20):
        system.step()
    assert whole(system) == [content]
    assert [path.name for path in logs.iterdir()] == ["run.bag"]


def swapped(path, content):
    path.with_name("new").write_bytes(content)
    path.with_name("new").replace(path)


def rewritten(path, content):
    path.write_bytes(content)


@pytest.mark.parametrize("change", [swapped, rewritten])
@pytest.mark.parametrize("steps", [1, 2, 3])
@pytest.mark.parametrize("hashes", [True, False])
def test_another_file_of_the_same_name_size_and_time_is_not_taken_for_it(tmp_path, change, steps, hashes):
    """It comes between the parts, before the manifest, or once the file has returned."""
    system = System(tmp_path, {"run.1.bag": some_bytes(6 * PART)}, VirtualRemote(hashes=hashes))
    path, other = tmp_path / "logs/run.1.bag", some_bytes(6 * PART, 2)
    for _ in range(steps):
        system.step()
    change(path, other)
    os.utime(path, (1e9, 1e9))
    system.sender._settings = system.settings.__class__(**{**vars(system.settings), "local_quota": 1e-9})
    for _ in range(100):
        system.step()
        if not path.exists():
            break
    assert not path.exists()
    assert other in whole(system)


def test_a_file_that_is_cut_off_while_its_last_part_is_verified_does_not_count_as_returned(tmp_path):
    system = System(tmp_path, {"run.1.bag": some_bytes(2 * PART)})
    put = system.far.put

    def cut(source, target):
        put(source, target)
        os.truncate(tmp_path / "logs/run.1.bag", PART)

    system.far.put = cut
    system.step()
    system.far.put = put
    for _ in range(20):
        system.step()
    assert whole(system) == [some_bytes(2 * PART)[:PART]]


@pytest.mark.parametrize("hashes", [True, False])
def test_what_is_deleted_the_far_side_has_whatever_happens_to_the_files(tmp_path, hashes):
    for seed in range(2):
        changes = Changes(tmp_path / str(seed), seed, hashes=hashes)
        assert changes.run(60) == 0
        assert changes.wrong == []
        assert changes.deleted > 5


@pytest.mark.nightly
@pytest.mark.parametrize("hashes", [True, False])
def test_what_is_deleted_the_far_side_has_after_a_thousand_changes(tmp_path, hashes):
    changes = Changes(tmp_path, 7, hashes=hashes)
    assert changes.run(1000) == 0
    assert changes.wrong == []


# ---- what the remote has


@pytest.mark.parametrize("data", [bytes(PART), some_bytes(PART - 1), None], ids=["content", "short", "gone"])
def test_a_part_that_the_far_side_changed_before_the_manifest_is_sent_again(tmp_path, data):
    system = System(tmp_path, {"run.1.bag": some_bytes(2 * PART)})
    system.step()
    name = next(iter(system.far.content))
    del system.far.content[name]
    if data is not None:
        system.far.content[name] = data
    system.finish()
    assert whole(system) == [some_bytes(2 * PART)]


@pytest.mark.parametrize("lost", ["00001", MANIFEST])
@pytest.mark.parametrize("hashes", [True, False])
def test_the_local_quota_deletes_no_file_that_the_far_side_has_lost(tmp_path, lost, hashes):
    content = some_bytes(3 * PART)
    system = System(tmp_path, {"run.1.bag": content}, VirtualRemote(hashes=hashes))
    system.finish()
    (name,) = [name for name in system.far.content if name.endswith(lost)]
    del system.far.content[name]
    system.sender._settings = system.settings.__class__(**{**vars(system.settings), "local_quota": 1e-9})
    system.step()
    assert (tmp_path / "logs/run.1.bag").read_bytes() == content
    assert "differs on the far side" in system.said[-1]
    for _ in range(20):
        system.step()
    assert whole(system) == [content]
    assert not (tmp_path / "logs/run.1.bag").exists()


@pytest.mark.parametrize("lost", ["00000", "00001"])
def test_what_the_far_side_has_lost_of_a_whole_file_is_sent_again_without_a_queue(tmp_path, lost):
    """The first of one part is the case in which nothing came further."""
    content = some_bytes(2 * PART if lost == "00001" else PART)
    system = System(tmp_path, {"run.1.bag": content})
    system.finish()
    (name,) = [name for name in system.far.content if name.endswith(lost)]
    del system.far.content[name]
    (tmp_path / "queue/queue.json").unlink()
    system.begin()
    system.finish(20)
    assert whole(system) == [content]


def test_a_part_that_the_far_side_damaged_is_noticed_before_the_file_is_deleted(tmp_path):
    system = System(tmp_path, {"run.1.bag": some_bytes(3 * PART)})
    system.finish()
    (name,) = [name for name in system.far.content if name.endswith("00001")]
    system.far.content[name] = bytes(PART)
    system.sender._settings = system.settings.__class__(**{**vars(system.settings), "local_quota": 1e-9})
    for _ in range(20):
        system.step()
        assert (tmp_path / "logs/run.1.bag").exists() or whole(system) == [some_bytes(3 * PART)]
    assert not (tmp_path / "logs/run.1.bag").exists()


def test_a_file_that_takes_the_name_at_the_moment_of_the_deletion_stays(tmp_path, monkeypatch):
    system = System(tmp_path, {"run.1.bag": some_bytes(PART)}, local_quota=1e-9)
    logs = tmp_path / "logs"
    renamed = parts.renamed

    def late(path, target):
        write(logs / "other", b"another file")
        (logs / "other").replace(path)
        monkeypatch.undo()
        return renamed(path, target)

    monkeypatch.setattr(parts, "renamed", late)
    for _ in range(3):
        system.step()
    assert (logs / "run.1.bag").read_bytes() == b"another file"


def test_a_file_that_is_rewritten_at_the_moment_of_the_deletion_returns_again(tmp_path, monkeypatch):
    """Neither its inode nor its size and time tell."""
    system = System(tmp_path, {"run.1.bag": some_bytes(PART)}, local_quota=1e-9)
    renamed = parts.renamed

    def late(path, target):
        write(path, some_bytes(PART, 2))
        monkeypatch.setattr(parts, "renamed", renamed)
        return renamed(path, target)

    monkeypatch.setattr(parts, "renamed", late)
    for _ in range(20):
        system.step()
    assert some_bytes(PART, 2) in whole(system)
    assert list((tmp_path / "logs").iterdir()) == []


def test_a_file_that_takes_the_other_name_before_the_deletion_stays(tmp_path, monkeypatch):
    system = System(tmp_path, {"run.1.bag": some_bytes(PART)}, local_quota=1e-9)
    logs = tmp_path / "logs"
    renamed, exists = parts.renamed, os.path.lexists

    def late(*paths):
        if not exists(logs / "_run.1.bag"):
            (logs / "_run.1.bag").write_bytes(b"another file")
        return renamed(*paths)

    monkeypatch.setattr(parts, "renamed", late)
    for _ in range(3):
        system.step()
    assert {path.name: path.read_bytes() for path in logs.iterdir()} == {"_run.1.bag": b"another file"}


def test_a_report_that_surprises_the_program_does_not_end_its_reports(monkeypatch):
    reports, names = [], iter([KeyError("x"), "", ""])

    class Sender:
        progress = "all files are on the far side"

        @property
        def problem(self):
            if isinstance(name := next(names, ""), KeyError):
                raise name
            return name

    monkeypatch.setattr(node, "boundary", Boundary(lambda _: None))
    monkeypatch.setattr(node.rospy.Time, "now", node.rospy.Time)
    sending = Node.__new__(Node)
    sending._sender, sending._name = Sender(), "data_return"
    sending._diagnostics = SimpleNamespace(publish=reports.append)
    for _ in range(2):
        sending._report(None)
    assert [each.status[0].message for each in reports] == ["ok"]
    assert node.boundary.dropped == {"a report": 1}


@pytest.mark.parametrize("newer", [False, True])
def test_a_deletion_that_was_ended_half_way_costs_no_file(tmp_path, monkeypatch, newer):
    system = System(tmp_path, {"run.1.bag": some_bytes(PART)}, local_quota=1e-9)

    def ended(*_, **__):
        monkeypatch.setattr(parts, "renamed", ended)
        raise PowerLoss

    monkeypatch.setattr("pathlib.Path.unlink", ended)
    with pytest.raises(PowerLoss):
        for _ in range(10):
            system.step()
    monkeypatch.undo()
    use_small_parts(monkeypatch)
    logs = tmp_path / "logs"
    assert {path.name: path.read_bytes() for path in logs.iterdir()} == {"_run.1.bag": some_bytes(PART)}
    if newer:
        write(logs / "run.1.bag", b"a newer file")
    system.begin()
    system.step("no link")
    assert {path.name for path in logs.iterdir()} == ({"_run.1.bag", "run.1.bag"} if newer else {"run.1.bag"})
    for _ in range(10):
        system.step()
    assert sorted(whole(system)) == sorted([some_bytes(PART), *[b"a newer file"] * newer])
    assert list(logs.iterdir()) == []


@pytest.mark.parametrize("again", [False, True], ids=["together", "after the first is deleted"])
def test_two_files_of_one_name_and_time_do_not_overwrite_each_other(tmp_path, again):
    first, second = some_bytes(2 * PART), some_bytes(2 * PART, 2)
    system = System(tmp_path, {"a/run.1.bag": first}, local_quota=1e-9 if again else 0)
    for _ in range(10 * again):
        system.step()
    write(tmp_path / "logs/b/run.1.bag", second, 1e9)
    for _ in range(20):
        system.step()
    assert sorted(whole(system)) == sorted([first, second])
    received = system.far.received
    (tmp_path / "queue/queue.json").unlink()
    system.begin()
    for _ in range(20):
        system.step()
    assert system.far.received == received  # without a queue, too, each is found where it is


# ---- a file that cannot be sent


@pytest.mark.parametrize(
    ("error", "words"),
    [(OSError(5, "Input/output error"), "Input/output error"), (KeyError("x"), "KeyError('x')")],
    ids=["error", "unforeseen"],
)
def test_one_file_that_cannot_be_sent_is_named_and_later_ones_go_on(tmp_path, error, words):
    files = {"black_box/stop.1.bag": some_bytes(PART), **{f"run.{n}.bag": some_bytes(PART, n) for n in range(5)}}
    system = System(tmp_path, files)
    put = system.far.put
    tries = []

    def refuses(source, target):
        if target.startswith("incidents"):
            tries.append(system.now)
            raise error
        put(source, target)

    system.far.put = refuses
    for _ in range(1000):
        system.step()
    assert sorted(whole(system)) == sorted(content for name, content in files.items() if name.startswith("run"))
    assert system.sender.problem.startswith("black_box/stop.1.bag: ")
    assert words in system.sender.problem
    assert len(system.said) == 1
    assert 5 < len(tries) < 20
    system.far.put = put
    system.finish()
    assert system.sender.problem == ""


def test_a_link_that_is_back_is_used_for_all_files(tmp_path):
    files = {f"run.{n}.bag": some_bytes(PART, n) for n in range(5)}
    system = System(tmp_path, files)

    def fails():
        raise OSError(5, "it does not answer")

    system.far.before = fails
    for _ in range(50):
        system.step()
    assert len(system.said) == 1
    system.far.before = lambda: None
    system.finish(100)
    assert system.sender.problem == ""


# ---- names of files on the robot


@pytest.mark.parametrize(
    ("name", "folder"),
    [
        (b"gr\xfc\xdfe.1.bag", "gr__e.1.bag"),
        ("Pr\u00fcfung 3.bag".encode(), "Pr\u00fcfung 3.bag"),
        (b"a\nb\x1b[2J.1.bag", "a_b__2J.1.bag"),
        ("a\u2028b.1.bag".encode(), "a_b.1.bag"),
        (b"x" * 250 + b".bag", "x" * 196 + ".bag"),
    ],
    ids=["no UTF-8", "umlaut", "control", "line separator", "long"],
)
def test_a_file_of_any_name_returns_and_can_be_reported(tmp_path, name, folder):
    system = System(tmp_path, {})
    path = tmp_path / "logs" / os.fsdecode(name)
    write(path, WHOLE_BAG + bytes(6 * PART))
    system.step()
    assert folder in next(iter(system.far.content)).split("Z-")[1]
    values = [KeyValue("progress", system.sender.progress)]
    DiagnosticArray(status=[DiagnosticStatus(1, "", system.sender.problem, "", values)]).serialize(io.BytesIO())
    system.begin()
    system.finish()
    path.unlink()
    system.begin()
    system.step()
    assert all(each.isprintable() for each in system.said)


@pytest.mark.parametrize("at", [-1e9, 3e11], ids=["before 1970", "after 9999"])
def test_a_file_of_any_time_returns(tmp_path, at):
    system = System(tmp_path, {"run.1.bag": b"rows"})
    os.utime(tmp_path / "logs/run.1.bag", (at, at))
    system.finish()
    assert whole(system) == [b"rows"]
