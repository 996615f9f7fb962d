import numpy as np
import pytest
from robot_control.data.loop_timing import ProcessorTime, distribution, loop_timing, parse_processor_time, stolen_share
from support.recordings.synthetic_run import CYCLES, healthy_run


@pytest.fixture
def run():
    return healthy_run()


def test_a_punctual_loop_has_its_period_exactly(run):
    timing = loop_timing(run)
    assert timing.period.p50 == timing.period.max == 1000.0
    assert timing.wake_up.max == 4.0
    assert timing.sensors_to_command.p99 == 7.0
    assert (timing.missed, timing.held, timing.late_permits, timing.overruns) == (0, 0, 0, 0)
    assert timing.cycles == CYCLES


def test_one_late_wake_up_lengthens_one_period_and_shortens_the_next(run):
    run["driver_woke_ns"][100] += 300_000
    assert loop_timing(run).period.max == 1300.0
    assert loop_timing(run).wake_up.max == 304.0


def test_a_tick_that_slips_is_late_and_ends_a_long_period(run):
    run["slipped_ns"][100:] = 5e6  # the stamps stay on the grid of the simulated time
    timing = loop_timing(run)
    assert timing.wake_up.max == 5004.0
    assert timing.period.max == 6000.0
    assert timing.wake_up.p99 == 4.0
    assert timing.slipped == pytest.approx(0.005)


def test_what_is_missed_while_the_nodes_end_is_no_missed_deadline(run):
    run["command_published_ns"][-20:] = np.nan
    run["missed"][-16:] = np.arange(1, 17)
    timing = loop_timing(run)
    assert timing.missed == 0
    assert timing.cycles == CYCLES - 20


def test_a_controller_that_was_killed_and_came_back_missed_its_deadlines(run):
    run["command_published_ns"][100:120] = np.nan
    run["missed"][104:] = 16
    assert loop_timing(run).missed == 16


def test_a_lost_row_is_no_long_period(run):
    kept = {name: np.delete(values, 100) for name, values in run.items()}
    assert loop_timing(kept).period.max == 1000.0


def test_counters_are_read_at_their_end(run):
    run["missed"][500:] = 3
    run["missed"][-1] = np.nan  # the last row may be half empty
    assert loop_timing(run).missed == 3


def test_no_values_give_nan():
    assert np.isnan(distribution(np.array([np.nan])).p50)


def test_steal_is_the_eighth_field_of_proc_stat():
    stat = "cpu  100 0 50 800 20 0 5 25 7 0\ncpu0 1 2 3 4 5 6 7 8 9 10\n"
    assert parse_processor_time(stat) == ProcessorTime(total=1000, stolen=25)


def test_the_stolen_share_counts_from_before_to_after():
    assert stolen_share(ProcessorTime(1000, 10), ProcessorTime(1200, 30)) == pytest.approx(0.1)
    assert stolen_share(ProcessorTime(1000, 10), ProcessorTime(1000, 10)) == 0
