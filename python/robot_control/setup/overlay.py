"""YAML that is laid over the parameters."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

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
    return "".join(f"# {line}".rstrip() + "\n" for line in lines) + "".join(_yaml_lines(tree, ""))


def _yaml_lines(tree: Mapping[str, Any], indent: str) -> Iterator[str]:
    for key, value in tree.items():
        if isinstance(value, Mapping):
            yield f"{indent}{key}:\n"
            yield from _yaml_lines(value, indent + "  ")
        else:
            yield f"{indent}{key}: {_float(value)}\n"


def _float(value: float) -> str:
    """A number that YAML 1.1, ROS' own, reads as a real one: 1.0e-05, not 1e-05."""
    text = repr(float(value))
    mantissa, exponent, power = text.partition("e")
    return mantissa + (".0" if exponent and "." not in mantissa else "") + exponent + power
