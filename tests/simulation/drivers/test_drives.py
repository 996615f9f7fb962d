"""The closed loop through motor drives on a simulated CAN bus: drivers, frames, devices, in virtual time."""

import math
import time
from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop, ParameterError
from robot_control.installed_files import share_file
from robot_control.loop.signal_names import number_of

DIALECTS = ("odrive", "cia402", "vesc")
COMMAND = (0.5, 0.2)
"""m/s, rad/s"""
STOPPED, FAULT = (number_of("SupervisorState", name) for name in ("STOPPED", "FAULT"))


def drive_file(dialect):
    return share_file(f"config/drives/{dialect}.yaml")


def driven(loop, seconds=10.0):
    log = loop.run(seconds, COMMAND)
    assert not np.isin(log["supervisor_state"], (STOPPED, FAULT)).any()
    return log


def odometry_error(log):
    return math.hypot(*(log[f"estimate_{name}"][-1] - log[f"truth_{name}"][-1] for name in ("x", "y")))


SEEDS = range(3, 7)


@pytest.fixture(scope="module")
def direct():
    return [driven(ClosedLoop(seed=seed)) for seed in SEEDS]


@pytest.mark.parametrize("dialect", DIALECTS)
def test_the_robot_ends_where_it_ends_without_a_bus(dialect, direct):
    logs = [driven(ClosedLoop(seed=seed, drives=drive_file(dialect))) for seed in SEEDS]
    for log, without in zip(logs, direct, strict=True):
        assert math.hypot(*(log[f"truth_{axis}"][-1] - without[f"truth_{axis}"][-1] for axis in "xy")) < 0.002
    errors, of_direct = (math.hypot(*map(odometry_error, runs)) for runs in (logs, direct))
    assert errors < 1.2 * of_direct


@pytest.mark.parametrize("dialect", DIALECTS)
def test_the_same_seed_gives_the_same_bytes(dialect):
    first, second = (driven(ClosedLoop(seed=3, drives=drive_file(dialect)), 2.0) for _ in range(2))
    assert all(first[name].tobytes() == second[name].tobytes() for name in first)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_it_stands_after_a_stop(dialect):
    loop = ClosedLoop(seed=3, drives=drive_file(dialect))
    driven(loop, 3.0)
    loop.e_stop()
    log = loop.run(3.0, COMMAND)
    assert abs(log["truth_linear"][-1]) < 1e-3


@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_reset_of_the_simulation_is_no_fault(dialect):
    loop = ClosedLoop(seed=3, drives=drive_file(dialect))
    driven(loop, 3.0)
    loop.reset()
    loop.run(0.5, (0.0, 0.0))
    assert driven(loop, 3.0)["truth_linear"][-1] == pytest.approx(0.5, abs=0.01)


def test_a_drive_file_of_another_robot_is_refused(tmp_path):
    file = tmp_path / "drives.yaml"
    file.write_text(Path(drive_file("odrive")).read_text().replace("left_wheel_joint", "front_wheel_joint"))
    with pytest.raises(ParameterError, match="front_wheel_joint") as refused:
        ClosedLoop(drives=file)
    assert "left_wheel_joint" in str(refused.value)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_is_at_least_two_fifths_as_fast_as_without_a_bus(dialect):
    """By the median of pairs that run one after the other, so that both have the same load of the machine."""

    def seconds(**given):
        loop = ClosedLoop(seed=3, **given)
        began = time.process_time()
        driven(loop, 2.0)
        return time.process_time() - began

    pairs = [(seconds(), seconds(drives=drive_file(dialect))) for _ in range(5)]
    assert np.median([direct / through for direct, through in pairs]) >= 0.4
