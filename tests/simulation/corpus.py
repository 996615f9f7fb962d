"""Finds descriptions of real robots, and their true data.

bench/robot_corpus.py defines the search for the folder. Tests that need it skip if it is absent.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench.robot_corpus import corpus_folder, robot_names

FOLDER = corpus_folder()
ABSENT = "no folder of real robots: set ROBOT_CORPUS"


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
    """The robots, sorted by name; empty if the folder is absent."""
    if FOLDER is None:
        return []
    truths = json.loads((FOLDER / "TRUTH.json").read_text())
    return [CorpusRobot(name, truths[name]) for name in robot_names()[1:]]
