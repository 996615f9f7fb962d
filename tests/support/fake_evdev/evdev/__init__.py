"""The part of python3-evdev that pad.py uses, for a pad that is a JSON file of axes (0 … 255) and held buttons by code.

A file that is gone is a pad that was unplugged: the kernel then answers ENODEV. The test of a real kernel needs uinput.
"""

import errno
import json
import os
from pathlib import Path
from typing import Any, NamedTuple

BUTTONS = list(range(0x130, 0x13C))
AXES = [0, 1, 2, 3, 4, 5]


class AbsInfo(NamedTuple):
    """Range and value of an axis."""

    value: int
    min: int
    max: int


def _path() -> Path:
    return Path(os.environ["FAKE_PAD"])


def list_devices() -> list[str]:
    """Paths of the pads that are plugged in."""
    return [str(_path())] if _path().exists() else []


class InputDevice:
    """One pad."""

    name = "Fake pad"

    def __init__(self, path: str) -> None:
        self._path = Path(path)
        self._read()

    def _read(self) -> dict[str, Any]:
        try:
            state: dict[str, Any] = json.loads(self._path.read_text())
        except FileNotFoundError:
            raise OSError(errno.ENODEV, "No such device") from None
        return state

    def capabilities(self) -> dict[int, Any]:
        """Buttons, and axes with their ranges."""
        return {1: BUTTONS, 3: [(code, self.absinfo(code)) for code in AXES]}

    def active_keys(self) -> list[int]:
        """Codes of the held buttons."""
        held: list[int] = self._read()["held"]
        return held

    def absinfo(self, code: int) -> AbsInfo:
        """One axis; in its middle where the file says nothing."""
        return AbsInfo(self._read()["axes"].get(str(code), 128), 0, 255)
