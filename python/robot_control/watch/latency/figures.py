"""Reads the figures that nodes report on /diagnostics; no ROS in here."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

QUANTITIES = ("period", "wake_up", "execution", "sensor_to_command", "sensor_to_torque")
NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?"
FIGURE = re.compile(
    rf"min (?P<min>{NUMBER}) p50 (?P<p50>{NUMBER}) p99 (?P<p99>{NUMBER}) "
    rf"p99\.9 (?P<p999>{NUMBER}) max (?P<max>{NUMBER}) n (?P<samples>\d{{1,18}})"
)
COUNTERS = ("skipped_cycles", "page_faults", "waits_outside_loop", "forced_switches", "run_queue_10s_us")


@dataclass(frozen=True)
class Figures:
    """Figures of one duration, µs; quantiles have a relative error of at most 0.8 %."""

    samples: int
    min: float
    p50: float
    p99: float
    p999: float
    max: float


def parse_figures(text: str) -> Figures | None:
    """Reads "min 2.1 p50 8.4 p99 31.0 p99.9 55.2 max 120.3 n 10000"; None for any other text."""
    found = FIGURE.fullmatch(text.strip())
    if found is None:
        return None
    return Figures(int(found["samples"]), *(float(found[key]) for key in ("min", "p50", "p99", "p999", "max")))


def figures_of(values: Mapping[str, str], suffix: str = "_10s_us") -> dict[str, Figures]:
    """Quantity → figures of one node's entry, of the last 10 s, or with the suffix "_us" since its start."""
    read = {quantity: parse_figures(values.get(quantity + suffix, "")) for quantity in QUANTITIES}
    return {quantity: figures for quantity, figures in read.items() if figures is not None and figures.samples}


def table(nodes: Mapping[str, Mapping[str, str]]) -> list[str]:
    """The lines of the screen: node → its values on /diagnostics."""
    lines = [f"{'last 10 s, µs':42}{'p50':>9}{'p99':>9}{'p99.9':>9}{'max':>9}{'max ever':>10}"]
    for node, values in nodes.items():
        recent, ever = figures_of(values), figures_of(values, "_us")
        for quantity, figures in recent.items():
            shown = (figures.p50, figures.p99, figures.p999, figures.max)
            numbers = "".join(f"{number:9.1f}" for number in shown)
            longest = max(figures.max, ever[quantity].max) if quantity in ever else figures.max
            lines.append(f"{node + ' ' + quantity:42}{numbers}{longest:10.1f}")
        counts = [f"{key} {values[key]}" for key in COUNTERS if key in values]
        if counts:
            lines.append(f"  {', '.join(counts)}")
    return lines
