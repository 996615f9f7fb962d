"""Real robots to try: where their descriptions lie, and what is true of them.

A folder per robot with `robot.urdf` and the ROS packages of its meshes, and TRUTH.json. Looked for in the folder named
by ROBOT_CORPUS, else beside the repository in `shared/robots`; tests that need them skip where they are absent.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any


def _folder() -> Path | None:
    named = os.environ.get("ROBOT_CORPUS")
    if named:
        return Path(named)
    for parent in Path(__file__).resolve().parents:
        if (parent / "shared" / "robots" / "TRUTH.json").is_file():
            return parent / "shared" / "robots"
    return None


FOLDER = _folder()
ABSENT = "no folder of real robots: set ROBOT_CORPUS"
REFUSED = ("my_bot", "p3dx_amr")  # an empty template; wheels on fixed joints


@dataclass(frozen=True)
class CorpusRobot:
    """A description and its truth (units: m, kg)."""

    name: str
    truth: dict[str, Any]

    @property
    def urdf(self) -> Path:
        assert FOLDER is not None
        return FOLDER / self.name / "robot.urdf"

    @property
    def skid_steer(self) -> bool:
        return len(self.truth["left"]) > 1


def drivable_robots() -> list[CorpusRobot]:
    """Sorted by name; empty where the folder is absent."""
    if FOLDER is None:
        return []
    truths = json.loads((FOLDER / "TRUTH.json").read_text())
    return [CorpusRobot(name, truth) for name, truth in sorted(truths.items()) if name not in REFUSED]
