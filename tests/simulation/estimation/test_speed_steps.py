"""With a wrong radius or coarse wheel speeds the ellipse holds the truth, and no slip is reported."""

import numpy as np
import pytest

from bench.odometry.speed_steps import outcome

SEEDS = range(3)


@pytest.mark.parametrize("radius", [0.97, 1.01, 1.02])
@pytest.mark.parametrize(("step", "rate"), [(0.08, 6.5), (0.08, 20.0), (0.05, 50.0)])
def test_coarse_speeds_are_no_slip_and_a_wrong_radius_is_within_the_ellipse(step, rate, radius):
    within, slip = np.mean([outcome(step, rate, radius, seed) for seed in SEEDS], axis=0)
    assert slip <= 0.005
    assert within >= 0.8
