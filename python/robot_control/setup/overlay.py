"""YAML that is laid over the parameters."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any


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
