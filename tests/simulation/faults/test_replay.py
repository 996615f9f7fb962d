"""Sequences of the fault campaign, computed again from their logs."""

from bench.faults.replayed import ALL_RUNS, STEP, replay_seeds


def test_one_in_a_hundred_of_the_sequences_is_computed_again_bit_for_bit():
    lines = []
    tally = replay_seeds(range(0, ALL_RUNS * STEP, 100 * STEP), lines.append)
    assert tally.runs == ALL_RUNS // 100
    assert not tally.failed, "\n".join(lines)
    assert tally.rows > 4 * 1000 * tally.runs
    assert tally.simulated > 20 * tally.seconds  # of processor time; measured: more than 100 times
