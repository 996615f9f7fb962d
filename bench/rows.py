"""Rows of the table that scripts/bench prints."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

Row = dict[str, Any]
Result = tuple[dict[str, Any], bool]
"""the printed content, and whether every bound holds"""
Say = Callable[[str], None]
"""Receives progress and what breaks a bound"""


def compared(name: str, value: float, unit: str, reference: float, reference_name: str) -> Row:
    """A figure beside the reference of the same run."""
    ratio = value / reference if reference else 0.0
    return {
        "name": name,
        "value": value,
        "unit": unit,
        "reference": reference,
        "reference_name": reference_name,
        "ratio": ratio,
    }


def plain(name: str, value: float, unit: str) -> Row:
    """A figure with nothing beside it."""
    return compared(name, value, unit, 0, "none")


def bounded(name: str, value: float, unit: str, bound: float) -> Row:
    """A figure beside its bound."""
    return compared(name, value, unit, bound, "the bound")


def judged(bench: str, rows: Sequence[Row]) -> Result:
    """The result of these rows, of which those whose name begins with "lowest" may not be below their reference."""
    good = (
        row["value"] >= row["reference"] if row["name"].startswith("lowest") else row["value"] <= row["reference"]
        for row in rows
    )
    return {"bench": bench, "rows": rows}, all(good)
