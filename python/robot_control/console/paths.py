"""The folder of the console's own files."""

from pathlib import Path

from robot_control.blackbox.main import LOGS as GIVEN

LOGS = GIVEN.expanduser()


def users_file() -> Path:
    """The users, unless --users names another file."""
    return LOGS / "console_users.json"
