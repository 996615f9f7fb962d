"""A ROS 1 bag as MCAP: the same messages, their definitions beside them (mcap.dev/spec/registry, ros1)."""

from pathlib import Path

from robot_control.files.bag_file import BagFile
from robot_control.ui.pypi import use_packages


class McapError(RuntimeError):
    """No MCAP can be written."""


def write_mcap(source: Path, target: Path) -> str:
    """Returns `BagFile.cut`. Raises McapError, BagFileError, OSError."""
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
        writer.finish()
    return bag.cut
