"""The programs of the Python package by their names."""

import importlib
from pathlib import Path

import robot_control

PACKAGE = Path(robot_control.__file__).parent


def module_of(name):
    """The module main.py of the program."""
    (path,) = PACKAGE.rglob(f"{name}/main.py")
    return importlib.import_module(".".join(("robot_control", *path.relative_to(PACKAGE).with_suffix("").parts)))
