"""Writes results of benchmarks to docs/evidence/NAME.md, between `<!-- scripts/bench NAME -->` and `<!-- end -->`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

EVIDENCE = Path(__file__).parents[1] / "docs" / "evidence"
ALLOWED = "what is allowed"
"""reference_name of a figure that is judged by a bound"""
NO_BOUND = "no bound"
"""that of a figure beside such figures that has no bound"""


def table(result: dict[str, Any]) -> str:
    """Figures with bounds side by side, robot by robot; all others one by one, with the ratio to their reference."""
    rows = result["rows"]
    bounded = bool(rows) and all(row["reference_name"] in (ALLOWED, NO_BOUND) for row in rows)
    parts = ["```text\n" + "\n".join(result["table"]) + "\n```"] if result.get("table") else []
    parts.append(_by_robot(rows) if bounded else _one_by_one(rows))
    if result.get("not_judged"):
        parts.append(f"Not measured, for want of their descriptions: {', '.join(result['not_judged'])}.")
    return "\n\n".join(parts)


def _by_robot(rows: Sequence[dict[str, Any]]) -> str:
    """Names are "robot figure". Bounds may depend on the robot, so the worst ratio to them stands at the end."""
    figures = list(dict.fromkeys(row["name"].split(" ", 1)[1] for row in rows))
    robots = list(dict.fromkeys(row["name"].split(" ", 1)[0] for row in rows))
    by_name = {row["name"]: row for row in rows}
    lines = []
    for figure in figures:
        found = [by_name.get(f"{robot} {figure}") for robot in robots]
        unit = next(row["unit"] for row in found if row)
        cells = ["–" if row is None else f"{row['value']:.3g}" for row in found]
        worst = max(row["ratio"] for row in found if row)
        judged = [row for row in found if row and row["reference_name"] == ALLOWED]
        bounds = " … ".join(sorted({f"{row['reference']:.3g}" for row in judged}, key=float))
        share = f"{100 * worst:.0f} %" if judged else ""
        lines.append([f"{figure} [{unit}]" if unit else figure, bounds, *cells, share])
    return _markdown(["figure", "allowed", *robots, "worst, of what is allowed"], lines)


def _one_by_one(rows: Sequence[dict[str, Any]]) -> str:
    lines = []
    for row in rows:
        compared = row["reference"] != 0
        ratio = f"{row['ratio']:.3g} of {row['reference_name']}" if compared else ""
        lines.append([row["name"], f"{row['value']:.4g} {row['unit']}".strip(), ratio])
    return _markdown(["figure", "value", "ratio"], lines)


def _markdown(head: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    rows = [head, ["---"] * len(head), *([cell.replace("|", "\\|") for cell in line] for line in lines)]
    return "\n".join(f"| {' | '.join(row)} |" if row[0] != "---" else f"|{'|'.join(row)}|" for row in rows)


def replaced(page: str, result: dict[str, Any]) -> str:
    """`page` with the table of this benchmark between its marks; a page without them gets them at its end."""
    begin, end = f"<!-- scripts/bench {result['bench']} -->\n", "<!-- end -->"
    if begin not in page:
        page += f"\n{begin}{end}\n"
    place = re.compile(f"{re.escape(begin)}.*?(?={re.escape(end)})", re.DOTALL)
    return place.sub(lambda _: f"{begin}\n{table(result)}\n\n", page)


def write(results: Sequence[dict[str, Any]]) -> None:
    """Writes each result to the file of its benchmark, which is created where it does not exist."""
    for result in results:
        path = EVIDENCE / f"{result['bench']}.md"
        page = path.read_text() if path.exists() else f"# scripts/bench {result['bench']}\n"
        path.write_text(replaced(page, result))
