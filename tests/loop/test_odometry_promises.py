"""The odometry on three simulated robots, held to its promises; `scripts/bench odometry` tries fifty.

A promise that fifty robots keep is asserted as promised. What three cannot tell is looser, and why stands beside it:
LOOSER holds the factor by which a figure may miss its bound. A promise that fifty robots do not keep is in MISSED: the
figure of these three, which are the same in every build, may become worse by a quarter to a third, no more; the
benchmark's table and its exit code go on saying that it is missed.
"""

import pytest
from robot_control.odometry_bench import all_runs
from robot_control.odometry_promises import all_promises
from robot_control.odometry_scenarios import SCENARIOS
from robot_control.odometry_table import table

SEEDS = range(3)
LONG = ("umbmark", "eight", "standstill", "waves")  # one robot: minutes of the same, or ground that is slow to compute
LOOSER = {
    # Of three errors that are as good as normal the mean is √(50/3) times less certain than of fifty, 95th percentiles
    # are the worst of three.
    "UMBmark, mean": 1.5,
    "random drive, position, p95": 1.5,
    "random drive, yaw, mean": 1.5,
    "slip, 5 × better than wheels": 1.25,  # two of three
    "false alarms, kerb": 2,  # of three robots; they come in bursts of a second after a bump
    # The middle one of three |errors|, over that of another method: a lucky draw of either is a factor of 2, of the
    # heading, in which both are often a few hundredths of a degree, of 4.
    **{f"{scenario}, position over simple part's": 2 for scenario in SCENARIOS},
    **{f"{scenario}, yaw over simple part's": 4 for scenario in SCENARIOS},
}
UNTOLD = {  # by one run
    "standstill, position over simple part's",
    "standstill, yaw over simple part's",
    "waves, position over simple part's",
    "waves, yaw over simple part's",
}
MISSED = {  # and, by robots that are none of these: UMBmark's worst, 46 of 40 mm; slip, worst over wheels, 1.74 of 1.1
    # Promised at 90 % of the times; 0 % with fifty: the covariance is too large, NEES 1.9 (ideal 3). Here 40 %.
    "NEES of the pose in its band": 30,
    # Promised at 90 %; 60 % with fifty, below the band in the rest: mean 1.5 (ideal 2). Here 90 %.
    "NEES of the twist in its band": 69,
    # At most 10; 34 with fifty, 8.8 without two of them. Here 415: one sample of 18, of the run that is worst of all.
    "slip, mean NEES of the pose": 540,
    # At most 1.1; 1.24 with fifty. Here 1.35.
    "slope, yaw over simple part's": 1.75,
}


@pytest.fixture(scope="module")
def runs():
    short = [scenario for scenario in SCENARIOS if scenario not in LONG]
    return all_runs(SEEDS, short, print) + all_runs(SEEDS[:1], LONG, print)


def test_the_odometry_keeps_its_promises_and_what_is_missed_becomes_no_worse(runs):
    print("\n".join(table(runs)))
    broken = []
    for promise in all_promises(runs):
        print(promise)
        if promise.name in UNTOLD:
            continue
        room = LOOSER.get(promise.name, 1)
        bound = MISSED.get(promise.name, promise.bound / room if promise.least else promise.bound * room)
        kept = promise.value >= bound if promise.least else promise.value <= bound
        if not kept:
            broken.append(f"{promise}; here {bound:.4g}")
    assert not broken


def test_no_run_was_stopped_and_the_state_was_always_valid(runs):
    assert not [(run.scenario, run.seed) for run in runs if run.stopped or run.invalid > 0]


def test_every_looser_bound_is_one_of_a_promise(runs):
    assert set(LOOSER) | UNTOLD | set(MISSED) <= {promise.name for promise in all_promises(runs)}
