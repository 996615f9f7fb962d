"""A ROS 1 bag as MCAP: the same messages, their definitions beside them (mcap.dev/spec/registry, ros1)."""

import io
from pathlib import Path
from typing import Any

from std_msgs.msg import String

from robot_control.data.export.topics import Topics
from robot_control.data.run_log import is_run_log, read_run
from robot_control.files.bag_file import BagFile
from robot_control.ui.pypi import use_packages


class McapError(RuntimeError):
    """No MCAP can be written."""


def write_mcap(source: Path, target: Path) -> str:
    """Writes the messages of the bag; of a run.bag also what the robot publishes, with its URDF.
    Returns `BagFile.cut`. Raises McapError, BagFileError, LogError, OSError.
    """
    use_packages("export")
    try:
        from mcap.writer import Writer
    except ImportError as error:
        raise McapError(f"an MCAP needs PyPI's package mcap ({error}): scripts/setup --export") from None
    bag = BagFile(source)
    with target.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros1", library="robot_control export.py")
        channels = {}
        for number, (topic, kind, _, definition) in bag.connections.items():
            schema = writer.register_schema(kind, "ros1msg", definition.encode())
            channels[number] = writer.register_channel(topic, "ros1", schema)
        for number, time_ns, data in bag.raw(bag.topics):
            writer.add_message(channels[number], log_time=time_ns, data=data, publish_time=time_ns)
        if is_run_log(source):
            _add_topics(writer, source)
        writer.finish()
    return bag.cut


def _add_topics(writer: Any, source: Path) -> None:  # noqa: ANN401 (of the package)
    run = read_run(source)
    topics = Topics(run)
    channels: dict[str, int] = {}

    def add(topic: str, message: Any, time_ns: int) -> None:  # noqa: ANN401 (genpy has no types)
        if topic not in channels:
            kind, definition = message._type, message._full_text  # noqa: SLF001 (genpy's public names)
            schema = writer.register_schema(kind, "ros1msg", definition.encode())
            channels[topic] = writer.register_channel(topic, "ros1", schema)
        data = io.BytesIO()
        message.serialize(data)
        writer.add_message(channels[topic], log_time=time_ns, data=data.getvalue(), publish_time=time_ns)

    add("/robot_description", String(run.header["urdf"]), round(run.ros_time[0] * 1e9))
    for row in range(run.ros_time.size):
        for topic, message, stamp in topics.of_row(row):
            add(f"/{topic}", message, stamp.to_nsec())
