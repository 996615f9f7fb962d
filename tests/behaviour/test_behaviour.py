"""The default robot behaves as recorded, and the sums would show it if it did not."""

import behaviour
import pytest
from lab.robot_corpus import DIFFBOT

INTEL = "vendor_id\t: GenuineIntel\nflags\t\t: fpu avx2 sse fma\n"


@pytest.fixture
def sums():
    """The recorded ones; skips where they cannot be compared."""
    kind, sums = behaviour.recorded()
    if kind != behaviour.processor():
        pytest.skip(f"sums were recorded on {kind}, this is {behaviour.processor()}")
    return sums


def test_a_drive_gives_its_recorded_sum(sums):
    assert behaviour.drive_healthy(DIFFBOT, behaviour.HEALTHY_SEED) == sums[behaviour.healthy_name(DIFFBOT)]


def test_a_drive_with_faults_gives_its_recorded_sum(sums):
    assert behaviour.drive_with_faults(DIFFBOT, behaviour.FAULTY_SEED) == sums[behaviour.faulty_name(DIFFBOT)]


def test_two_runs_give_one_sum_and_another_seed_another():
    """On every processor."""
    first = behaviour.drive_healthy(DIFFBOT, 1)
    assert first == behaviour.drive_healthy(DIFFBOT, 1)
    assert first != behaviour.drive_healthy(DIFFBOT, 2)


def test_the_nodes_with_faults_behave_as_those_of_the_robot_while_none_is_injected():
    sums = behaviour.recorded()[1]
    assert sums[behaviour.LAUNCH_WITH_FAULTS] == sums[behaviour.LAUNCH]


def test_every_run_has_a_recorded_sum():
    assert set(behaviour.recorded()[1]) == set(behaviour.runs())


def test_the_kind_of_processor_names_the_instructions_that_decide_about_the_last_bit():
    assert behaviour.processor(INTEL).endswith("GenuineIntel avx2 fma")
    assert behaviour.processor("").endswith("unknown")
