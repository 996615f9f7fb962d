"""Accepted sets of limits and gains do no harm: none makes a robot exceed its speed or shake without a cause."""

import numpy as np
import pytest
from robot_control import ClosedLoop, ParameterError
from robot_control.loop.signal_names import causes_in

from bench.robot_corpus import robot_names
from bench.runs.runner import Processes
from bench.tuning import ROBOTS, bench, longest_excess, robot_of, shaking


# A part of the 10⁵ sets of scripts/bench tuning.
@pytest.mark.parametrize("runs", [10, pytest.param(50, marks=pytest.mark.nightly)])
def test_no_set_that_is_taken_exceeds_the_speed_or_shakes_without_a_cause(runs):
    lines = []
    here = sum(robot in robot_names() for robot in ROBOTS)
    result, fine = bench(0, runs * len(ROBOTS) // here, lines.append)
    figures = {row["name"]: row["value"] for row in result["rows"]}
    assert fine, "\n".join(lines)
    assert figures["sets driven"] == runs
    assert figures["sets refused"] > runs / 4, "else they are drawn too tamely to say anything"


class Remembering(Processes):
    """Runs in this process alone and keeps the result of each seed."""

    def __init__(self):
        super().__init__(1)
        self.seen = {}

    def outcomes(self, one, items, say, chunk=1):
        for outcome in super().outcomes(one, items, say, chunk):
            self.seen[outcome.seed] = outcome
            yield outcome


def test_a_seed_is_the_same_set_of_the_same_robot_whatever_it_is_drawn_with():
    among, alone = Remembering(), Remembering()
    bench(4, 2, print, among)
    bench(5, 1, print, alone)
    assert alone.seen[5] == among.seen[5]
    assert alone.seen[5].robot == robot_of(5)


@pytest.mark.parametrize(
    "values",
    [
        {"feed_forward": {"wheel_damping": 2.0}},
        {"feed_forward": {"wheel_damping": 1000.0}},
        {"feed_forward": {"wheel_friction": 9.0}, "pid_kp": 0.05},
        {"feed_forward": {"wheel_inertia": 0.03}, "pid_kp": 20.0},
        {"feed_forward": {"mass": 59.0, "wheel_inertia": 0.149, "yaw_inertia": 3.5}},
        {"pid_kp": 0.05},
        {"tracking_bandwidth": 300},
        {"tracking_bandwidth": 99},
        {"tracking_bandwidth": 1},
    ],
)
def test_a_set_that_would_break_a_limit_is_refused(values):
    with pytest.raises(ParameterError, match="nothing is changed"):
        ClosedLoop().set_parameters(values)


# Derived gains tolerate 2 cycles of delay (docs/evidence/derivations.md). With 10 the torque jumps between its limits.
def test_a_drive_that_is_later_than_its_gains_bear_is_warned_of_and_stopped():
    loop = ClosedLoop(params={"mujoco_plant": {"sensor_errors": "data_sheet", "actuator_delay": 10}})
    log = loop.run(4.0, (1.0, 0.0))
    assert causes_in(log["permit_causes"]) == ["torque_oscillation"]
    warned, stopped = (int(np.argmax(log[name] > 0)) for name in ("permit_warnings", "permit_causes"))
    assert 0 < warned < stopped < 3.0 / loop.period
    assert np.abs(log["truth_linear"]).max() < 1.05


@pytest.mark.parametrize("counts", [64, 4096, *(pytest.param(n, marks=pytest.mark.nightly) for n in (200, 512, 1000))])
def test_derived_gains_shake_nothing_behind_any_encoder(counts):
    loop = ClosedLoop(params={"mujoco_plant": {"sensor_errors": "data_sheet", "encoder_resolution": counts}})
    for command in ((0.5, 0.2), (0.05, 0.0), (1.0, 0.0), (0.0, 2.0), (0.0, 0.0)):
        log = loop.run(2.0, command)
        assert causes_in(log["permit_causes"]) == []
        assert causes_in(log["permit_warnings"]) == []


def test_an_excess_is_one_that_lasts():
    speed = np.ones(1000)
    speed[100:149] = 1.2
    assert longest_excess(speed, 1.05, 0.05, 50) < 0
    speed[149] = 1.2
    assert longest_excess(speed, 1.05, 0.05, 50) == pytest.approx(0.15)
    assert longest_excess(-speed, 1.05, 0.05, 50) > 0, "and one that goes back"


def test_a_torque_that_alternates_shakes_and_a_ramp_does_not():
    time = np.arange(500) / 1000
    assert shaking(np.sign(np.sin(2 * np.pi * 62 * time)), 200) == pytest.approx(1, abs=0.1)
    assert shaking(3 * time, 200) < 0.01
