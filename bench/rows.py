"""Rows of the table that scripts/bench prints."""

from __future__ import annotations

from typing import Any


def compared(name: str, value: float, unit: str, reference: float, reference_name: str) -> dict[str, Any]:
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


def plain(name: str, value: float, unit: str) -> dict[str, Any]:
    """A figure with nothing beside it."""
    return compared(name, value, unit, 0, "none")


def bounded(name: str, value: float, unit: str, bound: float) -> dict[str, Any]:
    """A figure beside its bound."""
    return compared(name, value, unit, bound, "the bound")
