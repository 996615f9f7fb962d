"""Names in the launch files. The compiled part names the nodes, too, but it may not be built yet."""

import re
from pathlib import Path

from robot_control.installed_files import share_file

_TEXTS = [Path(share_file(f"launch/{name}.launch")).read_text() for name in ("robot", "sim")]


def _found(pattern: str) -> frozenset[str]:
    return frozenset(name for text in _TEXTS for name in re.findall(pattern, text))


NODES = _found(r'pkg="robot_control" type="(\w+)"') | _found(r'name="program" (?:default|value)="(\w+)"')
"""Programs of nodes, which are also the names of the nodes"""
SET_AT_LAUNCH = _found(r'<param name="([\w/]+)"')
"""Parameters that each launch sets again: robot/clock, or config of a node"""
