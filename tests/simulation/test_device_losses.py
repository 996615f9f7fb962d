"""Losses behind simulated drives: one in a hundred of those of scripts/bench devices."""

import pytest

from bench.devices.bench import ODOMETRY, RIPPLE
from bench.devices.disturbed_drive import BUSES, DisturbedDrive, run_drive
from bench.devices.loss_trial import DIALECTS, KINDS, LossTrial, run_trial
from bench.devices.slope_trial import as_stated

SEED = 1000


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_loss_stops_the_robot_until_the_reset(dialect, kind):
    outcome = run_trial(LossTrial(dialect, kind, SEED))
    assert outcome.broken == (), outcome


@pytest.mark.parametrize("dialect", DIALECTS)
def test_silence_on_a_slope_does_what_is_stated(dialect):
    assert as_stated((dialect, SEED))


@pytest.mark.parametrize("bus", BUSES[1:])
@pytest.mark.parametrize("dialect", DIALECTS)
def test_lost_and_late_frames_stop_nothing_and_hardly_disturb(dialect, bus):
    undisturbed, disturbed = (run_drive(DisturbedDrive(dialect, each, 30.0)) for each in (BUSES[0], bus))
    assert disturbed.stops == 0
    assert disturbed.ripple < RIPPLE * undisturbed.ripple
    assert disturbed.odometry < ODOMETRY * undisturbed.odometry
