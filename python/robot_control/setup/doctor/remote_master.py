"""The address of the ROS master in this terminal."""

import urllib.parse

from robot_control.setup.doctor.system import System

DEFAULT = "http://localhost:11311"
LOCAL = ("localhost", "127.0.0.1", "127.0.1.1", "::1")


def address(system: System) -> tuple[str, int] | None:
    """Host and port of ROS_MASTER_URI; None if it is no address."""
    try:
        parts = urllib.parse.urlsplit(system.environment.get("ROS_MASTER_URI") or DEFAULT)
        port = parts.port
    except ValueError:
        return None
    return (parts.hostname, port) if parts.scheme == "http" and parts.hostname and port else None


def remote_host(system: System) -> str:
    """The host of the master, if it is not this machine; else ""."""
    found = address(system)
    own = system.text("proc/sys/kernel/hostname") or ""
    return "" if found is None or found[0] in (*LOCAL, own) or found[0].startswith("127.") else found[0]
