"""A ROS 1 bag as MCAP: the same messages, their definitions beside them (mcap.dev/spec/registry, ros1)."""

from __future__ import annotations

from pathlib import Path

from robot_control._robot_control import BagReader
from robot_control.files.files import utf8
from robot_control.ui.pypi import use_packages


class McapError(RuntimeError):
    """No MCAP can be written."""


def write_mcap(source: Path, target: Path) -> None:
    """Raises McapError, BagError, OSError."""
    use_packages("export")
    try:
        from mcap.writer import Writer
    except ImportError as error:
        raise McapError(f"an MCAP needs PyPI's package mcap ({error}): scripts/setup --export") from None
    bag = BagReader(utf8(source))
    with target.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros1", library="robot_control export.py")
        channels = {}
        for number, connection in bag.connections.items():
            schema = writer.register_schema(connection["type"].decode(), "ros1msg", connection["definition"])
            channels[number] = writer.register_channel(connection["topic"].decode(), "ros1", schema)
        for chunk in range(bag.chunks):
            for number, time_ns, data in bag.messages(chunk, set(channels)):
                writer.add_message(channels[number], log_time=time_ns, data=data, publish_time=time_ns)
        writer.finish()
