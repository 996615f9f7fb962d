"""The parts of scripts/bench realtime."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from bench.realtime import chain, cost, dds, jitter, scale
from bench.realtime.jitter import BLOCKS
from bench.realtime.machine import require_programs
from bench.rows import Result, Say

PARTS = {"jitter": jitter.bench, "chain": chain.bench, "cost": cost.bench, "scale": scale.bench, "dds": dds.bench}


def bench(parts: Sequence[str], blocks: int, programs: Path, say: Say) -> Result:
    """The table of these parts, and whether all figures meet their bounds."""
    require_programs()
    if "dds" in parts:
        dds.require_bridge(programs.parent)
    blocks = blocks or BLOCKS
    rows: list[dict[str, Any]] = []
    good = True
    for part in parts:
        found, met = PARTS[part](blocks, programs, say)
        rows += [{**row, "name": f"{part}: {row['name']}"} for row in found]
        good = good and met
    return {"bench": "realtime", "rows": rows}, good
