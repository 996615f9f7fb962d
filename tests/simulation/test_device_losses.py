"""Losses behind simulated drives: one in a hundred of those of scripts/bench devices."""

import pytest

from bench.devices.disturbed_drive import DisturbedDrive, run_drive
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


@pytest.mark.parametrize("dialect", DIALECTS)
def test_lost_frames_stop_nothing_and_hardly_disturb(dialect):
    undisturbed, lossy = (run_drive(DisturbedDrive(dialect, bus, 30.0)) for bus in ("ok", "lossy"))
    assert lossy.stops == 0
    assert lossy.ripple < 2 * undisturbed.ripple
    assert lossy.odometry < 1.2 * undisturbed.odometry
