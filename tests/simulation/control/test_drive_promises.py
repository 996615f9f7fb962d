"""The drive keeps the promises of its limits on the simulated machine; `scripts/bench drive` shows the same figures."""

import pytest
from robot_control import ClosedLoop
from robot_control.data.demo.launched import ANGULAR, LINEAR
from robot_control.data.demo.tracking import judge
from robot_control.loop.signal_names import number_of

from bench.drives import drive_figures, drive_promises
from bench.drives.drive_promises import ROBOTS, coarse_encoders, curves, peer, rest, stops, straight
from bench.robot_corpus import DIFFBOT, robot_names

STOPPED = number_of("SupervisorState", "STOPPED")


OTHERS = [pytest.param(name, marks=pytest.mark.nightly) for name in ROBOTS if name != DIFFBOT]


@pytest.fixture(params=[DIFFBOT, *OTHERS])
def robot(request) -> str:
    if request.param not in robot_names():
        pytest.skip(f"{request.param}: no description here; ROBOT_CORPUS names the folder of real robots")
    return request.param


def expect(figures):
    reported = [f"{figure.name} {figure.value:.4g} {figure.unit}, allowed {figure.bound:.4g}" for figure in figures]
    print("\n".join(reported))
    assert figures
    assert not [line for line, figure in zip(reported, figures, strict=True) if not figure.good]


def test_follows_its_profile_as_it_is_and_loaded(robot):
    expect(straight(robot))


def test_keeps_a_curve_that_saturates_a_wheel(robot):
    expect(curves(robot))


def test_stops_where_its_limits_predict(robot):
    expect(stops(robot))


def test_is_quiet_at_rest_holds_on_a_slope_and_does_not_jump():
    expect(rest(DIFFBOT))


def test_turns_no_counts_into_torque_and_drives_with_few_of_them():
    expect(coarse_encoders(DIFFBOT))


def test_drives_what_the_test_of_diff_drive_controller_drives():
    expect(peer(DIFFBOT))


@pytest.mark.parametrize(("deceleration", "jerk"), [(0.5, 10.0), (2.0, 0.0), (2.0, 3.0)])
def test_stops_as_predicted_with_other_limits(deceleration, jerk):
    """Decelerations are weaker and stronger than the acceleration, without and with little jerk."""
    limits = {
        "max_linear_deceleration": deceleration,
        "max_linear_emergency_deceleration": 2.5,
        "max_linear_jerk": jerk,
    }
    loop = ClosedLoop({"diff_drive_controller": limits})
    loop.run(3.0, (0.8, 0.0))
    log = loop.run(4.0, (0.0, 0.0))
    predicted = loop.stop_distance(0.8)
    assert log["truth_x"][-1] - log["truth_x"][0] == pytest.approx(predicted, rel=0.03)


def expect_straight(params):
    figures = drive_figures.straight(DIFFBOT, 1.0, params=params)
    assert figures.rms < 0.02
    return figures


@pytest.mark.parametrize("rate", [100, 200, 500, 2000])
def test_follows_its_profile_at_every_rate(rate):
    figures = expect_straight({"robot": {"rate": rate}})
    assert figures.overshoot < 0.01
    assert figures.late < 0.1


@pytest.mark.parametrize("counts", [64, 128, 256])
def test_follows_its_profile_with_a_coarse_encoder_and_a_slower_tracking_loop(counts):
    """The robot's speed is then known no better than a count per tracking time, so its settling is not judged."""
    plant, controller = {"encoder_resolution": counts}, {"tracking_bandwidth": 8.0}
    figures = expect_straight({"mujoco_plant": plant, "diff_drive_controller": controller})
    assert figures.overshoot < 0.04


def test_bears_motors_with_friction_and_gears_that_are_not_described():
    motor = {"motor_friction": 0.005, "motor_damping": 5e-5, "gear_ratio": 20, "rotor_inertia": 2e-5}
    figures = expect_straight({"mujoco_plant": motor})
    assert figures.overshoot < 0.01


def test_a_robot_that_is_pushed_back_at_full_torque_is_stopped():
    """Its ramp waits for wheels that cannot follow, but not so long that the fault is missed."""
    params = {
        "robot": {"wheel_effort_limit": 0.4},
        "mujoco_plant": {"push_x": -9.0, "push_start": 1.0, "push_duration": 10.0},
    }
    loop = ClosedLoop(params)
    loop.run(0.9, (0.0, 0.0))
    log = loop.run(5.0, (0.5, 0.0))  # 0.5 m/s at a fifth of 1 m/s², doubled
    assert log["supervisor_state"][-1] == STOPPED


def test_robots_without_a_description_are_reported_as_not_judged(monkeypatch):
    monkeypatch.setattr(drive_promises, "robot_names", lambda: [DIFFBOT])
    monkeypatch.setattr(drive_promises, "promises", lambda *_: [drive_figures.Figure("way", 0.5, 1.0, "m")])
    result, good = drive_promises.bench(print)
    assert good
    assert result["not_judged"] == [robot for robot in ROBOTS if robot != DIFFBOT]


def test_a_figure_that_is_no_number_is_not_good():
    assert not drive_figures.Figure("way", float("nan"), 1.0, "m").good


@pytest.mark.parametrize("seed", range(8))
def test_the_demo_keeps_its_bounds_with_any_sensors(seed):
    """The sensors have the errors of the field; the robot drives off 0.8 s after it was switched on, sooner than
    scripts/demo.
    """
    loop = ClosedLoop(seed=seed)
    loop.run(0.8)
    verdict = judge(loop.run(10.0, (LINEAR, ANGULAR)), LINEAR, ANGULAR)
    print([f"{check.name} {100 * check.value:.3f} %" for check in verdict.checks])
    assert [check.name for check in verdict.checks if not check.passed] == []
