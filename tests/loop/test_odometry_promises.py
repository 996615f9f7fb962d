"""The odometry keeps its promises, on three simulated robots; `scripts/bench odometry` tries fifty.

Bounds that are the worst or the mean of few runs stand as promised. What three seeds cannot tell is looser, and why
stands beside it: LOOSER holds the factor by which a figure may miss its bound.
"""

import pytest
from robot_control.odometry_bench import all_runs
from robot_control.odometry_promises import all_promises
from robot_control.odometry_scenarios import SCENARIOS
from robot_control.odometry_table import table

SEEDS = range(3)
LONG = ("standstill", "waves")  # ten minutes of nothing, and ground that takes long to compute: one robot each
LOOSER = {
    # Of three errors that are as good as normal the mean is √(50/3) times less certain than of fifty, 95th percentiles
    # are the worst of three.
    "UMBmark, mean": 1.5,
    "random drive, position, p95": 1.5,
    "random drive, yaw, mean": 1.5,
    # Inside its band 95 % of the time in the mean of many; errors of one run stay where they are for minutes.
    "NEES of the pose in its band": 1.5,
    "slip, 5 × better than wheels": 1.25,  # two of three
    "slip, mean NEES of the pose": 2,  # of 18 samples
    # The middle one of three |errors|, over that of another method: a lucky draw of either is a factor of 2, of the
    # heading, in which both are often a few hundredths of a degree, of 3.
    **{f"{scenario}, position over simple part's": 2 for scenario in SCENARIOS},
    **{f"{scenario}, yaw over simple part's": 3 for scenario in SCENARIOS},
}
UNTOLD = {f"{scenario}, {what} over simple part's" for scenario in LONG for what in ("position", "yaw")}  # by one run


@pytest.fixture(scope="module")
def runs():
    short = [scenario for scenario in SCENARIOS if scenario not in LONG]
    return all_runs(SEEDS, short, print) + all_runs(SEEDS[:1], LONG, print)


def test_the_odometry_keeps_its_promises(runs):
    print("\n".join(table(runs)))
    broken = []
    for promise in all_promises(runs):
        print(promise)
        if promise.name in UNTOLD:
            continue
        room = LOOSER.get(promise.name, 1)
        kept = promise.value * room >= promise.bound if promise.least else promise.value <= promise.bound * room
        if not kept:
            broken.append(str(promise))
    assert not broken


def test_no_run_was_stopped_and_the_state_was_always_valid(runs):
    assert not [(run.scenario, run.seed) for run in runs if run.stopped or run.invalid > 0]


def test_every_looser_bound_is_one_of_a_promise(runs):
    assert set(LOOSER) | UNTOLD <= {promise.name for promise in all_promises(runs)}
