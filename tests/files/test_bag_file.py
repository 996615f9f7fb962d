"""BagFile reads bags of other programs, with rosbag in a process of its own."""

import bz2
import contextlib
from pathlib import Path
from random import Random

import pytest
from robot_control.files.bag_file import BagFile, BagFileError
from robot_control.files.files import InputFileError

rosbag = pytest.importorskip("rosbag", reason="bags need Debian's python3-rosbag")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def written(messages, **options):
    """Writes in.bag from (topic, message or raw message), one in 10 ms."""
    from rospy import Time

    with rosbag.Bag("in.bag", "w", **options) as bag:
        for i, (topic, message) in enumerate(messages):
            bag.write(topic, message, Time(100, 10_000_000 * i), raw=isinstance(message, tuple))
    return Path("in.bag")


def text(data):
    from std_msgs.msg import String

    return String(data=data)


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_what_rosbag_wrote_is_read(compression):
    said = [("/a" if i % 3 else "/b", text(f"message {i}")) for i in range(1000)]
    bag = BagFile(written(said, compression=compression, chunk_threshold=3000))
    assert bag.topics == {"/a": "std_msgs/String", "/b": "std_msgs/String"}
    assert bag.cut == ""
    read = list(bag.messages("/b"))
    assert [message.data for message, _ in read] == [message.data for topic, message in said if topic == "/b"]
    assert read[1][1] == 100 * 10**9 + 3 * 10**7
    topics = [bag.connections[number][0] for number, _, _ in bag.raw(["/a", "/b"])]
    assert topics == [topic for topic, _ in said]


def test_a_recorder_that_is_still_writing_or_was_killed_costs_its_last_chunk():
    from rospy import Time

    bag = rosbag.Bag("in.bag", "w", chunk_threshold=1000)
    for i in range(100):
        bag.write("/a", text(f"message {i}"), Time(100 + i))
    bag._file.flush()
    read = BagFile(Path("in.bag"))
    found = [message.data for message, _ in read.messages("/a")]
    assert found == [f"message {i}" for i in range(len(found))]
    assert len(found) > 80
    assert "its recorder was stopped" in read.cut
    bag.close()
    assert BagFile(Path("in.bag")).cut == ""


def test_a_bag_that_is_damaged_is_read_up_to_the_damage():
    path = written([("/a", text(f"message {i}")) for i in range(300)], compression="bz2", chunk_threshold=1000)
    sound = path.read_bytes()
    path.write_bytes(sound[: len(sound) // 2] + b"\0" * (len(sound) // 2))
    read = BagFile(path)
    found = [message.data for message, _ in read.messages("/a")]
    assert found == [f"message {i}" for i in range(len(found))]
    assert "the bag has no end" in read.cut


@pytest.mark.parametrize("seed", range(9))
def test_random_bytes_in_a_bag_end_in_messages_or_in_one_refusal(seed):
    random = Random(seed)
    path = written([("/a", text(f"message {i}")) for i in range(200)], compression=("none", "bz2", "lz4")[seed % 3])
    content = bytearray(path.read_bytes())
    for _ in range(1 + random.randrange(20)):
        content[random.randrange(len(content))] = random.randrange(256)
    path.write_bytes(content)
    with contextlib.suppress(BagFileError):
        bag = BagFile(path)
        for topic in bag.topics:
            list(bag.messages(topic))


def test_a_chunk_that_inflates_without_bounds_is_refused():
    zeros = 32 * bz2.compress(bytes(64 << 20), 9)
    bag = written([("/a", text("x"))], compression="bz2").read_bytes()
    begin = bag.index(b"BZh") - 4
    size = int.from_bytes(bag[begin : begin + 4], "little")
    Path("in.bag").write_bytes(bag[:begin] + len(zeros).to_bytes(4, "little") + zeros + bag[begin + 4 + size :])
    with pytest.raises(BagFileError, match=r"in\.bag"):
        list(BagFile(Path("in.bag")).messages("/a"))


def test_a_definition_out_of_the_file_is_never_used():
    """genpy would turn it into a program."""
    kind = type(text(""))
    for name, md5sum, said in (
        ("std_msgs/String", "0" * 32, "different definition of std_msgs/String than the installed one"),
        ("nobody_msgs/Nothing", kind._md5sum, "is of nobody_msgs/Nothing, which is not installed"),
        ("../../etc/passwd", kind._md5sum, "which is not installed"),
        ("no name", kind._md5sum, "which is not installed"),
    ):
        bag = BagFile(written([("/a", (name, b"\0\0\0\0", md5sum, kind))]))
        with pytest.raises(BagFileError, match=said):
            next(bag.messages("/a"))


@pytest.mark.parametrize("data", [b"", b"\xff\xff\xff\xff", b"\x02\0\0\0\xff\xfe"])
def test_a_message_that_is_none_is_refused_with_its_number(data):
    kind = type(text(""))
    bag = BagFile(written([("/a", text("sound")), ("/a", (kind._type, data, kind._md5sum, kind))]))
    with pytest.raises(BagFileError, match=r"in\.bag: message 1 of /a"):
        list(bag.messages("/a"))


def test_a_message_longer_than_its_type_is_refused():
    kind = type(text(""))
    bag = BagFile(written([("/a", (kind._type, b"\x01\0\0\0xyz", kind._md5sum, kind))]))
    with pytest.raises(BagFileError, match="message 0 of /a is no std_msgs/String"):
        list(bag.messages("/a"))


def test_one_topic_of_two_types_is_refused():
    from std_msgs.msg import Bool

    path = written([("/a", text("x")), ("/b", Bool(data=True))])
    path.write_bytes(path.read_bytes().replace(b"topic=/b", b"topic=/a"))
    with pytest.raises(BagFileError, match="/a has messages of two types"):
        BagFile(path)


def test_what_is_no_file_is_refused():
    with pytest.raises(InputFileError, match="is a folder"):
        BagFile(Path())
    with pytest.raises(OSError, match="nowhere"):
        BagFile(Path("nowhere.bag"))
    Path("empty.bag").touch()
    with pytest.raises(BagFileError, match=r"empty\.bag is not a readable ROS 1 bag: "):
        BagFile(Path("empty.bag"))
