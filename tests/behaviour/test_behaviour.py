"""The default robot behaves as recorded, and the sums would show a difference."""

import os
import subprocess
import sys
from pathlib import Path

import behaviour
import numpy as np
import pytest

from bench.robot_corpus import DIFFBOT

JOINTS = ("left", "right")
FLAGS = set(Path("/proc/cpuinfo").read_text().split())
COLUMNS = [
    *behaviour.ROW_QUANTITIES,
    *(f"{joint}_{quantity}" for joint in JOINTS for quantity in behaviour.JOINT_QUANTITIES),
]


@pytest.fixture
def sums():
    """The recorded sums; skips if they cannot be compared."""
    kind, sums = behaviour.recorded()
    if kind != behaviour.libm_kind():
        pytest.skip(f"sums were recorded with {kind}, this is {behaviour.libm_kind()}; {behaviour.REMEDY}")
    return sums


@pytest.fixture
def log():
    """Ten rows in which every column differs from every other one."""
    return {name: np.arange(10.0) + 100 * i for i, name in enumerate(COLUMNS)}


def sum_of(*parts):
    result = behaviour.QuantitySum(JOINTS)
    for part in parts:
        result.add(part)
    return result.digest()


def kind_without(instructions):
    """The kind of libm of a process whose libm does not use these instructions."""
    environment = {**os.environ, "GLIBC_TUNABLES": f"glibc.cpu.hwcaps={instructions}"}
    environment["PYTHONPATH"] = os.pathsep.join(sys.path)
    program = "import behaviour; print(behaviour.libm_kind())"
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_a_drive_gives_its_recorded_sum(sums):
    assert behaviour.drive_healthy(DIFFBOT, behaviour.HEALTHY_SEED) == sums[behaviour.healthy_name(DIFFBOT)]


def test_a_drive_with_faults_gives_its_recorded_sum(sums):
    assert behaviour.drive_with_faults(DIFFBOT, behaviour.FAULTY_SEED) == sums[behaviour.faulty_name(DIFFBOT)]


def test_two_runs_give_one_sum_and_another_seed_another():
    """This holds on every processor."""
    first = behaviour.drive_healthy(DIFFBOT, 1)
    assert first == behaviour.drive_healthy(DIFFBOT, 1)
    assert first != behaviour.drive_healthy(DIFFBOT, 2)


def test_every_run_has_a_recorded_sum():
    assert set(behaviour.recorded()[1]) == set(behaviour.runs())


@pytest.mark.parametrize("name", COLUMNS)
def test_the_last_bit_of_one_value_changes_the_sum(log, name):
    before = sum_of(log)
    log[name][4] = np.nextafter(log[name][4], np.inf)
    assert sum_of(log) != before


def test_two_quantities_that_are_exchanged_change_the_sum(log):
    exchanged = {**log, "truth_x": log["truth_y"], "truth_y": log["truth_x"]}
    assert sum_of(exchanged) != sum_of(log)


def test_how_the_log_stores_its_rows_does_not_count(log):
    parts = [{name: values[rows] for name, values in log.items()} for rows in (slice(0, 3), slice(3, 10))]
    assert sum_of(*parts) == sum_of(log)
    assert sum_of({"another": np.zeros(10), **dict(reversed(log.items()))}) == sum_of(log)


def test_equal_values_have_equal_sums(log):
    log["truth_x"][:2] = 0.0, np.nan
    before = sum_of(log)
    log["truth_x"][:2] = -0.0, -np.nan
    assert sum_of(log) == before


def test_a_renamed_field_keeps_the_sum(log, monkeypatch):
    before = sum_of(log)
    log["position_x"] = log.pop("truth_x")
    for joint in JOINTS:
        log[f"torque[{joint}]"] = log.pop(f"{joint}_effort")
    monkeypatch.setattr(behaviour, "RENAMED", {"truth_x": "position_x", "effort": "torque[{joint}]"})
    assert sum_of(log) == before


def test_a_field_that_is_missing_is_named(log):
    del log["left_effort"]
    with pytest.raises(behaviour.MissingColumnError, match="no column left_effort; name its new one in RENAMED"):
        sum_of(log)


def test_the_kind_of_libm_does_not_name_instructions_that_change_no_bit():
    assert kind_without("-AVX512F,-AVX512VL,-AVX512DQ,-AVX512BW") == behaviour.libm_kind()


@pytest.mark.skipif(not {"fma", "avx2"} <= FLAGS, reason="this processor's libm has no routine with FMA")
def test_the_kind_of_libm_shows_routines_that_round_otherwise():
    assert kind_without("-FMA") != behaviour.libm_kind()
