"""Packages of PyPI with which tests compare: libraries of others."""

import importlib
import os
from types import ModuleType

import pytest
from robot_control.ui.pypi import use_packages


def imported(module: str, section: str, package: str = "") -> ModuleType:
    """The module of a package that `scripts/setup --SECTION` installs.

    Without it the test is skipped by name, but in a nightly run, which installs all of them.
    """
    use_packages(section)
    try:
        return importlib.import_module(module)
    except ImportError:
        if os.environ.get("CI") and os.environ.get("ROBOT_CONTROL_NIGHTLY"):
            raise
        pytest.skip(f"{package or module} of PyPI is not installed: scripts/setup --{section}", allow_module_level=True)
