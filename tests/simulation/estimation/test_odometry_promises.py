"""The odometry on three simulated robots, held to its promises every night; `scripts/bench odometry` tries fifty.

A promise that fifty robots keep is asserted as promised. LOOSER holds the factor by which a figure of three robots may
miss its bound, with the reason. MISSED holds promises that fifty robots miss, or these three, which are the same in
every build. A missed figure of the three may become worse by a quarter, no more. The benchmark's table and its exit
code go on reporting it.
"""

import numpy as np
import pytest

from bench.odometry.bench import all_runs
from bench.odometry.judge import run
from bench.odometry.promises import all_promises
from bench.odometry.scenarios import SCENARIOS
from bench.odometry.table import table
from bench.odometry.tested_estimator import OURS

SEEDS = range(3)
LONG = ("umbmark", "eight", "standstill", "waves")  # one robot: minutes of one motion, or ground slow to compute
LOOSER = {
    # The mean of three nearly normal errors is √(50/3) times less certain than that of fifty; the 95th percentile of
    # three is the worst one.
    "UMBmark, mean": 1.5,
    "random drive, position, p95": 1.5,
    "random drive, yaw, mean": 1.5,
    "false alarms, kerb": 1.25,  # 2.57 with fifty; they come in bursts of a second after a bump
    # The median of three |errors| over that of another method may be wrong by a factor of 2 by chance. For the heading,
    # where both are often a few hundredths of a degree, the factor is 4.
    **{f"{scenario}, position over simple odometry's": 2 for scenario in SCENARIOS},
    **{f"{scenario}, yaw over simple odometry's": 4 for scenario in SCENARIOS},
}
UNTOLD = {  # one run does not show them
    "standstill, position over simple odometry's",
    "standstill, yaw over simple odometry's",
    "waves, position over simple odometry's",
    "waves, yaw over simple odometry's",
}
MISSED = {
    # The covariance includes the clock offset and the floor of real robots. With the sensors of a data sheet the mean
    # NEES is 0.9 of 3, and too small 63 % of the times.
    "NEES of the pose in its band": 27,
}
# Robots whose estimate was lost in earlier versions. A rocking body separated tilt and bias, or a calibration moved
# before a slide was detected. Gravity was learned in a slide, or a window stayed too large to learn from.
LOST_ONCE = [("slip", 2), ("slope", 3)]
LOST_ONCE_NIGHTLY = [("standstill", 18), ("slip", 28), ("slip", 31)]
SURE_OF_A_SLIDE = {28: 265}  # NEES, measured 211: the estimate took a slide for rolling
MAX_NEES = 40


@pytest.fixture(scope="module")
def runs():
    short = [scenario for scenario in SCENARIOS if scenario not in LONG]
    return all_runs(SEEDS, short, print) + all_runs(SEEDS[:1], LONG, print)


@pytest.mark.nightly
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


@pytest.mark.parametrize(
    ("scenario", "seed"), [*LOST_ONCE, *(pytest.param(*lost, marks=pytest.mark.nightly) for lost in LOST_ONCE_NIGHTLY)]
)
def test_robots_that_were_lost_once_know_where_they_are(scenario, seed):
    outcome = run(scenario, seed)
    yaw = np.rad2deg(outcome.yaw[OURS])
    assert yaw < 2, f"{yaw} °"
    if scenario == "slip":
        assert np.nanmean(outcome.pose_nees) < SURE_OF_A_SLIDE.get(seed, MAX_NEES)
    else:
        assert outcome.notice.alarms == 0
        assert outcome.position[OURS] < 0.01 * outcome.distance + 0.001


@pytest.mark.parametrize("scenario", ["kerb", "ice"])
def test_short_slips_make_it_little_worse_than_the_simple_odometry(scenario):
    """Slips are too short to be proven. The median of five robots is judged, because slides are chaotic: another
    control law of the wheels changes the error of one threefold, either way. The nightly suite judges the promises.
    """
    outcomes = [run(scenario, seed) for seed in range(5)]
    assert not any(outcome.stopped or outcome.invalid for outcome in outcomes)
    ours, simple = (np.median([outcome.position[law] for outcome in outcomes]) for law in (OURS, "simple odometry"))
    assert ours < 1.5 * simple


@pytest.mark.nightly
def test_no_run_was_stopped_and_the_state_was_always_valid(runs):
    assert not [(run.scenario, run.seed) for run in runs if run.stopped or run.invalid > 0]


@pytest.mark.nightly
def test_every_looser_bound_is_one_of_a_promise(runs):
    assert set(LOOSER) | UNTOLD | set(MISSED) <= {promise.name for promise in all_promises(runs)}
