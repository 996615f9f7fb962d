"""`scripts/bench navigation`: maps and localisation, in virtual time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

Say = Callable[[str], None]
PARTS = ("map", "localization")


def bench(parts: Sequence[str], first: int, runs: int | None, say: Say) -> tuple[dict[str, Any], bool]:
    """The rows of these parts, and whether all bounds hold. `runs`: tours of each scene, or drives of each kind.

    Raises:
        RuntimeError: MRPT is missing.
    """
    try:
        from bench.navigation import localizing, mapping
    except ImportError:
        raise RuntimeError("MRPT is not installed: scripts/setup --navigation, then build again") from None
    rows: list[dict[str, Any]] = []
    if "map" in parts:
        rows += mapping.rows_of(first, runs or mapping.RUNS, say)
    if "localization" in parts:
        rows += localizing.rows_of(first, runs or localizing.DRIVES, say)
    return {"bench": "navigation", "rows": rows}, all(row["value"] <= row["reference"] for row in rows)
