"""Messages of a ROS bag that another program wrote. A process of its own reads it with rosbag (read_bag.py)."""

import contextlib
import json
import os
import subprocess
import sys
import weakref
from collections.abc import Iterable, Iterator
from io import BytesIO
from pathlib import Path
from typing import IO, Any, cast

from robot_control.files.files import MAX_TABLE, check_input, printable, utf8
from robot_control.files.read_bag import END, ERROR, FRAME


class BagFileError(ValueError):
    """The bag is not read; the message names it."""


class BagFile:
    """The topics and messages of one bag. Needs no running ROS.

    Message classes are the installed ones: a definition out of the file would be made into a program.
    """

    topics: dict[str, str]
    """type by topic"""
    cut: str
    """which part of a file without a valid index is read; empty: it is whole"""
    connections: dict[int, tuple[str, str, str, str]]
    """topic, type, MD5 sum and definition, by number"""

    def __init__(self, path: Path) -> None:
        """Reads the index.

        Raises:
            InputFileError: no regular file, or too large.
            BagFileError: it is no sound bag.
            OSError: it cannot be opened.
        """
        check_input(path, MAX_TABLE)
        with path.open("rb"):
            pass
        self._path = path
        self._reader: subprocess.Popen[bytes] | None = None
        ((_, _, data),) = self._read([])
        head: dict[str, Any] = json.loads(data)
        self.cut = head["cut"]
        if self.cut and head["count"] == 0:
            raise BagFileError(f"{path} contains no readable message: {self.cut}")
        self.connections = {int(number): tuple(fields) for number, fields in head["connections"].items()}
        self.topics = {}
        for topic, kind, _, _ in self.connections.values():
            if self.topics.setdefault(topic, kind) != kind:
                raise BagFileError(f"{path}: {printable(topic)} has messages of two types")

    def raw(self, topics: Iterable[str]) -> Iterator[tuple[int, int, bytes]]:
        """Connection, time of reception [ns] and serialized message, in the order of the times.

        Raises:
            BagFileError: the bag is not sound, or its reader has reached a limit.
        """
        yield from self._read(list(topics))

    def messages(self, topic: str) -> Iterator[tuple[Any, int]]:
        """Message and time of reception [ns].

        Raises:
            BagFileError: no such type is installed, or with another definition; a message is no such message.
        """
        from genpy import DeserializationError

        kind = self._class_of(topic)
        for count, (_, time_ns, data) in enumerate(self.raw([topic])):
            message = kind()
            try:
                message.deserialize(data)
            except (DeserializationError, ValueError) as error:  # ValueError: text that is no UTF-8
                raise BagFileError(f"{self._path}: message {count} of {printable(topic)}: {error}") from None
            again = BytesIO()
            message.serialize(again)  # genpy takes lengths beyond the message as they come
            if again.getvalue() != data:
                raise BagFileError(f"{self._path}: message {count} of {printable(topic)} is no {self.topics[topic]}")
            yield message, time_ns

    def _read(self, topics: list[str]) -> Iterator[tuple[int, int, bytes]]:
        """The answer of the reader; without topics the description of the bag. One reader serves answers that are read
        to their ends, for to begin means to read the whole index.
        """
        reader, self._reader = self._reader or self._started(), None
        request, answer = cast(IO[bytes], reader.stdin), cast(IO[bytes], reader.stdout)
        try:
            with contextlib.suppress(BrokenPipeError):  # then there is no answer either
                request.write(json.dumps(topics).encode() + b"\n")
                request.flush()
            while len(frame := answer.read(FRAME.size)) == FRAME.size:
                number, time_ns, size = FRAME.unpack(frame)
                data = answer.read(size)
                if number == ERROR:
                    reason = printable(data.decode(errors="replace"))
                    raise BagFileError(f"{self._path} is not a readable ROS 1 bag: {reason}")
                if number == END:
                    self._reader = reader
                    return
                yield number, time_ns, data
            raise BagFileError(f"{self._path} cannot be read: its reader ended, at a limit of memory or time")
        finally:
            if self._reader is not reader:
                reader.kill()
                reader.communicate()

    def _started(self) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-P", "-m", "robot_control.files.read_bag", utf8(self._path)]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
        pipe, quiet = subprocess.PIPE, subprocess.DEVNULL
        reader = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=quiet, env=environment)
        weakref.finalize(self, reader.communicate)  # it ends with its input
        return reader

    def _class_of(self, topic: str) -> Any:  # noqa: ANN401 (a generated class)
        from roslib.message import get_message_class

        name = self.topics[topic]
        try:
            kind = get_message_class(name)
        except ValueError:
            kind = None
        if kind is None:
            raise BagFileError(f"{self._path}: {printable(topic)} is of {printable(name)}, which is not installed")
        sums = [md5sum for of, _, md5sum, _ in self.connections.values() if of == topic]
        if any(md5sum != kind._md5sum for md5sum in sums):  # noqa: SLF001 (genpy's name)
            why = f"{self._path}: {printable(topic)} has a different definition of {name} than the installed one"
            raise BagFileError(why)
        return kind
