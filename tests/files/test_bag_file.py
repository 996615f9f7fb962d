"""BagFile reads bags of other programs. Their structure is tested in tests/bags."""

from pathlib import Path

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
    assert [topic for topic, _, _ in bag.raw(["/a", "/b"])] == [topic for topic, _ in said]


def test_a_recorder_that_is_still_writing_or_was_killed_costs_the_end_alone():
    from rospy import Time

    bag = rosbag.Bag("in.bag", "w")
    for i in range(100):
        bag.write("/a", text(f"message {i}"), Time(100 + i))
    bag._file.flush()
    read = BagFile(Path("in.bag"))
    assert [message.data for message, _ in read.messages("/a")] == [f"message {i}" for i in range(100)]
    assert "its recorder was stopped" in read.cut
    bag.close()
    assert BagFile(Path("in.bag")).cut == ""


def test_a_definition_out_of_the_file_is_never_used():
    """genpy would turn it into a program."""
    kind = type(text(""))
    for name, md5sum, said in (
        ("std_msgs/String", "0" * 32, "another definition of std_msgs/String than the installed one"),
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
    with pytest.raises(BagFileError, match=r"empty\.bag is no ROS 1 bag that can be read: byte 0, field version"):
        BagFile(Path("empty.bag"))
