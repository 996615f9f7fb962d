"""A pad of this machine that pad.py reads with the library of tests/support/fake_evdev."""

import json
import os
import tempfile
import unittest
from pathlib import Path

from system.system_support import Program, repository

ENABLE = 0x134
"""The fifth of the codes from 0x130: button 4"""


class FakePad:
    """The pad, until the end of the test."""

    def __init__(self, test: unittest.TestCase) -> None:
        self._test, folder = test, tempfile.TemporaryDirectory()
        test.addCleanup(folder.cleanup)
        self.device = Path(folder.name, "event5")

    def plug(self, *held: int, **axes: int) -> None:
        """Sets its state at once as a whole; the axes are forward and sideways, 0 to 255, 128 in the middle."""
        new = self.device.with_suffix(".new")
        numbers = {"0": 128, "1": axes.get("forward", 128), "2": 128, "3": axes.get("sideways", 128)}
        new.write_text(json.dumps({"axes": numbers, "held": held}))
        new.replace(self.device)

    def program(self, *arguments: str) -> Program:
        """pad.py, which reads it."""
        fake = repository() / "tests" / "support" / "fake_evdev"
        path = f"{fake}:{os.environ.get('PYTHONPATH', '')}"
        program = Program("pad.py", *arguments, environment={"FAKE_PAD": str(self.device), "PYTHONPATH": path})
        self._test.addCleanup(program.end)
        return program
