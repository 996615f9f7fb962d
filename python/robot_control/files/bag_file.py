"""Messages of a ROS bag that another program wrote. The file is checked as a whole before any of it is used."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

from robot_control._robot_control import BagError, BagReader
from robot_control.files.files import MAX_TABLE, check_input, printable, utf8


class BagFileError(ValueError):
    """The bag is not read; the message names it, with byte and field where its structure is not sound."""


class BagFile:
    """The topics and messages of one bag. Needs neither a running ROS nor rosbag.

    Message classes are the installed ones: a definition out of the file would be made into a program.
    """

    topics: dict[str, str]
    """type by topic"""
    cut: str
    """which part of a file without a valid end is read; empty: it is whole"""

    def __init__(self, path: Path) -> None:
        """Reads and checks the whole file.

        Raises:
            InputFileError: no regular file, or too large.
            BagFileError: it is no sound bag.
            OSError: it cannot be opened.
        """
        check_input(path, MAX_TABLE)
        with path.open("rb"):
            pass
        self._path = path
        try:
            self._reader = BagReader(utf8(path))
        except (BagError, RuntimeError) as error:
            raise BagFileError(f"{path} is no ROS 1 bag that can be read: {error}") from None
        self.cut = self._reader.cut
        if self.cut and self._reader.count == 0:
            raise BagFileError(f"{path} holds no message that can be read: {self.cut}")
        self.topics = {}
        self._connections: dict[str, dict[int, str]] = {}  # md5sum by number, by topic
        for number, fields in self._reader.connections.items():
            topic, kind = self._word(fields["topic"]), self._word(fields["type"])
            if self.topics.setdefault(topic, kind) != kind:
                raise BagFileError(f"{path}: {printable(topic)} has messages of two types")
            self._connections.setdefault(topic, {})[number] = self._word(fields["md5sum"])

    def raw(self, topics: Iterable[str]) -> Iterator[tuple[str, int, bytes]]:
        """Topic, time of reception [ns] and serialized message, in the order of the file."""
        topic_of = {number: topic for topic in topics for number in self._connections[topic]}
        for chunk in range(self._reader.chunks):
            for number, time_ns, data in self._reader.messages(chunk, set(topic_of)):
                yield topic_of[number], time_ns, data

    def messages(self, topic: str) -> Iterator[tuple[Any, int]]:
        """Message and time of reception [ns].

        Raises:
            BagFileError: no such type is installed, or with another definition; a message is no such message.
        """
        try:
            from genpy import DeserializationError
        except ImportError as error:
            raise BagFileError(f"bags need Debian's python3-rosbag: {error}. Run it with /usr/bin/python3") from None
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

    def _class_of(self, topic: str) -> Any:  # noqa: ANN401 (a generated class)
        from roslib.message import get_message_class

        name = self.topics[topic]
        try:
            kind = get_message_class(name)
        except ValueError:
            kind = None
        if kind is None:
            raise BagFileError(f"{self._path}: {printable(topic)} is of {printable(name)}, which is not installed")
        if any(md5sum != kind._md5sum for md5sum in self._connections[topic].values()):  # noqa: SLF001 (genpy's name)
            raise BagFileError(
                f"{self._path}: {printable(topic)} has another definition of {name} than the installed one"
            )
        return kind

    def _word(self, text: bytes) -> str:
        try:
            return text.decode()
        except UnicodeDecodeError:
            raise BagFileError(f"{self._path}: a connection has the name {printable(repr(text))}") from None
