"""Draws how the latencies changed while latency.py listened."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

from robot_control.watch.latency.figures import Figures

Sample = tuple[float, str, dict[str, Figures]]
"""s since the start, node, quantity → figures of the last 10 s"""


def draw(samples: Sequence[Sample], path: Path) -> None:
    """One panel per quantity: median and p99 of each node over time."""
    quantities = sorted({quantity for _, _, figures in samples for quantity in figures})
    figure, panels = plt.subplots(len(quantities), 1, sharex=True, squeeze=False, figsize=(9, 2.2 * len(quantities)))
    for panel, quantity in zip(panels[:, 0], quantities, strict=True):
        nodes = sorted({node for _, node, figures in samples if quantity in figures})
        for node in nodes:
            rows = [(t, figures[quantity]) for t, name, figures in samples if name == node and quantity in figures]
            times = [t for t, _ in rows]
            (line,) = panel.plot(times, [row.p99 for _, row in rows], label=f"{node}, p99")
            panel.plot(times, [row.p50 for _, row in rows], "--", color=line.get_color(), label=f"{node}, median")
        panel.set_ylabel(f"{quantity} [µs]")
        panel.legend(fontsize="x-small")
    panels[-1, 0].set_xlabel("time [s]; each value covers the 10 s before it")
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
