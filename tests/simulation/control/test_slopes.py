"""On a slope a robot stops and stays at a zero request, at any rate; `scripts/bench slopes` has every slope."""

import pytest

from bench.drives import slopes
from bench.drives.wheel_command import WHEEL_COMMANDS


@pytest.mark.parametrize("wheel_command", WHEEL_COMMANDS)
@pytest.mark.parametrize(
    "rate", [pytest.param(rate, marks=() if rate in (20, 1000) else pytest.mark.nightly) for rate in slopes.RATES]
)
def test_a_zero_request_ends_in_the_brake_on_the_steepest_slope(rate, wheel_command):
    few = 4 if rate == 1000 else slopes.HEADINGS
    (row,) = slopes.worst([15], [rate], few, wheel_command)
    assert row["value"] <= slopes.BEYOND, row
