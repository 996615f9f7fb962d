"""Reads a ROS bag for another process: python3 -m robot_control.files.read_bag FILE.

Debian's rosbag trusts a bag: 11 kB of bz2 inflate to 6.4 GB. So it reads in this process, which has limits of memory
and of processor time. As far as the kernel permits it uses no network, changes no file and starts no program.

bag_file.py starts it. For each answer it writes a list of topics in JSON as a line of standard input. A message in the
answer is `FRAME` (number of its connection, time of reception in ns, bytes) and its data. For an empty list it is HEAD.
The last one is END, or ERROR, which also ends the process.
"""

import contextlib
import io
import json
import resource
import struct
import sys
from pathlib import Path
from typing import Any

from robot_control.files.confinement import confine, limit

FRAME = struct.Struct("<IQI")
HEAD, END, ERROR = 0xFFFFFFFD, 0xFFFFFFFE, 0xFFFFFFFF
MAX_MEMORY = 1 << 30  # bytes; the index of a bag of some million messages has a third of it
MIN_TIME, SPEED = 60, 1 << 20  # s of processor time, and bytes of the file for each further one


def _give(number: int, time_ns: int, data: bytes) -> None:
    sys.stdout.buffer.write(FRAME.pack(number, time_ns, len(data)) + data)


def _open(rosbag: Any, path: str) -> tuple[Any, str]:  # noqa: ANN401 (a module without types)
    """The bag, and which part of it is read; "" if all is."""
    try:
        return rosbag.Bag(path), ""
    except rosbag.ROSBagUnindexedException:
        bag = rosbag.Bag(path, allow_unindexed=True)
    with contextlib.suppress(io.UnsupportedOperation):  # at its end, it would cut the file off
        for _ in bag.reindex():
            pass
    bag._connection_indexes_read = True  # noqa: SLF001
    chunks = len(bag._chunks)  # noqa: SLF001
    cut = "the bag has no end: its recorder was stopped, or the copy is incomplete. Read are the messages of "
    return bag, f"{cut}{chunks} whole chunks"


def _serve(path: str) -> None:
    try:
        import rosbag  # noqa: PLC0415 (only this process needs it)
    except ImportError as error:
        raise ValueError(f"bags need Debian's python3-rosbag: {error}. Run it with /usr/bin/python3") from None

    rosbag.bag._get_message_type = lambda _: None  # noqa: SLF001 (it would make a program of a definition in the file)
    confine()
    bag, cut = _open(rosbag, path)
    connections = bag._connections  # noqa: SLF001
    number_of = {id(each.header): number for number, each in connections.items()}
    fields = ("topic", "datatype", "md5sum", "msg_def")
    known = {number: [getattr(each, field) for field in fields] for number, each in connections.items()}
    head = json.dumps({"cut": cut, "connections": known, "count": bag.get_message_count()}).encode()
    for line in sys.stdin:
        if topics := json.loads(line):
            for message in bag.read_messages(topics, raw=True, return_connection_header=True):
                number = number_of[id(message.connection_header)]
                _give(number, message.timestamp.to_nsec(), message.message[1])
        else:
            _give(HEAD, 0, head)
        _give(END, 0, b"")
        sys.stdout.flush()


def main() -> None:
    """Exits with 0; an error is the last message."""
    (path,) = sys.argv[1:]
    limit(resource.RLIMIT_AS, MAX_MEMORY)
    limit(resource.RLIMIT_CPU, MIN_TIME + Path(path).stat().st_size // SPEED)
    try:
        _serve(path)
    except Exception as error:
        _give(ERROR, 0, f"{type(error).__name__}: {error}".encode(errors="replace"))
    sys.stdout.flush()


if __name__ == "__main__":
    main()
