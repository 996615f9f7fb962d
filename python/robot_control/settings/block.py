"""The parameters that a robot runs with."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """A parameter file and the values laid over it, (dotted path, YAML text) each."""

    path: str
    values: tuple[tuple[str, str], ...]
