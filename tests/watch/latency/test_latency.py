"""The figures of latency.py and the references of scripts/bench realtime, from texts; no ROS, no clock."""

import numpy as np
import pytest
from robot_control.watch.latency.figures import Figures, figures_of, parse_figures, table
from robot_control.watch.latency.picture import draw

from bench.realtime.chain import CHAIN, between
from bench.realtime.jitter import median_interval, wake_up
from bench.realtime.machine import parse_histogram

TEXT = "min 2.1 p50 8.4 p99 31.0 p99.9 55.2 max 120.3 n 10000"
VALUES = {
    "wake_up_us": TEXT,
    "wake_up_10s_us": TEXT.replace("120.3", "60.0"),
    "period_10s_us": "min 0.0 p50 0.0 p99 0.0 p99.9 0.0 max 0.0 n 0",
    "page_faults": "3",
}


def test_reads_the_figures_of_a_node():
    assert parse_figures(TEXT) == Figures(10000, 2.1, 8.4, 31.0, 55.2, 120.3)
    assert parse_figures("waiting") is None


def test_a_quantity_without_samples_is_left_out():
    assert list(figures_of(VALUES)) == ["wake_up"]


def test_the_table_shows_the_last_ten_seconds_and_the_worst_ever():
    lines = table({"state_estimator": VALUES})
    assert lines[1].split() == ["state_estimator", "wake_up", "8.4", "31.0", "55.2", "60.0", "120.3"]
    assert lines[2].split() == ["page_faults", "3"]


def test_draws_the_figures_over_time(tmp_path):
    draw([(1.0, "driver", figures_of(VALUES)), (2.0, "driver", figures_of(VALUES))], tmp_path / "latency.png")
    assert (tmp_path / "latency.png").stat().st_size > 1000


def test_reads_the_histogram_of_cyclictest():
    text = "# Histogram\n000004 000002\n000005 000001\n# Total: 000000003\n# Histogram Overflows: 00001\n"
    assert parse_histogram(text).tolist() == [4.0, 4.0, 5.0, 20000.0]
    with pytest.raises(RuntimeError, match="measured nothing"):
        parse_histogram("# Histogram\n")


def test_a_tick_that_slips_was_late_by_what_slipped():
    rows = {"driver_woke_ns": np.array([1000.0, 2000.0, 0.0]), "slipped_ns": np.array([0.0, 0.0, 5e6])}
    assert wake_up(rows).tolist() == [1.0, 2.0, 5000.0]


def test_the_chain_is_the_median_over_the_cycles_that_hold_both_stamps():
    rows = {"driver_woke_ns": np.array([0.0, 0.0, 0.0, 0.0]), "command_published_ns": np.array([1e3, np.nan, 9e3, 5e3])}
    assert between(rows, CHAIN) == 5.0


@pytest.mark.parametrize(("count", "rank"), [(10, 1), (20, 5)])
def test_the_interval_of_a_median_covers_it_with_95_percent(count, rank):
    """Ranks of a table of the sign test: 2 of 10 (97.9 %) and 6 of 20 (95.9 %), counted from 1."""
    low, middle, high = median_interval(list(range(count)))
    assert (low, middle, high) == (rank, (count - 1) / 2, count - 1 - rank)
