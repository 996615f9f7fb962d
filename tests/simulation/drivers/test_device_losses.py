"""Losses behind simulated drives: one in a hundred of those of scripts/bench devices."""

import re
from functools import cache
from pathlib import Path

import pytest
from robot_control.loop.drives import DRIVES

from bench.devices.answer_trial import KINDS, STATED, AnswerTrial, time_to_rest
from bench.devices.bench import ODOMETRY, RIPPLE
from bench.devices.disturbed_drive import BUSES, DisturbedDrive, run_drive, together
from bench.devices.loss_trial import BOARD, DIALECTS, LATEST, ROBOCLAW, SERIAL_LATEST, LossTrial, run_trial
from bench.devices.slope_trial import as_stated

SEED = 1000
DISTURBED = ["disturbed", pytest.param("lossy", marks=pytest.mark.nightly)]
"""A disturbed bus loses as many frames as a lossy one, and is late."""


def test_every_drive_has_its_losses():
    assert set(LATEST | SERIAL_LATEST) == {name for name, row in DRIVES.items() if row.wheel_commands}


@pytest.mark.parametrize(
    ("device", "kind"), [(device, kind) for device, kinds in (LATEST | SERIAL_LATEST).items() for kind in kinds]
)
def test_a_loss_stops_the_robot_until_the_reset(device, kind):
    outcome = run_trial(LossTrial(device, kind, SEED))
    assert outcome.broken == (), outcome


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("drive", "command"), STATED)
def test_a_robot_whose_answers_fail_is_at_rest_in_its_stated_time(drive, command, kind):
    assert time_to_rest(AnswerTrial(drive, command, kind, SEED, lasting=3.0)) <= STATED[drive, command]


def test_the_stated_times_are_those_of_the_page():
    page = (Path(__file__).parents[3] / "docs/drivers.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \| .* \| (\S+)(?: s)? \| (\S+) s \|$", page, re.MULTILINE)
    stated = {(drive, "torque"): torque for drive, torque, _ in rows if torque != "–"}
    stated |= {(drive, "velocity"): speed for drive, _, speed in rows}
    assert {key: float(time) for key, time in stated.items()} == STATED


@pytest.mark.parametrize("dialect", DIALECTS)
def test_silence_on_a_slope_does_what_is_stated(dialect):
    assert as_stated((dialect, SEED))


@cache
def drives_on(dialect, bus, seconds):
    """The figures of three robots together: the error of one is chance."""
    return together([run_drive(DisturbedDrive(dialect, bus, seconds, seed)) for seed in (1, 2, 3)])


def drives(dialect, bus, seconds):
    """The figures on an undisturbed bus and on this one."""
    return drives_on(dialect, BUSES[0], seconds), drives_on(dialect, bus, seconds)


@pytest.mark.parametrize("bus", DISTURBED)
@pytest.mark.parametrize(
    ("dialect", "seconds"), [("odrive", 30.0), pytest.param("cia402", 900.0, marks=pytest.mark.nightly)]
)
def test_lost_and_late_frames_stop_nothing_and_hardly_disturb(dialect, seconds, bus):
    undisturbed, disturbed = drives(dialect, bus, seconds)
    assert disturbed.stops == 0
    assert disturbed.ripple < RIPPLE * undisturbed.ripple
    assert disturbed.odometry < ODOMETRY * undisturbed.odometry


@pytest.mark.parametrize(
    "drive", [DisturbedDrive("vesc", BUSES[0], 70.0, 21), DisturbedDrive("cia402", "lossy", 20.0, 11)], ids=str
)
def test_no_wall_is_seen_where_none_is(drive):
    """VESCs send for seconds never in the same cycle. A turn in a slide shows the bias that a rest took for a tilt."""
    assert run_drive(drive).odometry < 0.1  # m


@pytest.mark.parametrize(("board", "seconds"), [(BOARD, 20.0), (ROBOCLAW, 120.0)])
def test_a_disturbed_serial_line_stops_nothing(board, seconds):
    undisturbed, disturbed = drives(board, "disturbed", seconds)
    assert disturbed.stops == 0
    assert disturbed.odometry < ODOMETRY * undisturbed.odometry


@pytest.mark.parametrize("bus", DISTURBED)
def test_nor_do_they_make_a_cia_402_drive_ripple(bus):
    undisturbed, disturbed = drives("cia402", bus, 30.0)
    assert disturbed.stops == 0
    assert disturbed.ripple < RIPPLE * undisturbed.ripple
