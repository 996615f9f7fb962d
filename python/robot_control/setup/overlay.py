"""YAML that is laid over the parameters."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import-untyped]

from robot_control.files.files import escaped, write_text


@dataclass(frozen=True)
class Outcome:
    """The report to print and the parameters to write."""

    table: str
    warnings: list[str]
    yaml: str

    def deliver(self, path: Path, then: str) -> None:
        """Prints the report and writes the parameters; `then`: the steps after rosparam load. Raises OSError."""
        print("\n".join([self.table, *(escaped(f"! {sentence}") for sentence in self.warnings)]))
        write_text(path, self.yaml)
        print(escaped(f"wrote {path}: rosparam load it (in the robot's namespace), {then}"))


def to_yaml(lines: Iterable[str], tree: Mapping[str, Any]) -> str:
    """The numbers of the tree, below `lines` as comments."""
    plain = json.loads(json.dumps(tree))  # numbers of numpy are none for PyYAML
    text: str = yaml.safe_dump(plain, sort_keys=False)
    return "".join(f"# {line}".rstrip() + "\n" for line in lines) + text
