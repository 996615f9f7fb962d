"""A parameter file and the values laid over it, as the compiled part takes them: (dotted path, YAML text) each."""

import json
from collections.abc import Iterator, Mapping
from os import PathLike
from typing import Any

import numpy as np

from robot_control.files.files import utf8
from robot_control.installed_files import share_file

DEFAULTS = "config/robot_params.yaml"


def layered(
    params: str | PathLike[str] | Mapping[str, Any] | None, urdf: str | PathLike[str] | None = None
) -> tuple[str, list[tuple[str, str]]]:
    """The file `params`, or the installed one with the nested dict `params` over it; `urdf` overrides `robot.urdf`.

    Raises:
        InputFileError: a text or a name is not UTF-8.
    """
    values = list(leaves(params)) if isinstance(params, Mapping) else []
    path = share_file(DEFAULTS) if params is None or isinstance(params, Mapping) else utf8(params)
    if urdf is not None:
        values.append(("robot.urdf", utf8(urdf)))
    return path, values


def leaves(tree: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, str]]:
    """Dotted path and YAML text of every value of a nested dict."""
    for key, value in tree.items():
        path = f"{prefix}{key}"
        if isinstance(value, Mapping):
            yield from leaves(value, path + ".")
        else:
            yield utf8(path), utf8(_yaml(value))


def flow_text(value: object) -> str:
    """YAML text of a nested dict in braces; texts quoted, so that none can be taken for anything else."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(key))}: {flow_text(item)}" for key, item in value.items()) + "}"
    return json.dumps(value) if isinstance(value, str) else _yaml(value)


def _yaml(value: object) -> str:
    """YAML text of a number, a truth value, a text or a list of them."""
    if isinstance(value, bool | np.bool_):
        return "true" if value else "false"
    if isinstance(value, float | np.floating):
        return repr(float(value)) if np.isfinite(value) else {"nan": ".nan", "inf": ".inf"}.get(str(value), "-.inf")
    if isinstance(value, list | tuple | np.ndarray):
        return "[" + ", ".join(json.dumps(item) if isinstance(item, str) else _yaml(item) for item in value) + "]"
    return str(value)
